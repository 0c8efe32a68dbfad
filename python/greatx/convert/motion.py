# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the motion of nodes and of frames on them, and writes numbers without losing a bit.

Times are whole nanoseconds of the data set's index. Numbers have 17 digits.
"""

from __future__ import annotations

from typing import List, Sequence as SequenceOf, Tuple

import numpy as np

from ..dataset import Sequence
from ..errors import DatasetError
from ..files import interpreting
from ..links import rotation
from .files import stacked
from .poses import OPTICAL_FROM_BODY, Pose, mount, node_of, nodes_of


class Motion:
    """Holds the motion of one node over a sequence."""

    def __init__(self, sequence: Sequence, node: str):
        nodes = nodes_of(sequence)
        if node not in nodes:
            raise DatasetError(f"{sequence.dataset.path}: has no node {node!r}; nodes are {', '.join(nodes)}")
        number, poses = nodes.index(node), sequence.poses
        with interpreting(sequence.path / poses.name):
            self.time_ns = poses.index[:, 1]
            self.position = stacked(poses, "position")[:, number]
            self.rotation = rotation(stacked(poses, "orientation")[:, number])
            self._arrays = {
                name: stacked(poses, name)[:, number]
                for name in ("velocity", "acceleration", "angular_velocity")
                if name in poses
            }
        self._where = f"{sequence.dataset.path}: {poses.name}"

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._arrays:
            raise DatasetError(f"{self._where}: expected an array {name!r}, found none")
        return self._arrays[name]

    def poses(self, node_from_frame: Pose) -> List[Pose]:
        """Returns world from a frame at the node, at every record."""
        return [Pose(p, r) @ node_from_frame for p, r in zip(self.position, self.rotation)]


def continuous(quaternions: SequenceOf[np.ndarray]) -> List[np.ndarray]:
    """Returns the same rotations with the signs that make neighbours similar."""
    out: List[np.ndarray] = []
    for q in quaternions:
        out.append(-q if out and float(q @ out[-1]) < 0 else q)
    return out


def frame_of(sequence: Sequence, name: str) -> Tuple[str, Pose]:
    """Returns the node, and node from frame, of a node or a sensor. The frame of a camera is optical."""
    nodes = nodes_of(sequence)
    if name in nodes:
        return name, Pose(np.zeros(3), np.eye(3))
    if name not in sequence.sensors or "/" not in name:
        known = [*nodes, *(s for s in sequence.sensors if "/" in s)]
        raise DatasetError(
            f"{sequence.dataset.path}: has no node or mounted sensor {name!r}; it has {', '.join(known)}"
        )
    sensor = sequence[name]
    if len(sensor) == 0:
        raise DatasetError(f"{sequence.path}: {name}: expected records, found none")
    pose = mount(sensor.record(0))
    if sensor.kind in ("camera", "event_camera"):
        pose = pose @ Pose(np.zeros(3), OPTICAL_FROM_BODY.T)
    return node_of(name, nodes), pose


def decimal_seconds(time_ns: int) -> str:
    """Returns nanoseconds as seconds with nine decimals, exactly."""
    return f"{time_ns // 10**9}.{time_ns % 10**9:09d}"


def number(value: float) -> str:
    return repr(float(value))
