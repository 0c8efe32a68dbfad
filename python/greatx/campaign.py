# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a campaign: many data sets with one index (docs/campaigns.md)."""
from __future__ import annotations

import csv
import os
import pathlib
import sqlite3
from typing import Any, Dict, Iterable, Iterator, List, Optional, Tuple, Union

import numpy as np

from .dataset import Dataset, load
from .errors import DatasetError
from .samples import Samples, as_torch

SPLITS = ("train", "validation", "test")


def campaign(folder: Union[str, "os.PathLike[str]"]) -> "Campaign":
    """Opens a merged campaign. Raises DatasetError, which names the file, if the folder holds none."""
    return Campaign(folder)


class Campaign:
    """Provides the data sets of a campaign by the names of their cells, and its index."""

    def __init__(self, folder: Union[str, "os.PathLike[str]"]):
        self.path = pathlib.Path(os.path.abspath(folder))
        self._splits = self._read_splits(self.path / "splits.csv")
        self._open: Dict[str, Dataset] = {}

    @staticmethod
    def _read_splits(file: pathlib.Path) -> Dict[str, Dict[int, str]]:
        if not file.is_file():
            raise DatasetError(
                f"{file}: expected a merged campaign (`greatx campaign merge`), found no such file"
            )
        splits: Dict[str, Dict[int, str]] = {}
        with open(file, newline="", encoding="utf-8") as rows:
            for line, row in enumerate(csv.reader(rows), 1):
                if line == 1 and row == ["cell", "sequence", "split"]:
                    continue
                if line == 1 or len(row) != 3 or not row[1].isdigit() or row[2] not in SPLITS:
                    raise DatasetError(
                        f"{file}:{line}: expected cell, sequence, split; found {','.join(row)!r}"
                    )
                splits.setdefault(row[0], {})[int(row[1])] = row[2]
        return splits

    @property
    def cells(self) -> List[str]:
        """The names of the cells, in the campaign's order."""
        return list(self._splits)

    def __getitem__(self, cell: str) -> Dataset:
        """Returns the data set of a cell."""
        if cell not in self._splits:
            raise KeyError(f"{self.path}: has no cell {cell!r}; it has {', '.join(self._splits)}")
        if cell not in self._open:
            self._open[cell] = load(self.path / "data" / cell)
        return self._open[cell]

    def sequences(self, cell: str, split: Optional[str] = None) -> List[int]:
        """Returns the numbers of a cell's sequences in a split; all of them if it is None."""
        if split is not None and split not in SPLITS:
            raise ValueError(f"expected one of {', '.join(SPLITS)}, found {split!r}")
        self[cell]
        return [s for s, of in self._splits[cell].items() if split is None or of == split]

    def query(self, sql: str, values: Iterable[Any] = ()) -> List[Tuple[Any, ...]]:
        """Returns the rows of a query of index.sqlite, which is opened for reading alone."""
        file = self.path / "index.sqlite"
        if not file.is_file():
            raise DatasetError(f"{file}: expected the index of a campaign, found no such file")
        connection = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
        try:
            return connection.execute(sql, tuple(values)).fetchall()
        finally:
            connection.close()

    def samples(
        self,
        arrays: Union[str, Iterable[str]],
        split: Optional[str] = None,
        cells: Optional[Iterable[str]] = None,
    ) -> "CampaignSamples":
        """Returns one dict of NumPy arrays per tick (greatx.samples.Samples), of all cells one after the
        other, with "cell" in each. `split`: of these sequences alone; `cells`: of these alone.
        """
        return CampaignSamples(self, arrays, split, cells)

    def torch(
        self,
        arrays: Union[str, Iterable[str]],
        split: Optional[str] = None,
        cells: Optional[Iterable[str]] = None,
        transform: Any = None,
    ) -> Any:
        """Returns a torch.utils.data.Dataset of the same. Raises ImportError without torch."""
        return as_torch(self.samples(arrays, split, cells), transform, "Campaign")

    def __reduce__(self) -> Tuple[Any, Tuple[pathlib.Path]]:
        return Campaign, (self.path,)

    def __repr__(self) -> str:
        count = sum(len(sequences) for sequences in self._splits.values())
        return f"<greatx.Campaign {str(self.path)!r}: {len(self._splits)} cells, {count} sequences>"


class CampaignSamples:
    """A sequence of dicts like those of greatx.samples.Samples, over the cells of a campaign."""

    def __init__(
        self,
        opened: Campaign,
        arrays: Union[str, Iterable[str]],
        split: Optional[str],
        cells: Optional[Iterable[str]],
    ):
        names = [arrays] if isinstance(arrays, str) else list(arrays)
        self.cells: List[str] = []
        self._parts: List[Samples] = []
        for cell in opened.cells if cells is None else cells:
            sequences = opened.sequences(cell, split)
            if sequences:
                self.cells.append(cell)
                self._parts.append(Samples(opened[cell], names, sequences))
        if not self._parts:
            raise DatasetError(f"{opened.path}: no cell has a sequence in {split!r}")
        self._ends = np.cumsum([len(part) for part in self._parts])

    def __len__(self) -> int:
        return int(self._ends[-1])

    def __getitem__(self, i: int) -> Dict[str, Any]:
        if not -len(self) <= i < len(self):
            raise IndexError(f"item {i} of {len(self)}")
        at = i % len(self)
        part = int(np.searchsorted(self._ends, at, side="right"))
        item = self._parts[part][at - (int(self._ends[part - 1]) if part > 0 else 0)]
        item["cell"] = self.cells[part]
        return item

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<greatx.CampaignSamples: {len(self)} ticks of {len(self.cells)} cells>"
