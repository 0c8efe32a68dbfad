# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the points of a LiDAR's record, and undoes the motion of the sensor during a sweep.

A point of a sweep is in the sensor's frame at the time of its own shot (docs/lidar.md). `untwisted` turns it
into the sensor's frame at the tick, to which the poses and the pictures belong.

**Method.** The pose of the node at dt after the tick is extrapolated from the tick's own position p, velocity
v, acceleration a, orientation R and angular velocity w (world axes):

    p(dt) = p + v dt + a dt^2 / 2,    R(dt) = exp([w dt]) R.

**Error.** The position is off by at most j dt^3 / 6, where j is the largest jerk during the sweep, and the
rotation by at most b dt^2 / 2, where b is the largest angular acceleration. A point at the range r is
therefore off by at most j dt^3 / 6 + r b dt^2 / 2: 0 for straight motion at a constant rate of turn, 7 mm at
30 m for a car whose rate of turn changes by 0.05 rad/s^2 within 0.1 s. At a corner of way-points, where the
velocity jumps by u, it is off by at most u dt.
"""

from __future__ import annotations

import argparse
import dataclasses
from typing import Optional

import numpy as np

from ..dataset import Record
from ..errors import DatasetError
from ..files import Field
from .poses import Pose, mount, node_of
from .rig import Track


@dataclasses.dataclass(frozen=True)
class Cloud:
    """Holds the points of one record in the sensor's frame (x forward, y left, z up)."""

    points: np.ndarray  #: float32 [n, 4]: x, y, z in m, intensity
    ring: Optional[np.ndarray]  #: uint16 [n]: channel; None if the data set has it not
    instance: Optional[np.ndarray]  #: uint32 [n]: index + 1 of the instance, 0: none; None if not there


def sweep_s(record: Record) -> float:
    """Returns the duration of a LiDAR's sweep."""
    return Field(record.sensor.metadata.where, record.sensor.metadata)["sweep_s"].number(0.0, 1e6)


def _array(record: Record, name: str) -> Optional[np.ndarray]:
    return np.array(record[name]) if name in record.sensor.arrays else None


def cloud(record: Record) -> Cloud:
    """Returns the points as the data set has them."""
    return Cloud(np.array(record["points"], np.float32), _array(record, "ring"), _array(record, "instance"))


def rotations(vectors: np.ndarray) -> np.ndarray:
    """Returns the rotations exp([v]) [n, 3, 3] of rotation vectors [n, 3] (Rodrigues' formula)."""
    angle = np.linalg.norm(vectors, axis=-1)[:, None, None]
    safe = np.where(angle > 0, angle, 1.0)
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    k = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], -1).reshape(-1, 3, 3)
    return np.eye(3) + np.sin(angle) / safe * k + (1 - np.cos(angle)) / safe**2 * (k @ k)


def untwisted(record: Record, track: Track) -> Cloud:
    """Returns the points in the sensor's frame at the tick. Raises DatasetError if the sweep lasts and the
    data set has no time of each point."""
    there = cloud(record)
    if sweep_s(record) == 0.0 or len(there.points) == 0:
        return there
    sensor = record.sensor
    offset = _array(record, "time_offset")
    if offset is None:
        raise DatasetError(
            f"{sensor.sequence.dataset.path}: {sensor.name}: expected an array 'time_offset', by which the "
            "motion during a sweep is undone, found none; the LiDAR's outputs need ply or pcd"
        )
    node = track.nodes.index(node_of(sensor.name, track.nodes))
    dt = offset.astype(np.float64)[:, None]
    body = track.pose(node, record.tick)
    body_from_sensor = mount(record)
    at_body = body_from_sensor.apply(there.points[:, :3].astype(np.float64))
    turned = rotations(track.vector("angular_velocity", node, record.tick) * dt)
    moved = track.vector("velocity", node, record.tick) * dt
    moved += track.vector("acceleration", node, record.tick) * dt**2 / 2
    world = np.einsum("nij,nj->ni", turned, at_body @ body.rotation.T) + moved  # relative to the body
    at_tick = body_from_sensor.inverse().apply(Pose(np.zeros(3), body.rotation.T).apply(world))
    points = there.points.copy()
    points[:, :3] = at_tick
    return dataclasses.replace(there, points=points)


def untwist_argument(parser: argparse.ArgumentParser) -> None:
    """Adds --untwist, which asks for untwisted() in place of cloud()."""
    parser.add_argument(
        "--untwist", action="store_true", help="undo the motion of the LiDAR during each sweep"
    )
