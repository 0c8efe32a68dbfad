# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Turns poses of a node into the 30 values of KITTI's GPS and inertial unit (oxts), whose frame is the
body's.

**Places.** Programs that read oxts (pykitti, KITTI's own convertOxtsToPose) project latitude and longitude
by Mercator's formula on a sphere, scaled at the first frame:

    s = cos(lat_0),  x = s r lon pi/180,  y = s r ln tan((90 + lat) pi/360),  r = 6378137 m.

`Places("mercator")` inverts these formulas about the first frame, whose own place is exact. The programs then
return the true positions relative to the first frame, to the rounding of a double: 1e-8 m. The latitudes and
longitudes themselves deviate from the true ones, because the Earth is no sphere, by at most 0.68 % of the
distance from the first frame (the ratio of r and the radius of curvature of the meridian at the equator), and
by (distance)^2/2r because the scene's plane is no sphere either. `Places("geodetic")` writes the true places,
and the programs return positions with that error.

**Axes.** Yaw, pitch and roll are those of R = Rz(yaw) Ry(pitch) Rx(roll) against the scene's east, north and
up. x, y, z are the body's axes; f, l, u (forward, left, up) are the body's axes turned level: forward is the
heading's direction in the horizontal plane. Accelerations are what an accelerometer measures: gravity's
reaction, 9.80665 m/s^2 upwards, is in them, as it is in KITTI's files.
"""

from __future__ import annotations

import math
from typing import List, Optional, Tuple

import numpy as np

from ...dataset import Dataset
from ...errors import DatasetError
from ...geodesy import LocalFrame
from ..poses import Pose
from ..rig import Track

EARTH_M = 6378137.0  #: the radius that the readers use
GRAVITY = 9.80665  #: m/s^2, standard gravity (CGPM 1901)
#: Latitude, longitude (degrees) and height (m) of the first frame of a scene without georeference: a round
#: place near Karlsruhe, where KITTI was recorded.
DEFAULT_PLACE = (49.0, 8.4, 110.0)
#: Values that nothing is computed for: pos_accuracy, vel_accuracy, navstat, numsats, posmode, velmode,
#: orimode.
CONSTANTS = (0.0, 0.0, 4, 0, 0, 0, 0)

#: Names and meanings of the values, for dataformat.txt.
FIELDS = (
    ("lat", "latitude, degrees"),
    ("lon", "longitude, degrees"),
    ("alt", "height, m"),
    ("roll", "roll, rad; 0: level, positive: left side up"),
    ("pitch", "pitch, rad; 0: level, positive: front down"),
    ("yaw", "heading, rad; 0: east, positive: counter-clockwise"),
    ("vn", "velocity to the north, m/s"),
    ("ve", "velocity to the east, m/s"),
    ("vf", "velocity forward, level, m/s"),
    ("vl", "velocity to the left, level, m/s"),
    ("vu", "velocity upwards, m/s"),
    ("ax", "acceleration along the body's x (forward), gravity included, m/s^2"),
    ("ay", "acceleration along the body's y (left), m/s^2"),
    ("az", "acceleration along the body's z (up), m/s^2"),
    ("af", "acceleration forward, level, m/s^2"),
    ("al", "acceleration to the left, level, m/s^2"),
    ("au", "acceleration upwards, gravity included, m/s^2"),
    ("wx", "angular rate about the body's x, rad/s"),
    ("wy", "angular rate about the body's y, rad/s"),
    ("wz", "angular rate about the body's z, rad/s"),
    ("wf", "angular rate about the level forward axis, rad/s"),
    ("wl", "angular rate about the level left axis, rad/s"),
    ("wu", "angular rate about the vertical, rad/s"),
    ("pos_accuracy", "constant 0: the poses are exact"),
    ("vel_accuracy", "constant 0"),
    ("navstat", "constant 4"),
    ("numsats", "constant 0"),
    ("posmode", "constant 0"),
    ("velmode", "constant 0"),
    ("orimode", "constant 0"),
)


def dataformat() -> str:
    """Returns oxts/dataformat.txt."""
    return "".join(f"{name + ':':<14} {meaning}\n" for name, meaning in FIELDS)


def angles(matrix: np.ndarray) -> Tuple[float, float, float]:
    """Returns roll, pitch and yaw of a rotation [3, 3]. If x points straight up or down, roll is 0."""
    pitch = math.atan2(-matrix[2, 0], math.hypot(matrix[0, 0], matrix[1, 0]))
    if math.hypot(matrix[0, 0], matrix[1, 0]) < 1e-9:
        return 0.0, pitch, math.atan2(-matrix[0, 1], matrix[1, 1])
    return (
        math.atan2(matrix[2, 1], matrix[2, 2]),
        pitch,
        math.atan2(matrix[1, 0], matrix[0, 0]),
    )


class Places:
    """Gives latitude, longitude and height of positions of one sequence."""

    def __init__(self, frame: LocalFrame, anchor: np.ndarray, first: np.ndarray, kind: str):
        """`anchor` is the position that the frame's origin stands for, and `first` that of the first frame of
        the sequence, both [3] m in the world."""
        self._frame, self._anchor, self._first, self._kind = frame, anchor, first, kind
        self._place = frame.place(first - anchor)
        self._scale = math.cos(math.radians(self._place[0]))
        if kind == "mercator" and self._scale < 1e-3:
            raise DatasetError(
                f"latitude {self._place[0]:.4f}: expected a place farther than 0.06 degrees from a "
                "pole, where Mercator's projection ends; write --places geodetic"
            )

    def of(self, position: np.ndarray) -> np.ndarray:
        """Returns the place [3] of a position [3]."""
        if self._kind == "geodetic":
            return self._frame.place(position - self._anchor)
        east, north, up = position - self._first
        latitude, longitude, height = self._place
        m = math.log(math.tan(math.radians(90.0 + latitude) / 2)) + north / (self._scale * EARTH_M)
        return np.array(
            [
                2 * math.degrees(math.atan(math.exp(m))) - 90.0,
                longitude + math.degrees(east / (self._scale * EARTH_M)),
                height + up,
            ]
        )


def local_frame(dataset: Dataset, origin: Optional[Tuple[float, float, float]]) -> Optional[LocalFrame]:
    """Returns the scene's frame, or None if it has none. Raises DatasetError if an origin is given for a
    scene that has a georeference."""
    if dataset.georeference is not None:
        if origin is not None:
            raise DatasetError(f"{dataset.path}: has a georeference: --origin would contradict it")
        return LocalFrame.of(dataset)
    return None


def packet(pose: Pose, place: np.ndarray, track: Track, node: int, tick: int) -> List[float]:
    """Returns the 30 values at a tick in the order of FIELDS."""
    roll, pitch, yaw = angles(pose.rotation)
    level = np.array([[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]])
    velocity = track.vector("velocity", node, tick)
    acceleration = track.vector("acceleration", node, tick) + [0.0, 0.0, GRAVITY]
    rate = track.vector("angular_velocity", node, tick)
    values = [*place, roll, pitch, yaw, velocity[1], velocity[0], *(level.T @ velocity)]
    values += [*(pose.rotation.T @ acceleration), *(level.T @ acceleration)]
    values += [*(pose.rotation.T @ rate), *(level.T @ rate)]
    return [float(value) + 0.0 for value in values] + list(CONSTANTS)


def line(values: List[float]) -> str:
    """Returns a line of a file; each number has the digits that give it back exactly."""
    return " ".join(repr(value) for value in values) + "\n"
