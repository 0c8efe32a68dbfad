# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Chooses the node and the sensors that an exporter writes, and gives their poses, optics and times.

Formats of driving data hold one carrier with cameras and a LiDAR. A `Rig` is such a carrier: a node and the
names of its sensors, which are the same in all sequences. Data flow: arguments -> pick_rig() -> Rig ->
common_ticks() for each sequence -> the exporter asks for records, poses and optics tick by tick.

The checks are made before anything is written: each sensor of a rig exists, has the needed arrays, and has
records.
"""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
from typing import Dict, Iterable, List, Optional, Tuple

import numpy as np

from ..arrays import Frames
from ..dataset import Dataset, Record, Sensor, Sequence
from ..errors import DatasetError
from ..layout import SUFFIX
from ..links import rotation
from .common import link_argument, pick_sequence, sequence_argument
from .optics import Lens, lens_of
from .poses import Pose, node_of, nodes_of


@dataclasses.dataclass(frozen=True)
class Rig:
    """Names a node and the sensors of it that are exported."""

    node: str
    cameras: Tuple[str, ...]
    lidars: Tuple[str, ...]
    radars: Tuple[str, ...]

    @property
    def sensors(self) -> Tuple[str, ...]:
        return self.cameras + self.lidars + self.radars


def optics(sensor: Sensor) -> Lens:
    """Returns a camera's intrinsics. Raises DatasetError for a camera with lens distortion, because the
    formats that need this hold rectified pictures."""
    if "distortion" in sensor.metadata:
        raise DatasetError(
            f"{sensor.sequence.dataset.path}: {sensor.name}: expected a camera without distortion, because "
            "this format holds rectified pictures; found distortion"
        )
    return lens_of(sensor)


class Track:
    """Gives the poses of nodes of one sequence at ticks that have records. It reads the arrays once."""

    def __init__(self, sequence: Sequence):
        self._sequence = sequence
        self._poses = sequence.poses
        self.nodes = nodes_of(sequence)
        self._ticks = self._poses.ticks
        self._arrays: Dict[str, np.ndarray] = {}

    def _row(self, tick: int) -> int:
        row = int(np.searchsorted(self._ticks, tick))
        if row == len(self._ticks) or self._ticks[row] != tick:
            raise DatasetError(f"{self._sequence.path}: expected poses at tick {tick}, found none")
        return row

    def vector(self, name: str, node: int, tick: int) -> np.ndarray:
        """Returns a row of an array of the poses, such as velocity [3] m/s in world axes."""
        if name not in self._arrays:
            self._arrays[name] = self._poses[name]
        return np.array(self._arrays[name][self._row(tick)][node], np.float64)

    def pose(self, node: int, tick: int) -> Pose:
        """Returns world from body of the node of this number."""
        return Pose(self.vector("position", node, tick), rotation(self.vector("orientation", node, tick)))


def sequences_of(dataset: Dataset, number: Optional[int]) -> List[Sequence]:
    """Returns all sequences, or the one of this number."""
    return list(dataset.sequences) if number is None else [pick_sequence(dataset, number)]


def rig_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments that say what is exported: --node, --sequence, and those of files."""
    parser.add_argument("--node", help="node that carries the sensors; needed if several could be meant")
    sequence_argument(parser)
    link_argument(parser)


def _kinds(dataset: Dataset, node: str, nodes: List[str], kind: str) -> List[str]:
    """Returns the names of a node's sensors of a kind, in the order of the data set."""
    return [
        name
        for name, info in dataset.sensors.items()
        if info.kind == kind and "/" in name and node_of(name, nodes) == node
    ]


def _writable(dataset: Dataset, name: str) -> bool:
    """Returns whether a camera has pictures in files that an exporter can copy."""
    located = dataset.sensors[name].locate("rgb")
    return located is not None and located[0].format == "png"


def pick_rig(dataset: Dataset, node: Optional[str], needs_camera: bool, needs_lidar: bool) -> Rig:
    """Returns a node with all its cameras that have pictures, its LiDARs, and its radars that have
    detections. Without a name, it is the only node that has what is needed. Raises DatasetError if there is
    none, or if there are several.
    """
    nodes = nodes_of(dataset.sequences[0])
    if node is not None and node not in nodes:
        raise DatasetError(f"{dataset.path}: has no node {node!r}; nodes are {', '.join(nodes)}")
    rigs = []
    for name in nodes:
        cameras = [c for c in _kinds(dataset, name, nodes, "camera") if _writable(dataset, c)]
        rig = Rig(
            name,
            tuple(cameras),
            tuple(_kinds(dataset, name, nodes, "lidar")),
            tuple(
                radar
                for radar in _kinds(dataset, name, nodes, "radar")
                if "detections" in dataset.sensors[radar].arrays
            ),
        )
        if (node is None or name == node) and rig.sensors:
            if (rig.cameras or not needs_camera) and (rig.lidars or not needs_lidar):
                rigs.append(rig)
    if len(rigs) == 1:
        return rigs[0]
    wanted = (
        " and ".join(["a camera with rgb"] * needs_camera + ["a LiDAR"] * needs_lidar)
        or "a camera with rgb, a LiDAR or a radar"
    )
    if rigs:
        raise DatasetError(
            f"{dataset.path}: {', '.join(r.node for r in rigs)} have {wanted}: say which one (--node)"
        )
    has = ", ".join(f"{name} ({info.kind})" for name, info in dataset.sensors.items() if "/" in name)
    at = f"the node {node}" if node is not None else "a node"
    raise DatasetError(f"{dataset.path}: expected {at} with {wanted}, found {has or 'no sensor'}")


def pick_sensor(rig: Rig, names: Iterable[str], name: Optional[str], what: str, option: str) -> str:
    """Returns the sensor of this name (with or without its node) among the names, or the only one. Raises
    DatasetError if there is none, or if there are several."""
    names = list(names)
    for each in names:
        if name is not None and name in (each, each[len(rig.node) + 1 :]):
            return each
    if name is None and len(names) == 1:
        return names[0]
    found = ", ".join(names) or "none"
    if name is None:
        raise DatasetError(f"{rig.node}: has several {what}s: say which one ({option}); found {found}")
    raise DatasetError(f"{rig.node}: expected a {what} {name!r} ({option}), found {found}")


def restricted(rig: Rig, names: Optional[List[str]]) -> Rig:
    """Returns a rig with only the named sensors (with or without the node); None stands for all. Raises
    DatasetError if the rig has no sensor of a name."""
    if names is None:
        return rig
    chosen = {pick_sensor(rig, rig.sensors, name, "sensor", "--sensor") for name in names}
    kinds = (tuple(name for name in kind if name in chosen) for kind in (rig.cameras, rig.lidars, rig.radars))
    return Rig(rig.node, *kinds)


def common_ticks(sequence: Sequence, names: Iterable[str]) -> np.ndarray:
    """Returns the ticks at which all these sensors have records, int64 [n]. Raises DatasetError if there is
    none."""
    names = list(names)
    ticks: Optional[np.ndarray] = None
    for name in names:
        mine = sequence[name].ticks
        ticks = mine if ticks is None else np.intersect1d(ticks, mine, assume_unique=True)
    if ticks is None or len(ticks) == 0:
        counts = ", ".join(f"{name} ({len(sequence[name])} records)" for name in names)
        raise DatasetError(f"{sequence.path}: expected a tick at which {counts} all fire, found none")
    return ticks


def picture_file(record: Record) -> pathlib.Path:
    """Returns the PNG of a camera's record. Raises DatasetError if its pictures are in no PNG."""
    sensor = record.sensor
    frames = sensor["rgb"] if "rgb" in sensor else None
    if not isinstance(frames, Frames) or frames.path(record.row).suffix != SUFFIX["png"]:
        raise DatasetError(
            f"{sensor.sequence.dataset.path}: {sensor.name}: expected pictures in PNG files (output rgb), "
            "found none"
        )
    return frames.path(record.row)


def time_ns(sequence: Sequence, tick: int) -> int:
    """Returns the time of a tick that has a record, in nanoseconds from the beginning of the sequence."""
    row = int(np.searchsorted(sequence.index[:, 0], tick))
    return int(sequence.index[row, 1])
