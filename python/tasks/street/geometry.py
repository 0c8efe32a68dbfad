# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What the true poses say about a link: where the car is seen from the panel, and whether the box of a
vehicle stands between both. No network sees any of this: it checks labels, and gives the baselines that know
the poses.
"""
from __future__ import annotations

from typing import Any, List, NamedTuple

import numpy as np

from greatx import links

from .drives import Drives


class Body(NamedTuple):
    """The box of a node's body, and its poses."""

    node: str
    low_m: np.ndarray  #: [3]: corners in the frame of the node
    high_m: np.ndarray
    position_m: np.ndarray  #: [n, 3]
    turn: np.ndarray  #: [n, 3, 3]: world_from_node
    velocity_m_s: np.ndarray  #: [n, 3], world axes


class Ends(NamedTuple):
    """The ends of the first link of a channel."""

    tx_m: np.ndarray  #: [n, 3]
    rx_m: np.ndarray  #: [n, 3]
    world_from_tx: np.ndarray  #: [n, 3, 3]
    rx_velocity_m_s: np.ndarray  #: [n, 3]

    def direction(self) -> np.ndarray:
        """Returns the unit vector from the transmitter to the receiver in the antenna's axes, [n, 3]."""
        along = self.rx_m - self.tx_m
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        return np.einsum("nij,ni->nj", self.world_from_tx, along)


def ends(drives: Drives, channel: str) -> Ends:
    """Returns the places of the antennas of the channel's first link at each item."""
    parts: List[Any] = []
    for drive in range(len(drives.sequences)):
        sensor, _ = drives.rows(drive, channel)
        poses, rows = drives.rows(drive, "poses")
        position, turn, velocity = _poses(poses, rows)
        placed = []
        for antenna in (links.transmitters(sensor)[0], links.receivers(sensor)[0]):
            node = links.node_of(poses, antenna)
            mount = antenna["body_from_antenna"]
            at = position[:, node] + turn[:, node] @ np.array(mount["position_m"])
            placed.append((at, turn[:, node] @ links.rotation(mount["orientation_wxyz"]), velocity[:, node]))
        parts.append((placed[0][0], placed[1][0], placed[0][1], placed[1][2]))
    return Ends(*(np.concatenate(part) for part in zip(*parts)))


def receiver_node(drives: Drives, channel: str) -> str:
    """Returns the name of the node that carries the channel's first receiver."""
    sensor, _ = drives.rows(0, channel)
    poses, _ = drives.rows(0, "poses")
    return poses.metadata["nodes"][links.node_of(poses, links.receivers(sensor)[0])]


def _poses(poses: Any, rows: np.ndarray):
    return (
        np.asarray(poses["position"])[rows],
        links.rotation(np.asarray(poses["orientation"])[rows]),
        np.asarray(poses["velocity"])[rows],
    )


def bodies(drives: Drives) -> List[Body]:
    """Returns the boxes of all nodes that have a body. They are the same in all drives."""
    instances = [i for i in drives.sequences[0].dataset.instances if i.get("node")]
    gathered = []
    for drive in range(len(drives.sequences)):
        poses, rows = drives.rows(drive, "poses")
        gathered.append(_poses(poses, rows))
        nodes = poses.metadata["nodes"]
    position, turn, velocity = (np.concatenate(part) for part in zip(*gathered))
    out = []
    for instance in instances:
        node = nodes.index(instance["node"])
        low, high = np.array(instance["box_m"])
        out.append(Body(instance["node"], low, high, position[:, node], turn[:, node], velocity[:, node]))
    return out


def crosses(a_m: np.ndarray, b_m: np.ndarray, low_m: np.ndarray, high_m: np.ndarray) -> np.ndarray:
    """Returns whether the segments from a to b [..., 3] meet an axis-parallel box (the slab method: T. L.
    Kay, J. T. Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986)."""
    along = b_m - a_m
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low_m - a_m) / along, (high_m - a_m) / along
    parallel = along == 0
    inside = (a_m >= low_m) & (a_m <= high_m)
    enter = np.where(parallel, np.where(inside, -np.inf, np.inf), np.minimum(first, second)).max(-1)
    leave = np.where(parallel, np.where(inside, np.inf, -np.inf), np.maximum(first, second)).min(-1)
    return (enter <= leave) & (leave >= 0) & (enter <= 1)


def blocked(link: Ends, others: List[Body], ahead_s: float = 0.0) -> np.ndarray:
    """Returns whether one of the boxes stands between the antennas, [n]; after `ahead_s` seconds at the
    velocities that car and bodies have now."""
    rx = link.rx_m + ahead_s * link.rx_velocity_m_s
    out = np.zeros(len(rx), bool)
    for body in others:
        at = body.position_m + ahead_s * body.velocity_m_s
        local = [np.einsum("nij,ni->nj", body.turn, end - at) for end in (link.tx_m, rx)]
        out |= crosses(*local, body.low_m, body.high_m)
    return out
