# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Finds the records of a data set or a campaign: ticks of the channel, which modalities they have, where the
drone was, and whose flight it was.
"""
from __future__ import annotations

import dataclasses
import hashlib
from typing import Dict, List, Optional

import numpy as np

import greatx
from greatx import links
from greatx.errors import Error
from tasks.common import splits
from tasks.common.data import PARTS, Opened, fingerprint, sequences_of

from .settings import MODALITIES, Split


@dataclasses.dataclass
class Records:
    """Records in order of cell, sequence and tick. Arrays have an entry for each record."""

    cells: List[str]  #: names of the cells; one empty name for a data set
    cell: np.ndarray  #: int, index into cells
    sequence: np.ndarray  #: int, index into Dataset.sequences
    tick: np.ndarray
    position_m: np.ndarray  #: [n, 3], of the node that carries the receiver
    trajectory: np.ndarray  #: int; equal numbers: the same flight, also in another cell
    line_of_sight: np.ndarray  #: bool
    present: np.ndarray  #: bool [n, modalities]
    modalities: List[str]  #: those that some record has
    absent: List[str]  #: those that were asked for and no record has
    sensors: List[Dict[str, str]]  #: of each cell: modality -> sensor
    part: Optional[np.ndarray]  #: index into PARTS, of a campaign's own split
    fingerprint: str  #: of the data's contents

    def __len__(self) -> int:
        return len(self.tick)

    def split(self, settings: Split) -> Dict[str, np.ndarray]:
        """Returns the records of each part. No flight and no place is in two parts, for `by: trajectory` and
        `by: place`. Raises Error if a part is empty.
        """
        if settings.by == "place":
            return splits.by_place(self.position_m, settings.cell_m, settings.shares, gap_m=settings.gap_m)
        if self.part is None:
            return splits.by_trajectory(self.trajectory, settings.shares)
        out = {name: np.flatnonzero(self.part == i) for i, name in enumerate(PARTS)}
        _check_flights(self.trajectory, out)
        return out


def _check_flights(trajectory: np.ndarray, parts: Dict[str, np.ndarray]) -> None:
    seen: Dict[int, str] = {}
    for name, rows in parts.items():
        if len(rows) == 0:
            raise Error(f"split: the campaign has no sequence in {name!r}: expected one or more in each part")
        for flight in np.unique(trajectory[rows]).tolist():
            if seen.setdefault(flight, name) != name:
                raise Error(
                    f"split: a flight is in {seen[flight]!r} and in {name!r} of the campaign's own split; "
                    "give its sequences seeds of their own, or split by place"
                )


def find(opened: Opened, wanted: List[str]) -> Records:
    """Returns the records of a data set or of a campaign with the wanted modalities. Raises Error if there is
    no channel.
    """
    parts: List[Dict[str, np.ndarray]] = []
    cells, sensors, hashes = [], [], hashlib.sha256()
    own = isinstance(opened, greatx.Campaign)
    for cell, dataset, index, part in sequences_of(opened):
        if cell not in cells:
            cells.append(cell)
            sensors.append(_sensors(dataset, wanted))
            hashes.update(f"{cell} {fingerprint(dataset)}\n".encode())
        rows = _sequence(dataset.sequences[index], sensors[-1], wanted)
        count = len(rows["tick"])
        rows["cell"] = np.full(count, len(cells) - 1)
        rows["sequence"] = np.full(count, index)
        rows["part"] = np.full(count, -1 if part is None else PARTS.index(part))
        parts.append(rows)
    joined = {name: np.concatenate([rows[name] for rows in parts]) for name in parts[0] if name != "flight"}
    flights: Dict[bytes, int] = {}
    number = [flights.setdefault(rows["flight"].tobytes(), len(flights)) for rows in parts]
    joined["trajectory"] = np.repeat(number, [len(rows["tick"]) for rows in parts])
    there = joined["present"].any(0)
    joined["present"] = joined["present"][:, there]
    part = joined.pop("part")
    return Records(
        cells=cells,
        **joined,
        modalities=[m for m, has in zip(wanted, there) if has],
        absent=[m for m, has in zip(wanted, there) if not has],
        sensors=sensors,
        part=part if own else None,
        fingerprint=hashes.hexdigest(),
    )


def _sensors(dataset: greatx.Dataset, wanted: List[str]) -> Dict[str, str]:
    """Returns the sensor of each modality: the first channel, and the first sensors of their kinds at the
    node of its first receiver.
    """
    sequence = dataset.sequences[0]
    channel = sequence.first("csi", ["cfr"])
    poses = sequence.poses
    node = poses.metadata["nodes"][links.node_of(poses, links.receivers(channel)[0])]
    out = {}
    for name in wanted:
        kind = MODALITIES[name]
        for sensor in sequence.sensors.values():
            here = sensor is channel if kind == "csi" else sensor.name.startswith(node + "/")
            if sensor.kind == kind and here and _has(sensor, name):
                out[name] = sensor.name
                break
    return out


def _has(sensor: "greatx.Sensor", modality: str) -> bool:
    if modality == "radar":
        return "range_azimuth" in sensor or "range_doppler" in sensor
    needs = {"rgb": "rgb", "depth": "depth", "csi": "cfr", "lidar": "points", "events": "t"}
    return needs[modality] in sensor


def _sequence(
    sequence: "greatx.Sequence", sensors: Dict[str, str], wanted: List[str]
) -> Dict[str, np.ndarray]:
    channel = sequence[sensors["csi"]]
    poses = sequence.poses
    node = links.node_of(poses, links.receivers(channel)[0])
    ticks = channel.ticks
    rows = np.searchsorted(poses.ticks, ticks)
    position = np.asarray(poses.position[:][rows, node], np.float64)
    present = np.zeros((len(ticks), len(wanted)), bool)
    for i, name in enumerate(wanted):
        if name in sensors:
            present[:, i] = np.isin(ticks, sequence[sensors[name]].ticks)
    return {
        "tick": np.asarray(ticks),
        "position_m": position,
        "present": present,
        "line_of_sight": np.asarray(channel["line_of_sight"][:])[:, 0, 0] > 0,
        "flight": position,
    }
