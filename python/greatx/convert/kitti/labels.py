# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Turns a camera's boxes into the labels of KITTI's object and tracking benchmarks.

A label has the type, truncation, occlusion, the observation angle alpha, a rectangle in the picture, height,
width and length, the place of the middle of the bottom face in the camera's frame (x right, y down, z
forward), and the rotation ry about the camera's y axis. At ry = 0 the object's front points along the
camera's x; at ry = -pi/2 it points away from the camera.

**Loss.** KITTI's boxes can turn about the camera's y axis alone. A box that is tilted against it (because the
camera pitches or rolls, or the object does) loses its tilt: its centre and size are exact, ry is that of its
x axis projected to the camera's x-z plane, and its corners are off by at most |size|/2 times twice the sine
of half the angle of the turn that is lost. Converters return the largest tilt, the angle between the box's z
axis and the camera's -y axis. Tracklets of the raw layout lose nothing.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from typing import Dict, List, Optional

import numpy as np

from ...dataset import Record
from ..objects import Seen, class_argument, seen
from ..poses import OPTICAL_FROM_BODY
from .source import Calibration

#: KITTI's types of our classes; other classes have no label unless --type names one.
TYPES = {"vehicle": "Car", "person": "Pedestrian", "uav": "Misc"}
#: Least visibility of KITTI's occlusion levels 0 (fully visible) and 1 (partly occluded); 2 below.
OCCLUSION = (0.9, 0.5)


def type_argument(parser: argparse.ArgumentParser) -> None:
    """Adds --type."""
    class_argument(parser, "type", "KITTI's type of a class", TYPES)


def wrapped(angle: float) -> float:
    """Returns the angle in [-pi, pi]."""
    return math.remainder(angle, 2 * math.pi)


def occlusion(visibility: float) -> int:
    return 0 if visibility >= OCCLUSION[0] else 1 if visibility >= OCCLUSION[1] else 2


@dataclasses.dataclass(frozen=True)
class Label:
    """Holds the values of a line of label_2 (readme.txt of the object development kit)."""

    kind: str
    truncation: float
    occlusion: int
    alpha: float
    rectangle: np.ndarray  #: [4] left, top, right, bottom; the centre of the first pixel is at 0, 0
    size: np.ndarray  #: [3] height, width, length, m
    bottom: np.ndarray  #: [3] m, in the camera's optical frame
    rotation_y: float
    tilt: float  #: rad, which the label does not hold
    track: int  #: number of the object

    def line(self) -> str:
        """Returns the 15 fields of label_2."""
        return (
            f"{self.kind} {self.truncation:.2f} {self.occlusion} {self.alpha:.6f} "
            + " ".join(f"{value:.2f}" for value in self.rectangle)
            + " "
            + " ".join(f"{value + 0.0:.6f}" for value in [*self.size, *self.bottom, self.rotation_y])
        )

    def tracking_line(self, frame: int) -> str:
        """Returns the 17 fields of label_02; truncation is 0 or 1 there (some part is outside)."""
        words = self.line().split()
        words[1] = "1" if self.truncation > 0.005 else "0"
        return " ".join([str(frame), str(self.track), *words])


def rectangle(object_: Seen, calibration: Calibration) -> np.ndarray:
    """Returns the amodal rectangle in KITTI's pixels, in which a whole picture is 0, 0, w - 1, h - 1."""
    most = [calibration.left.width - 1, calibration.left.height - 1] * 2
    return np.clip(object_.amodal - 0.5, 0.0, most)


def label(object_: Seen, kind: str, calibration: Calibration) -> Label:
    centre = OPTICAL_FROM_BODY @ object_.sensor_from_box.position
    axes = OPTICAL_FROM_BODY @ object_.sensor_from_box.rotation
    length, width, height = object_.size
    rotation_y = math.atan2(-axes[2, 0], axes[0, 0])
    return Label(
        kind,
        object_.truncation,
        occlusion(object_.visibility),
        wrapped(rotation_y - math.atan2(centre[0], centre[2])),
        rectangle(object_, calibration),
        np.array([height, width, length]),
        centre + [0.0, height / 2, 0.0],
        rotation_y,
        math.acos(float(np.clip(-axes[1, 2], -1.0, 1.0))),
        object_.instance,
    )


def labels(record: Optional[Record], types: Dict[str, str], calibration: Calibration) -> List[Label]:
    """Returns the labels of the objects of a record that have a type and of which a pixel is visible; none if
    there is no record."""
    if record is None:
        return []
    return [
        label(each, types[each.kind], calibration)
        for each in seen(record)
        if each.kind in types and each.visible_pixels > 0
    ]
