# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a campaign: many data sets with one index (docs/campaigns.md).

Data flow: splits.csv names the cells and their sequences. A cell's data set is opened when it is used, and at
most `most_open` of them stay open. All of them share one OpenArrays, which bounds their files.
"""

from __future__ import annotations

import collections
import csv
import os
import pathlib
import sqlite3
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Tuple, Union

from .dataset import Dataset
from .errors import DatasetError
from .opened import OpenArrays
from .samples import as_torch

if TYPE_CHECKING:
    from .campaign_samples import CampaignSamples, ShuffledSamples

SPLITS = ("train", "validation", "test")
SPLITS_FILE, CELLS = "splits.csv", "cells.json"
#: Data sets that stay open.
MOST_OPEN_DATASETS = 16


def campaign(folder: Union[str, "os.PathLike[str]"]) -> "Campaign":
    """Opens a merged campaign. Raises DatasetError, which names the file, if the folder holds none."""
    return Campaign(folder)


class Campaign:
    """Provides the data sets of a campaign by the names of their cells, and its index. Pickling stores only
    the folder.

    most_open   data sets that stay open; those that were used longest ago are closed
    most_files  arrays that stay open, of all data sets together (greatx.opened.OpenArrays)
    incomplete  whether to open data sets that are not finished
    """

    def __init__(
        self,
        folder: Union[str, "os.PathLike[str]"],
        most_open: int = MOST_OPEN_DATASETS,
        most_files: Optional[int] = None,
        incomplete: bool = False,
    ):
        if most_open < 1:
            raise ValueError(f"expected 1 or more open data sets, found {most_open}")
        self.path = pathlib.Path(os.path.abspath(folder))
        self.most_open = most_open
        self.files = OpenArrays() if most_files is None else OpenArrays(most_files)
        self._incomplete = incomplete
        self._splits = self._read_splits(self.path / SPLITS_FILE)
        self._open: "collections.OrderedDict[str, Dataset]" = collections.OrderedDict()

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
        self._check(cell)
        if cell not in self._open:
            self._open[cell] = Dataset(self.path / "data" / cell, self._incomplete, self.files)
            while len(self._open) > self.most_open:
                self._open.popitem(last=False)
        self._open.move_to_end(cell)
        return self._open[cell]

    def _check(self, cell: str) -> None:
        if cell not in self._splits:
            raise KeyError(f"{self.path}: has no cell {cell!r}; it has {', '.join(self._splits)}")

    @property
    def opened(self) -> List[str]:
        """The cells whose data sets are open now."""
        return list(self._open)

    def sequences(self, cell: str, split: Optional[str] = None) -> List[int]:
        """Returns the numbers of a cell's sequences in a split; all of them if it is None."""
        if split is not None and split not in SPLITS:
            raise ValueError(f"expected one of {', '.join(SPLITS)}, found {split!r}")
        self._check(cell)
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
        pad: bool = False,
        missing: str = "error",
    ) -> "CampaignSamples":
        """Returns one dict of NumPy arrays per tick (greatx.samples.Samples), of all cells one after the
        other, with "cell" in each. `split`: of these sequences alone; `cells`: of these alone; `pad` as for
        Samples, over all cells. Data sets are opened when the first item or the number of items is asked for.

        `missing` decides about cells that lack one of the arrays: "error" raises a DatasetError that names
        them, "skip" leaves them out (`left_out` has their names), and "none" gives zeros. With "none", every
        item has "SENSOR/ARRAY_present" (bool) for each array.
        """
        from .campaign_samples import CampaignSamples

        return CampaignSamples(self, arrays, split, cells, pad, missing)

    def shuffled(
        self,
        arrays: Union[str, Iterable[str]],
        split: Optional[str] = None,
        cells: Optional[Iterable[str]] = None,
        pad: bool = False,
        missing: str = "error",
        seed: int = 0,
        buffer: int = 1024,
        part: Tuple[int, int] = (0, 1),
    ) -> "ShuffledSamples":
        """Returns an iterable over the same items in an order that follows from `seed` and the epoch alone:
        sequences in random order, and items mixed by a buffer of `buffer` places. Each item comes once an
        epoch. `part` is (i, n): the i-th of n disjoint parts, for processes that train together.
        """
        from .campaign_samples import ShuffledSamples

        return ShuffledSamples(self.samples(arrays, split, cells, pad, missing), seed, buffer, part)

    def torch(
        self,
        arrays: Union[str, Iterable[str]],
        split: Optional[str] = None,
        cells: Optional[Iterable[str]] = None,
        transform: Any = None,
        pad: bool = False,
        missing: str = "error",
    ) -> Any:
        """Returns a torch.utils.data.Dataset of samples(). Raises ImportError without torch."""
        return as_torch(self.samples(arrays, split, cells, pad, missing), transform, "Campaign")

    def torch_shuffled(self, arrays: Union[str, Iterable[str]], transform: Any = None, **options: Any) -> Any:
        """Returns a torch.utils.data.IterableDataset of shuffled(arrays, **options). The workers of a
        DataLoader share its sequences, so that each item comes once an epoch over all workers. Call
        set_epoch(n) before each epoch, also with persistent workers. Raises ImportError without torch.
        """
        return as_torch(self.shuffled(arrays, **options), transform, "Campaign")

    def __reduce__(self) -> Tuple[Any, Tuple[Any, ...]]:
        return Campaign, (self.path, self.most_open, self.files.most, self._incomplete)

    def __repr__(self) -> str:
        count = sum(len(sequences) for sequences in self._splits.values())
        return f"<greatx.Campaign {str(self.path)!r}: {len(self._splits)} cells, {count} sequences>"
