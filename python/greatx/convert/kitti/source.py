# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Gives what all four KITTI layouts hold: pictures, points, calibration and common times of one carrier.

KITTI's cameras are rectified: they share one orientation, cameras 1 and 3 stand to the right of cameras 0 and
2, and all calibration is relative to camera 0 (A. Geiger et al., IJRR 32(11), 2013, section 4.2). A data set
has one colour camera, or two that form a stereo pair. The left one becomes camera 2, the right one camera 3.
There are no grey cameras; in the calibration, camera 0 is camera 2, and camera 1 is camera 3 (or camera 2 if
there is no pair), so that "camera 0" of all poses and labels is the left camera.
"""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
from typing import Dict, Iterable, List, Optional

import numpy as np

from ...dataset import Dataset, Record, Sequence
from ...errors import DatasetError
from ..clouds import cloud, sweep_s, untwist_argument, untwisted
from ..folders import place
from ..optics import Lens
from ..poses import OPTICAL_FROM_BODY, Pose, mount
from ..rig import (
    Rig,
    Track,
    common_ticks,
    optics,
    pick_rig,
    pick_sensor,
    picture_file,
    rig_arguments,
    sequences_of,
)

#: Largest deviation of a pair of cameras from a rectified one: m across the baseline, and rad.
PAIR_TOLERANCE = 1e-6


@dataclasses.dataclass(frozen=True)
class Calibration:
    """Holds the geometry of the carrier, which never changes."""

    left: Lens
    baseline: Optional[float]  #: m from the left to the right camera; None without a right camera
    camera_from_lidar: Pose  #: to the left camera's optical frame (x right, y down, z forward)
    lidar_from_body: Pose

    @property
    def camera_from_body(self) -> Pose:
        return self.camera_from_lidar @ self.lidar_from_body

    def projection(self, camera: int) -> np.ndarray:
        """Returns the matrix P [3, 4] of camera 0, 1, 2 or 3, which projects points of camera 0's frame."""
        k = self.left.matrix()
        shift = np.zeros((3, 1))
        if camera in (1, 3) and self.baseline is not None:
            shift[0] = -self.left.fx * self.baseline
        return np.hstack([k, shift])


@dataclasses.dataclass(frozen=True)
class Source:
    """Says what is written, and reads it."""

    dataset: Dataset
    rig: Rig
    left: str
    right: Optional[str]
    lidar: Optional[str]  #: None: no points are written, and the LiDAR's frame is the body's
    sequences: List[Sequence]
    calibration: Calibration
    link: bool
    untwist: bool

    def cameras(self) -> Dict[int, str]:
        """Returns the names of the cameras by their numbers in KITTI."""
        return {2: self.left, **({3: self.right} if self.right is not None else {})}

    def ticks(self, sequence: Sequence) -> np.ndarray:
        """Returns the ticks at which all sensors that are written fire, int64 [frames]."""
        return common_ticks(sequence, [*self.cameras().values(), *([self.lidar] if self.lidar else [])])

    def picture(self, sequence: Sequence, camera: int, tick: int, target: pathlib.Path) -> None:
        place(picture_file(sequence[self.cameras()[camera]].at(tick)), target, self.link)

    def points(self, sequence: Sequence, tick: int, track: Track) -> np.ndarray:
        """Returns the points of a frame, float32 [n, 4]: x forward, y left, z up, reflectance."""
        record = sequence[self.lidar].at(tick)
        return (untwisted(record, track) if self.untwist else cloud(record)).points

    def velodyne(self, sequence: Sequence, tick: int, track: Track, target: pathlib.Path) -> int:
        """Writes the points of a frame. Returns their number."""
        points = self.points(sequence, tick, track)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(points.astype("<f4").tobytes())
        return len(points)

    def sweep_s(self, sequence: Sequence) -> float:
        return sweep_s(sequence[self.lidar].record(0)) if self.lidar else 0.0


def _first(sequence: Sequence, name: str) -> Record:
    if len(sequence[name]) == 0:
        raise DatasetError(f"{sequence.path / name}: expected records, found none")
    return sequence[name].record(0)


def _pair(left: Record, right: Record) -> float:
    """Returns the baseline of a rectified stereo pair. Raises DatasetError if the cameras are none."""
    names = f"{left.sensor.name} and {right.sensor.name}"
    if optics(left.sensor) != optics(right.sensor):
        raise DatasetError(
            f"{names}: expected a stereo pair of equal sizes and intrinsics, found different ones"
        )
    to_optical = Pose(np.zeros(3), OPTICAL_FROM_BODY)
    offset = to_optical @ mount(left).inverse() @ mount(right) @ to_optical.inverse()
    turned = np.abs(offset.rotation - np.eye(3)).max()
    x, y, z = offset.position
    if turned > PAIR_TOLERANCE or max(abs(y), abs(z)) > PAIR_TOLERANCE or x <= 0:
        raise DatasetError(
            f"{names}: expected a stereo pair, whose right camera (--right) is moved along the picture's "
            f"rows to the right and not turned; found an offset of {x:.6g}, {y:.6g}, {z:.6g} m (right, down, "
            f"forward) and a rotation of about {turned:.2g} rad"
        )
    return float(x)


def choose(
    dataset: Dataset,
    node: Optional[str] = None,
    camera: Optional[str] = None,
    right: Optional[str] = None,
    lidar: Optional[str] = None,
    sequence: Optional[int] = None,
    link: bool = False,
    untwist: bool = False,
    without_lidar: bool = False,
) -> Source:
    """Returns what is written. Raises DatasetError if a sensor is missing or if it is not clear which one is
    meant."""
    rig = pick_rig(dataset, node, needs_camera=True, needs_lidar=not without_lidar)
    left = pick_sensor(rig, rig.cameras, camera, "camera", "--camera")
    other = None if right is None else pick_sensor(rig, rig.cameras, right, "camera", "--right")
    chosen = None if without_lidar else pick_sensor(rig, rig.lidars, lidar, "LiDAR", "--lidar")
    sequences = sequences_of(dataset, sequence)
    record = _first(sequences[0], left)
    body_from_lidar = Pose(np.zeros(3), np.eye(3)) if chosen is None else mount(_first(sequences[0], chosen))
    optical = mount(record) @ Pose(np.zeros(3), OPTICAL_FROM_BODY.T)
    calibration = Calibration(
        optics(record.sensor),
        None if other is None else _pair(record, _first(sequences[0], other)),
        optical.inverse() @ body_from_lidar,
        body_from_lidar.inverse(),
    )
    source = Source(dataset, rig, left, other, chosen, sequences, calibration, link, untwist)
    for each in sequences:
        source.ticks(each)
        for name in source.cameras().values():
            picture_file(_first(each, name))
    return source


def source_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments of choose()."""
    rig_arguments(parser)
    parser.add_argument("--camera", help="camera that becomes camera 2; needed if there are several")
    parser.add_argument("--right", help="camera to its right that becomes camera 3; default: none")
    parser.add_argument("--lidar", help="LiDAR; needed if there are several")
    parser.add_argument("--without-lidar", action="store_true", help="write pictures without points")
    untwist_argument(parser)


def choice(given: argparse.Namespace) -> Dict[str, object]:
    """Returns the arguments of choose() that were given on a command line."""
    names = "node camera right lidar sequence link untwist without_lidar".split()
    return {name: getattr(given, name) for name in names}


def numbers(values: Iterable[float]) -> str:
    """Returns numbers as KITTI's calibration files have them, with 13 significant digits."""
    return " ".join(f"{value + 0.0:.12e}" for value in np.ravel(np.asarray(values, np.float64)))


def check_numbers(sequences: List[Sequence], most: int, what: str) -> None:
    """Raises DatasetError if a sequence's number has too many digits for a name."""
    for sequence in sequences:
        if sequence.number > most:
            raise DatasetError(
                f"{sequence.path}: expected a number up to {most}, which {what} of KITTI can have, found "
                f"{sequence.number}: write it by --sequence into a folder of its own"
            )
