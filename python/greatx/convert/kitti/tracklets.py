# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes tracklet_labels.xml of KITTI's raw recordings: the boxes of objects over time, in the LiDAR's frame.

A tracklet has a type, height, width and length, the frame in which it begins, and a pose for each frame from
there on: the middle of the bottom face (x forward, y left, z up) and the rotations rx, ry, rz with R =
Rz(rz) Ry(ry) Rx(rx), of which KITTI's own files use rz alone. An object that the camera loses and finds again
has several tracklets.
"""

from __future__ import annotations

import dataclasses
from typing import Dict, List, Tuple
from xml.sax.saxutils import escape

import numpy as np

from ...dataset import Record
from ..objects import Seen, seen
from ..poses import OPTICAL_FROM_BODY, Pose
from .labels import occlusion
from .oxts import angles
from .source import Calibration


@dataclasses.dataclass
class Tracklet:
    kind: str
    size: np.ndarray  #: [3] m: length, width, height
    first: int  #: number of its first frame
    poses: List[Tuple[Pose, int, int]]  #: LiDAR from box (centre), occlusion, truncation


class Tracklets:
    """Collects the objects of a sequence frame by frame."""

    def __init__(self, types: Dict[str, str], calibration: Calibration):
        self._types, self._calibration = types, calibration
        self._open: Dict[int, Tracklet] = {}
        self.all: List[Tracklet] = []

    def add(self, frame: int, record: Record) -> None:
        """Adds the visible objects of the camera's record of a frame. Frames must come in order."""
        optical = Pose(np.zeros(3), OPTICAL_FROM_BODY)
        lidar_from_sensor = self._calibration.camera_from_lidar.inverse() @ optical
        still: Dict[int, Tracklet] = {}
        for each in seen(record):
            if each.kind not in self._types or each.visible_pixels == 0:
                continue
            tracklet = self._open.get(each.instance)
            if tracklet is None:
                tracklet = Tracklet(self._types[each.kind], each.size, frame, [])
                self.all.append(tracklet)
            tracklet.poses.append(
                (lidar_from_sensor @ each.sensor_from_box, occlusion(each.visibility), _truncation(each))
            )
            still[each.instance] = tracklet
        self._open = still

    def xml(self) -> str:
        lines = [
            '<?xml version="1.0" encoding="UTF-8" standalone="yes" ?>',
            "<!DOCTYPE boost_serialization>",
            '<boost_serialization signature="serialization::archive" version="9">',
            '<tracklets class_id="0" tracking_level="0" version="0">',
            f"<count>{len(self.all)}</count>",
            "<item_version>1</item_version>",
        ]
        for tracklet in self.all:
            lines += _item(tracklet)
        return "\n".join([*lines, "</tracklets>", "</boost_serialization>", ""])


def _truncation(object_: Seen) -> int:
    """Returns 0 for an object within the picture, or 1 for one that is cut off."""
    return 1 if object_.truncation > 0.005 else 0


def _item(tracklet: Tracklet) -> List[str]:
    length, width, height = tracklet.size
    lines = [
        '<item class_id="1" tracking_level="0" version="1">',
        f"<objectType>{escape(tracklet.kind)}</objectType>",
        f"<h>{height:.9g}</h>",
        f"<w>{width:.9g}</w>",
        f"<l>{length:.9g}</l>",
        f"<first_frame>{tracklet.first}</first_frame>",
        '<poses class_id="2" tracking_level="0" version="0">',
        f"<count>{len(tracklet.poses)}</count>",
        "<item_version>2</item_version>",
    ]
    for pose, occluded, truncated in tracklet.poses:
        bottom = pose.apply(np.array([0.0, 0.0, -height / 2]))
        values = dict(zip(("tx", "ty", "tz", "rx", "ry", "rz"), [*bottom, *angles(pose.rotation)]))
        lines.append('<item class_id="3" tracking_level="0" version="2">')
        lines += [f"<{name}>{value:.12g}</{name}>" for name, value in values.items()]
        lines += [
            "<state>2</state>",  # labelled, not interpolated
            f"<occlusion>{occluded}</occlusion>",
            "<occlusion_kf>0</occlusion_kf>",
            f"<truncation>{truncated}</truncation>",
            "<amt_occlusion>-1</amt_occlusion>",
            "<amt_occlusion_kf>-1</amt_occlusion_kf>",
            "<amt_border_l>-1</amt_border_l>",
            "<amt_border_r>-1</amt_border_r>",
            "<amt_border_kf>-1</amt_border_kf>",
            "</item>",
        ]
    return [*lines, "</poses>", "<finished>1</finished>", "</item>"]
