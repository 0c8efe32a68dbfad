# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes nuScenes' files of points: LiDAR (.pcd.bin), its labels, and radar (PCD 0.7).

**LiDAR.** float32 x, y, z, intensity, ring of each point, without a header. nuScenes' LiDAR has x to the
right, y forward and z up; our points are turned by 90 degrees about z, and so is the calibrated sensor, so
that both together are exact. Intensity is 0 to 255 in nuScenes and 0 to 1 in greatx: it is multiplied by 255.

**Radar.** One point for each detection, with 18 fields as an ARS 408 gives them. x is forward and y to the
left, as in greatx. Computed are: x, y, z, dyn_prop (0: moving, 1: stationary, by vx_comp and vy_comp), id
(the row), rcs (dBsm), vx and vy (the rate of range along the line of sight: the device measures no other
part), and vx_comp and vy_comp (the same with the radar's own motion added). The other fields are constants,
see CONSTANTS. A file cannot be empty: without a detection it has one point of NaN, which the development kit
takes for none.
"""

from __future__ import annotations

import dataclasses
from typing import Optional, Tuple

import numpy as np

from ...dataset import Record
from ...files import Field
from ..poses import Pose, mount, node_of
from ..rig import Track

#: Frame of greatx's LiDAR from nuScenes' (x right, y forward, z up).
BODY_FROM_LIDAR = Pose(np.zeros(3), np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
INTENSITY_SCALE = 255.0

RADAR_FIELDS: Tuple[Tuple[str, str], ...] = (
    ("x", "<f4"),
    ("y", "<f4"),
    ("z", "<f4"),
    ("dyn_prop", "i1"),
    ("id", "<i2"),
    ("rcs", "<f4"),
    ("vx", "<f4"),
    ("vy", "<f4"),
    ("vx_comp", "<f4"),
    ("vy_comp", "<f4"),
    ("is_quality_valid", "i1"),
    ("ambig_state", "i1"),
    ("x_rms", "i1"),
    ("y_rms", "i1"),
    ("invalid_state", "i1"),
    ("pdh0", "i1"),
    ("vx_rms", "i1"),
    ("vy_rms", "i1"),
)
#: Values that nothing is computed for. The development kit keeps points of ambig_state 3 (unambiguous) and
#: invalid_state 0 (valid); pdh0 1 is a false-alarm probability below 25 %. The four codes of errors are 0.
CONSTANTS = {
    "is_quality_valid": 1,
    "ambig_state": 3,
    "x_rms": 0,
    "y_rms": 0,
    "invalid_state": 0,
    "pdh0": 1,
    "vx_rms": 0,
    "vy_rms": 0,
}
#: Least compensated rate of range of a moving target, m/s, or one velocity bin, whichever is more.
MOVING_M_S = 0.5


def lidar_bytes(points: np.ndarray, ring: np.ndarray) -> bytes:
    """Returns the file of points float32 [n, 4] of greatx (x forward, y left, z up, intensity) and of their
    rings [n]."""
    out = np.empty((len(points), 5), "<f4")
    out[:, 0], out[:, 1], out[:, 2] = -points[:, 1], points[:, 0], points[:, 2]
    out[:, 3] = points[:, 3] * np.float32(INTENSITY_SCALE)
    out[:, 4] = ring
    return out.tobytes()


@dataclasses.dataclass(frozen=True)
class Detections:
    """Holds the detections of one record of a radar."""

    points: np.ndarray  #: float64 [n, 3] m, sensor's frame (x forward, y left, z up)
    rcs: np.ndarray  #: float64 [n] dBsm
    radial: np.ndarray  #: float64 [n, 3] m/s: rate of range times the line of sight
    compensated: np.ndarray  #: float64 [n, 3] m/s: the same over ground
    moving: np.ndarray  #: bool [n]


def sensor_velocity(record: Record, track: Track) -> np.ndarray:
    """Returns the velocity of a sensor's origin at the tick, float64 [3] m/s, in the sensor's frame."""
    node = track.nodes.index(node_of(record.sensor.name, track.nodes))
    body = track.pose(node, record.tick)
    body_from_sensor = mount(record)
    arm = body.rotation @ body_from_sensor.position
    velocity = track.vector("velocity", node, record.tick)
    velocity = velocity + np.cross(track.vector("angular_velocity", node, record.tick), arm)
    return body_from_sensor.rotation.T @ body.rotation.T @ velocity


def detections(record: Record, track: Track) -> Detections:
    """Returns a radar's detections with velocities. The sensor's velocity is taken at the tick; until the
    middle of the frame, to which the rates belong, it changes by the acceleration times that time."""
    rows = np.array(record["detections"], np.float64)
    rate = np.array(record["velocity"], np.float64)
    distance = np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
    sight = rows[:, :3] / np.where(distance > 0, distance, 1.0)
    own = sensor_velocity(record, track)
    over_ground = rate + sight @ own
    bin_ = Field(record.sensor.metadata.where, record.sensor.metadata)["velocity_bin_m_s"].number(0.0, 1e9)
    return Detections(
        rows[:, :3],
        rows[:, 3],
        rate[:, None] * sight,
        over_ground[:, None] * sight,
        np.abs(over_ground) > max(MOVING_M_S, bin_),
    )


def radar_bytes(found: Optional[Detections]) -> bytes:
    """Returns a PCD 0.7 with nuScenes' 18 fields."""
    count = 0 if found is None else len(found.points)
    rows = np.zeros(max(count, 1), np.dtype(list(RADAR_FIELDS)))
    for name, value in CONSTANTS.items():
        rows[name] = value
    if found is None or count == 0:
        for name, kind in RADAR_FIELDS:
            if kind == "<f4":
                rows[name] = np.nan
    else:
        rows["x"], rows["y"], rows["z"] = found.points.T
        rows["rcs"] = found.rcs
        rows["vx"], rows["vy"] = found.radial[:, 0], found.radial[:, 1]
        rows["vx_comp"], rows["vy_comp"] = found.compensated[:, 0], found.compensated[:, 1]
        rows["dyn_prop"] = np.where(found.moving, 0, 1)
        rows["id"] = np.arange(count) & 0x7FFF
    sizes = [str(np.dtype(kind).itemsize) for _, kind in RADAR_FIELDS]
    types = ["F" if np.dtype(kind).kind == "f" else "I" for _, kind in RADAR_FIELDS]
    header = [
        "# .PCD v0.7 - Point Cloud Data file format",
        "VERSION 0.7",
        "FIELDS " + " ".join(name for name, _ in RADAR_FIELDS),
        "SIZE " + " ".join(sizes),
        "TYPE " + " ".join(types),
        "COUNT " + " ".join("1" for _ in RADAR_FIELDS),
        f"WIDTH {len(rows)}",
        "HEIGHT 1",
        "VIEWPOINT 0 0 0 1 0 0 0",
        f"POINTS {len(rows)}",
        "DATA binary",
        "",
    ]
    # The development kit wants a byte behind the last point.
    return "\n".join(header).encode() + rows.tobytes() + b"\n"
