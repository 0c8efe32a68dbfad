# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Gives the items of all cells of a campaign, in order or shuffled.

Data flow: the campaign's cells and sequences -> _Plan (which arrays each cell has, its ticks, the longest
rows), made once and pickled with the object -> Samples of a cell, made when an item of the cell is asked for
and dropped with its data set -> items. Memory grows with the number of ticks, 16 bytes each, alone.
"""

from __future__ import annotations

import collections
import dataclasses
from typing import Any, Dict, Iterable, Iterator, List, Optional, Tuple, Union

import numpy as np

from .campaign import Campaign
from .dataset import Dataset
from .errors import DatasetError
from .layout import ArrayInfo
from .samples import Samples, fields_of

MISSING = ("error", "skip", "none")


@dataclasses.dataclass
class _Part:
    """The items of a cell."""

    cell: str
    sequences: List[int]
    names: List[str]  #: those of the wanted arrays that the cell has
    items: np.ndarray  #: int64 [items, 2]: sequence, tick


@dataclasses.dataclass
class _Plan:
    parts: List[_Part]
    left_out: List[str]  #: cells without one of the arrays
    arrays: Dict[str, ArrayInfo]  #: by key: those of the first cell that has it
    longest: Dict[str, Optional[int]]  #: by key, over all cells, if items are padded


class CampaignSamples:
    """A sequence of dicts like those of greatx.samples.Samples, over the cells of a campaign (see
    Campaign.samples). The object is picklable; its copies open files of their own.
    """

    def __init__(
        self,
        opened: Campaign,
        arrays: Union[str, Iterable[str]],
        split: Optional[str] = None,
        cells: Optional[Iterable[str]] = None,
        pad: bool = False,
        missing: str = "error",
    ):
        if missing not in MISSING:
            raise ValueError(f"missing: expected one of {', '.join(MISSING)}, found {missing!r}")
        self.campaign, self.pad, self.missing = opened, pad, missing
        self.names = [arrays] if isinstance(arrays, str) else list(arrays)
        if not self.names:
            raise ValueError("no arrays are asked for")
        wanted = [
            (cell, opened.sequences(cell, split)) for cell in (opened.cells if cells is None else cells)
        ]
        self._wanted = [(cell, sequences) for cell, sequences in wanted if sequences]
        if not self._wanted:
            raise DatasetError(f"{opened.path}: no cell has a sequence in {split!r}")
        self._made: Optional[_Plan] = None
        self._samples: "collections.OrderedDict[str, Samples]" = collections.OrderedDict()

    @property
    def _plan(self) -> _Plan:
        if self._made is None:
            self._made = self._make_plan()
            self._ends = np.cumsum([len(part.items) for part in self._made.parts])
        return self._made

    def _make_plan(self) -> _Plan:
        arrays: Dict[str, ArrayInfo] = {}
        keys: Dict[str, Dict[str, str]] = {}  # of each cell: key -> name that stands for it
        for cell, _ in self._wanted:
            dataset = self.campaign[cell]
            keys[cell] = {}
            for name in self.names:
                for key, sensor, array in self._fields(dataset, name):
                    keys[cell][key] = name
                    arrays.setdefault(key, dataset.sensors[sensor].locate(array)[1])
        nowhere = [n for n in self.names if all(n not in of.values() for of in keys.values())]
        if nowhere:
            fields_of(self.campaign[self._wanted[0][0]], nowhere[0])  # says what there is
            raise KeyError(f"{self.campaign.path}: {nowhere[0]!r} has no array of fixed shape")
        lacking = {cell: [k for k in arrays if k not in of] for cell, of in keys.items()}
        left_out = [cell for cell, lacks in lacking.items() if lacks]
        if left_out and self.missing == "error":
            raise DatasetError(
                f"{self.campaign.path}: {len(left_out)} of {len(keys)} cells lack an array, the first is "
                f"{left_out[0]!r} without {', '.join(lacking[left_out[0]])}; missing='skip' leaves such "
                "cells out, missing='none' gives zeros and SENSOR/ARRAY_present"
            )
        parts: List[_Part] = []
        longest: Dict[str, Optional[int]] = {}
        for cell, sequences in self._wanted:
            if not keys[cell] or (self.missing == "skip" and cell in left_out):
                continue
            samples = Samples(self.campaign[cell], list(keys[cell]), sequences, self.pad)
            parts.append(_Part(cell, sequences, list(keys[cell]), samples.items))
            for key, rows in samples.longest.items():
                longest[key] = None if rows is None else max(rows, longest.get(key) or 0)
        if not parts:
            raise DatasetError(f"{self.campaign.path}: no cell has all of {', '.join(self.names)}")
        return _Plan(parts, left_out if self.missing == "skip" else [], arrays, longest)

    def _fields(self, dataset: Dataset, name: str) -> List[Tuple[str, str, str]]:
        try:
            return fields_of(dataset, name)
        except KeyError:
            return []

    @property
    def cells(self) -> List[str]:
        """The cells that have items, in order."""
        return [part.cell for part in self._plan.parts]

    @property
    def left_out(self) -> List[str]:
        """The cells that missing="skip" leaves out."""
        return self._plan.left_out

    def shards(self) -> List[range]:
        """Returns the numbers of the items of each sequence."""
        out: List[range] = []
        for part, end in zip(self._plan.parts, self._ends):
            first = int(end) - len(part.items)
            starts = np.flatnonzero(np.diff(part.items[:, 0], prepend=-1))
            for begin, stop in zip(starts, [*starts[1:], len(part.items)]):
                out.append(range(first + int(begin), first + int(stop)))
        return out

    def _samples_of(self, part: _Part) -> Samples:
        dataset = self.campaign[part.cell]
        samples = self._samples.get(part.cell)
        if samples is None or samples.dataset is not dataset:
            longest = {key: rows for key, rows in self._plan.longest.items() if key in part.names}
            samples = Samples(dataset, part.names, part.sequences, self.pad, part.items, longest)
            self._samples[part.cell] = samples
        self._samples.move_to_end(part.cell)
        while len(self._samples) > self.campaign.most_open:
            self._samples.popitem(last=False)
        return samples

    def __len__(self) -> int:
        self._plan
        return int(self._ends[-1])

    def __getitem__(self, i: int) -> Dict[str, Any]:
        if not -len(self) <= i < len(self):
            raise IndexError(f"item {i} of {len(self)}")
        at = i % len(self)
        number = int(np.searchsorted(self._ends, at, side="right"))
        part = self._plan.parts[number]
        item = self._samples_of(part)[at - int(self._ends[number]) + len(part.items)]
        item["cell"] = part.cell
        if self.missing == "none":
            self._fill(item)
        return item

    def _fill(self, item: Dict[str, Any]) -> None:
        """Adds zeros for the arrays that an item lacks, and says which arrays it has."""
        for key, array in self._plan.arrays.items():
            item[key + "_present"] = key in item
            if key in item:
                continue
            shape = list(array.shape)
            if shape[:1] == [-1]:
                shape[0] = self._plan.longest.get(key) or 0
            item[key] = np.zeros(shape, array.dtype)
            if self._plan.longest.get(key) is not None:
                item[key + "_count"] = 0

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        return (self[i] for i in range(len(self)))

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_samples": collections.OrderedDict()}

    def __repr__(self) -> str:
        return f"<greatx.CampaignSamples of {', '.join(self.names)}: {len(self._wanted)} cells>"


class ShuffledSamples:
    """Iterates over the items of CampaignSamples in random order (see Campaign.shuffled).

    The sequences are permuted by a generator of (seed, epoch). Reader g of G readers takes every G-th of them
    from the g-th on, and draws the next item from a buffer that the items of its sequences go through in
    order. The buffer holds the numbers of items and not their arrays.
    """

    def __init__(self, samples: CampaignSamples, seed: int, buffer: int, part: Tuple[int, int]):
        if buffer < 1:
            raise ValueError(f"buffer: expected 1 or more, found {buffer}")
        if seed < 0:
            raise ValueError(f"seed: expected 0 or more, found {seed}")
        if not 0 <= part[0] < part[1]:
            raise ValueError(f"part: expected (i, n) with 0 <= i < n, found {part}")
        self.samples, self.seed, self.buffer, self.part = samples, seed, buffer, part
        self.epoch = 0

    def set_epoch(self, epoch: int) -> None:
        """Chooses the order of the next iterations."""
        self.epoch = epoch

    def order(self, reader: int = 0, readers: int = 1) -> Iterator[int]:
        """Returns the numbers of the items for one of the readers that share this part."""
        place, places = self.part[0] * readers + reader, self.part[1] * readers
        shards = self.samples.shards()
        mine = np.random.default_rng([self.seed, self.epoch]).permutation(len(shards))[place::places]
        draw = np.random.default_rng([self.seed, self.epoch, place, places])
        held: List[int] = []
        for shard in mine:
            for item in shards[shard]:
                if len(held) < self.buffer:
                    held.append(item)
                    continue
                at = int(draw.integers(len(held)))
                yield held[at]
                held[at] = item
        while held:
            at = int(draw.integers(len(held)))
            held[at], held[-1] = held[-1], held[at]
            yield held.pop()

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        return (self.samples[i] for i in self.order())

    def __len__(self) -> int:
        """Returns the number of items of this part in the current epoch, of all its readers together."""
        if self.part == (0, 1):
            return len(self.samples)
        shards = self.samples.shards()
        order = np.random.default_rng([self.seed, self.epoch]).permutation(len(shards))
        return sum(len(shards[s]) for s in order[self.part[0] :: self.part[1]])

    def __repr__(self) -> str:
        return f"<greatx.ShuffledSamples, seed {self.seed}, epoch {self.epoch}: {self.samples!r}>"
