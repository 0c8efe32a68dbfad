# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lists the ticks of a campaign or a data set at which all the sensors of a task have a record.

A drive is one sequence. Drives of the same seed and number have the same trajectories, by day and by night:
they are one trajectory, which lies in one split as a whole.
"""
from __future__ import annotations

import dataclasses
import hashlib
import pathlib
from typing import Any, Dict, List, Sequence, Tuple

import numpy as np

import greatx
from greatx.errors import Error
from tasks.common.data import PARTS, fingerprint, sequences_of
from tasks.common.splits import by_trajectory


@dataclasses.dataclass(frozen=True)
class Drives:
    """Items, one for each tick of each drive, in order of drive and tick."""

    path: pathlib.Path
    sequences: List[Any]  #: greatx.Sequence of each drive
    cells: List[str]  #: names of the cells; one, "", of a data set that is no campaign
    cell: np.ndarray  #: int64 [n]: number of the item's cell
    drive: np.ndarray  #: int64 [n]: number of the item's drive
    trajectory: np.ndarray  #: int64 [n]: items with the same number come from the same trajectories
    tick: np.ndarray  #: int64 [n]
    order: np.ndarray  #: int64 [n]: place of the item in its drive, 0, 1, 2, ...
    part: np.ndarray  #: int64 [n]: 0 training, 1 validation, 2 test
    fingerprint: str  #: of the data sets' manifests

    def __len__(self) -> int:
        return len(self.tick)

    def split(self) -> Dict[str, np.ndarray]:
        """Returns the items of each part."""
        return {name: np.flatnonzero(self.part == i) for i, name in enumerate(PARTS)}

    def rows(self, drive: int, sensor: str) -> Tuple[Any, np.ndarray]:
        """Returns a sensor of a drive, and the rows of the drive's items in its arrays."""
        found = self.sequences[drive][sensor]
        return found, np.searchsorted(found.ticks, self.tick[self.drive == drive])

    def gather(self, sensor: str, array: str) -> np.ndarray:
        """Returns an array of fixed shape of all items, [n, ...]."""
        parts = []
        for drive in range(len(self.sequences)):
            found, rows = self.rows(drive, sensor)
            parts.append(np.asarray(found[array])[rows])
        return np.concatenate(parts)


def open_drives(path: pathlib.Path, sensors: Sequence[str], shares: Dict[str, float]) -> Drives:
    """Returns the drives of a campaign's folder, with its own split, or of a data set, which is split by
    `shares` of its trajectories. Raises Error if a sensor is missing or a part has no drive.
    """
    listed = list(sequences_of(greatx.load(path)))
    own = {}
    if any(found.part is None for found in listed):
        own = by_trajectory(np.arange(len(listed)), {name: shares[name] for name in PARTS})
    cells = list(dict.fromkeys(found.cell for found in listed))
    sequences = [found.dataset.sequences[found.index] for found in listed]
    trajectories: Dict[Tuple[int, int], int] = {}
    columns: Dict[str, List[np.ndarray]] = {name: [] for name in ("cell", "trajectory", "part", "tick")}
    drive, order = [], []
    for number, (found, sequence) in enumerate(zip(listed, sequences)):
        ticks = _common_ticks(sequence, sensors)
        identity = (int(sequence.dataset.run["seed"]), sequence.number)
        part = found.part or next(name for name in PARTS if number in own[name])
        trajectory = trajectories.setdefault(identity, len(trajectories))
        values = (cells.index(found.cell), trajectory, PARTS.index(part))
        for name, value in zip(columns, values):
            columns[name].append(np.full(len(ticks), value))
        columns["tick"].append(ticks)
        drive.append(np.full(len(ticks), number))
        order.append(np.arange(len(ticks)))
    joined = {name: np.concatenate(values) for name, values in columns.items()}
    for i, name in enumerate(PARTS):
        if not np.any(joined["part"] == i):
            raise Error(f"{path}: no drive fell to {name!r}: expected more drives, or larger shares")
    return Drives(
        path=pathlib.Path(path),
        sequences=sequences,
        cells=cells,
        drive=np.concatenate(drive),
        order=np.concatenate(order),
        fingerprint=_fingerprint({found.dataset.path: found.dataset for found in listed}),
        **joined,
    )


def _common_ticks(sequence: Any, sensors: Sequence[str]) -> np.ndarray:
    known = sequence.dataset.sensors
    for name in sensors:
        if name not in known:
            raise Error(
                f"{sequence.dataset.path}: expected the sensor {name!r} of the configuration, found "
                f"{', '.join(known)}"
            )
    ticks = sequence[sensors[0]].ticks
    for name in sensors[1:]:
        ticks = np.intersect1d(ticks, sequence[name].ticks)
    return ticks


def _fingerprint(datasets: Dict[pathlib.Path, greatx.Dataset]) -> str:
    return hashlib.sha256("".join(map(fingerprint, datasets.values())).encode()).hexdigest()
