# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Rigid poses of nodes and sensors, and the turns between the frames of axes that tools use.

greatx has three kinds of frames, all right-handed (docs/dataset.md, docs/camera.md): the world (x east, y
north, z up), a body or a sensor that is no camera (x forward, y left, z up), and a camera's optical frame
(x right, y down, z forward). `body_from_sensor` of a camera leads to a sensor frame with the axes of a body;
OPTICAL_FROM_BODY leads on to the optical frame.
"""

from __future__ import annotations

import dataclasses
from typing import List

import numpy as np

from ..dataset import Record, Sequence
from ..errors import DatasetError
from ..files import Field
from ..links import rotation

#: Rotation [3, 3] from body axes (x forward, y left, z up) to optical axes (x right, y down, z forward).
OPTICAL_FROM_BODY = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


@dataclasses.dataclass(frozen=True)
class Pose:
    """Leads from a frame B to a frame A: p_A = rotation p_B + position."""

    position: np.ndarray  #: float64 [3] m, origin of B in A
    rotation: np.ndarray  #: float64 [3, 3], A from B

    def __matmul__(self, other: "Pose") -> "Pose":
        """Returns A from C, of A from B and B from C."""
        return Pose(self.position + self.rotation @ other.position, self.rotation @ other.rotation)

    def inverse(self) -> "Pose":
        return Pose(-self.rotation.T @ self.position, self.rotation.T)

    def apply(self, points: np.ndarray) -> np.ndarray:
        """Returns points [..., 3] of B in A."""
        return np.asarray(points, float) @ self.rotation.T + self.position

    def matrix(self) -> np.ndarray:
        """Returns the homogeneous matrix [4, 4]."""
        out = np.eye(4)
        out[:3, :3], out[:3, 3] = self.rotation, self.position
        return out

    @property
    def quaternion(self) -> np.ndarray:
        """The rotation as a unit quaternion [4] w, x, y, z."""
        return quaternion(self.rotation)


def quaternion(matrix: np.ndarray) -> np.ndarray:
    """Returns the unit quaternion (w, x, y, z; the first nonzero component positive) of a rotation [3, 3]. It
    divides by the largest component, so no rotation loses digits (Shepperd, J. Guidance and Control 1, 1978).
    """
    m = np.asarray(matrix, float)
    trace = np.trace(m)
    largest = int(np.argmax([trace, m[0, 0], m[1, 1], m[2, 2]]))
    if largest == 0:
        q = [1.0 + trace, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q = [0.0] * 4
        q[0] = m[k, j] - m[j, k]
        q[1 + i] = 1.0 + m[i, i] - m[j, j] - m[k, k]
        q[1 + j] = m[j, i] + m[i, j]
        q[1 + k] = m[k, i] + m[i, k]
    out = np.array(q) / np.linalg.norm(q)
    return -out if out[np.flatnonzero(out)[0]] < 0 else out


def nodes_of(sequence: Sequence) -> List[str]:
    """Returns the names of the nodes in the order of the arrays of poses."""
    metadata = sequence.poses.metadata
    return [entry.text() for entry in Field(metadata.where, metadata)["nodes"].items(1 << 20)]


def node_pose(sequence: Sequence, node: str, tick: int) -> Pose:
    """Returns world from body of a node at a tick that has a record."""
    names = nodes_of(sequence)
    if node not in names:
        raise DatasetError(f"{sequence.dataset.path}: has no node {node!r}; nodes are {', '.join(names)}")
    poses = sequence.at(tick)[sequence.poses.name]
    number = names.index(node)
    return Pose(np.array(poses["position"][number]), rotation(poses["orientation"][number]))


def node_of(sensor_name: str, nodes: List[str]) -> str:
    """Returns the node of a sensor NODE/SENSOR: the longest of the names that begin it."""
    for name in sorted(nodes, key=len, reverse=True):
        if sensor_name.startswith(name + "/"):
            return name
    raise DatasetError(f"the sensor {sensor_name!r} is at no node; nodes are {', '.join(nodes)}")


def mount(record: Record) -> Pose:
    """Returns body from sensor of a record's sensor, with the axes of a body."""
    metadata = record.sensor.metadata
    field = Field(metadata.where, metadata)["body_from_sensor"]
    numbers = {
        part: [entry.number(-1e12, 1e12) for entry in field[part].items(count)]
        for part, count in (("position_m", 3), ("orientation_wxyz", 4))
    }
    if len(numbers["position_m"]) != 3 or len(numbers["orientation_wxyz"]) != 4:
        raise field.fail("position_m of 3 and orientation_wxyz of 4 numbers")
    return Pose(np.array(numbers["position_m"]), rotation(numbers["orientation_wxyz"]))


def sensor_pose(record: Record) -> Pose:
    """Returns world from sensor at a record, with the axes of a body also for cameras."""
    sequence = record.sensor.sequence
    node = node_of(record.sensor.name, nodes_of(sequence))
    return node_pose(sequence, node, record.tick) @ mount(record)


def optical_pose(record: Record) -> Pose:
    """Returns world from the optical frame of a camera at a record."""
    return sensor_pose(record) @ Pose(np.zeros(3), OPTICAL_FROM_BODY.T)
