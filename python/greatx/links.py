# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Finds the antennas at the ends of a channel's links, and the paths of each link."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple

import numpy as np

from .errors import DatasetError
from .files import Field

if TYPE_CHECKING:
    from .dataset import Record, Sensor

SPEED_OF_LIGHT = 299792458.0  #: m/s

# Values of the arrays `interaction`.
NONE, REFLECTION, TRANSMISSION, DIFFRACTION, SCATTERING, TARGET = range(6)


def check_channel(sensor: "Sensor") -> "Sensor":
    if sensor.kind != "csi":
        raise DatasetError(
            f"{sensor.sequence.dataset.path}: {sensor.name} is a {sensor.kind}, not a channel (csi)"
        )
    return sensor


def _antennas(sensor: "Sensor", key: str) -> List[Dict[str, Any]]:
    ends = Field(sensor.metadata.where, sensor.metadata)[key]
    if isinstance(ends.value, dict):  # a single antenna
        ends = Field(ends.file, [ends.value], ends.name)
    for end in ends.items(1 << 20):
        end["name"].text()
        mount = end["body_from_antenna"]
        for part, length in (("position_m", 3), ("orientation_wxyz", 4)):
            numbers = mount[part].items(length)
            if len(numbers) != length:
                raise mount[part].fail(f"{length} numbers")
            for number in numbers:
                number.number(-1e12, 1e12)
    return ends.value


def transmitters(sensor: "Sensor") -> List[Dict[str, Any]]:
    """Returns the descriptions of a channel's transmitting antennas in dataset.json, in the order of the axis
    tx.
    """
    meta = check_channel(sensor).metadata
    return _antennas(sensor, "transmitters" if "transmitters" in meta else "transmitter")


def receivers(sensor: "Sensor") -> List[Dict[str, Any]]:
    """Returns the descriptions of the receiving antennas, in the order of the axis rx."""
    return _antennas(check_channel(sensor), "receivers")


def rotation(orientation_wxyz: Any) -> np.ndarray:
    """Returns the rotation matrices [..., 3, 3] of unit quaternions [..., 4] (w, x, y, z). A matrix
    transforms from body axes to world axes.
    """
    w, x, y, z = np.moveaxis(np.asarray(orientation_wxyz, float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def node_of(poses: "Sensor", antenna: Dict[str, Any]) -> int:
    """Returns the number, in the arrays of `poses`, of the node that carries an antenna, an entry of
    `transmitters` or `receivers` with the name NODE/SENSOR.
    """
    nodes = poses.metadata["nodes"]
    if not isinstance(nodes, list) or not all(isinstance(n, str) for n in nodes):
        raise DatasetError(f"{poses.metadata.where}.nodes: expected the names of nodes")
    carrying = [n for n in nodes if antenna["name"].startswith(n + "/")]
    if not carrying:
        raise DatasetError(
            f"{poses.sequence.dataset.path}: the antenna {antenna['name']!r} is at no node; nodes are "
            f"{', '.join(nodes)}"
        )
    return nodes.index(max(carrying, key=len))


def antenna_pose(record: "Record", antenna: Dict[str, Any]) -> Tuple[np.ndarray, np.ndarray]:
    """Returns the world position [3] in metres and the rotation world_from_antenna [3, 3] of an antenna at a
    record. `antenna` is an entry of `transmitters` or `receivers`.
    """
    poses = record.sensor.sequence.at(record.tick)[record.sensor.sequence.poses.name]
    nodes = poses.sensor.metadata["nodes"]
    if not isinstance(nodes, list) or len(nodes) != len(poses["position"]):
        raise DatasetError(
            f"{poses.sensor.metadata.where}.nodes: expected the names of {len(poses['position'])} nodes"
        )
    node, mount = node_of(poses.sensor, antenna), antenna["body_from_antenna"]
    turn = rotation(poses["orientation"][node])
    return poses["position"][node] + turn @ np.array(mount["position_m"]), turn @ rotation(
        mount["orientation_wxyz"]
    )


def paths_of(record: "Record", rx: Optional[int] = None, tx: Optional[int] = None) -> Dict[str, np.ndarray]:
    """Returns the arrays below paths/ of a record by name (docs/dataset.md), each [path, ...], for all links
    or only for receiver rx and transmitter tx. The arrays are views if the selected paths are contiguous, as
    those of one link always are.
    """
    sensor = check_channel(record.sensor)
    for what, number, ends in (
        ("receiver", rx, receivers(sensor)),
        ("transmitter", tx, transmitters(sensor)),
    ):
        if number is not None and not 0 <= number < len(ends):
            raise IndexError(f"{sensor.name} has {len(ends)} {what}s, not one of number {number}")
    arrays = {
        o.name[len("paths/") :]: record[o.name]
        for o in sensor.info.outputs.values()
        if o.name.startswith("paths/")
    }
    if not arrays:
        raise DatasetError(
            f"{sensor.sequence.path / sensor.name}: the data set keeps no paths; the scenario's channel "
            "needs outputs: [cfr, paths]"
        )
    if "delay" not in arrays or len({len(a) for a in arrays.values()}) != 1:
        raise DatasetError(
            f"{sensor.sequence.path / sensor.name}: expected arrays of as many paths, among them `delay`, "
            "found " + ", ".join(f"{name} {len(a)}" for name, a in arrays.items())
        )
    for name, ends in (("rx", receivers(sensor)), ("tx", transmitters(sensor))):
        if len(arrays.get(name, ())) and not 0 <= arrays[name].min() <= arrays[name].max() < len(ends):
            raise DatasetError(
                f"{sensor.sequence.path / sensor.name}: expected {name} from 0 to {len(ends) - 1}, found "
                f"{arrays[name].min()} to {arrays[name].max()}"
            )
    mine = np.ones(len(arrays["delay"]), bool)
    for name, number in (("rx", rx), ("tx", tx)):
        if number is not None and name in arrays:
            mine &= arrays[name] == number
    which = np.flatnonzero(mine)
    if len(which) == len(mine):
        return arrays
    if len(which) == 0:
        return {name: a[:0] for name, a in arrays.items()}
    if which[-1] - which[0] + 1 == len(which):
        return {name: a[which[0] : which[-1] + 1] for name, a in arrays.items()}
    return {name: a[which] for name, a in arrays.items()}
