# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads batches of modalities from data sets and campaigns (docs/python.md). Needs NumPy alone, except for
batches(), which gives them to torch.

Data flow: Samples or CampaignSamples give the arrays of an item -> the functions of its modalities write what
they make into the item's place in the batch. Nothing is stacked or copied afterwards.
"""
from __future__ import annotations

import dataclasses
from typing import Any, Dict, Iterable, List, Mapping, Optional, Tuple, Union

import numpy as np

from .campaign import Campaign
from .campaign_samples import CampaignSamples
from .dataset import Dataset
from .errors import Error
from .modalities import Make, Source, arrays_of
from .samples import Samples

#: Of each item, beside its modalities.
PLACES = {"sequence": np.int64, "tick": np.int64, "time_s": np.float64}
#: Data sets that a loader keeps open, and arrays of all of them. Batches mix all cells, and to open a data
#: set takes longer than to read an item.
MOST_OPEN, MOST_FILES = 256, 384


@dataclasses.dataclass(frozen=True)
class Field:
    """An array of a batch."""

    name: str
    shape: Tuple[int, ...]  #: of an item
    dtype: np.dtype

    def bytes_of(self, items: int) -> int:
        return items * int(np.prod(self.shape, dtype=np.int64)) * self.dtype.itemsize


class BatchReader:
    """Reads any items of samples into arrays that the caller provides. The object is picklable; its copies
    open files of their own.

    samples     greatx.Samples or greatx.CampaignSamples of arrays_of(modalities)
    modalities  by the names that they have in a batch
    """

    def __init__(self, samples: Union[Samples, CampaignSamples], modalities: Mapping[str, Any]):
        self.samples = samples
        self.modalities = dict(modalities)
        lacking = [name for name in arrays_of(modalities) if name not in self._known()]
        if lacking:
            raise Error(f"modalities: expected arrays of {samples!r}, found {', '.join(lacking)}")
        self._makes: Dict[Optional[str], Dict[str, Make]] = {}
        self.fields: Dict[str, Field] = {f.name: f for f in self._find_fields()}

    def _known(self) -> List[str]:
        if isinstance(self.samples, CampaignSamples):
            return self.samples.names
        return [key for key, _, _ in self.samples.fields]

    @property
    def optional(self) -> bool:
        """Whether items may lack a modality."""
        return isinstance(self.samples, CampaignSamples) and self.samples.missing == "none"

    def _find_fields(self) -> Iterable[Field]:
        for name, modality in self.modalities.items():
            value = self._make(self._first_with(modality), name, None)
            yield Field(name, value.shape, value.dtype)
            if self.optional:
                yield Field(name + "_present", (), np.dtype(bool))
        for name, kind in PLACES.items():
            yield Field(name, (), np.dtype(kind))

    def _first_with(self, modality: Any) -> Mapping[str, Any]:
        if not self.optional:
            return self.samples[0]
        for shard in self.samples.shards():
            item = self.samples[shard[0]]
            if _has(item, modality):
                return item
        raise Error(f"{self.samples!r}: no item has all of {', '.join(modality.arrays)}")

    def _make(self, item: Mapping[str, Any], name: str, out: Optional[np.ndarray]) -> np.ndarray:
        cell = item.get("cell")
        if cell not in self._makes:
            dataset = self.samples.dataset if cell is None else self.samples.campaign[cell]
            source = Source.of(dataset)
            self._makes[cell] = {
                key: modality.bind(source)
                for key, modality in self.modalities.items()
                if not self.optional or _has(item, modality)
            }
        return self._makes[cell][name](item, out)

    def read(self, numbers: np.ndarray, out: Mapping[str, np.ndarray]) -> Optional[List[str]]:
        """Reads the items of these numbers into the arrays of `out`, [items, ...] of each field. Returns the
        cells of the items of a campaign, otherwise None.
        """
        cells: List[str] = [""] * len(numbers)
        # In order of the files, so that a batch of many cells opens each of them once.
        for place in np.argsort(numbers, kind="stable"):
            item = self.samples[int(numbers[place])]
            cells[place] = item.get("cell", "")
            for name in PLACES:
                out[name][place] = item[name]
            for name, modality in self.modalities.items():
                if self.optional:
                    out[name + "_present"][place] = _has(item, modality)
                    if not _has(item, modality):
                        out[name][place] = 0
                        continue
                self._make(item, name, out[name][place])
        return cells if isinstance(self.samples, CampaignSamples) else None

    def empty(self, items: int) -> Dict[str, np.ndarray]:
        """Returns arrays for read()."""
        return {f.name: np.empty((items, *f.shape), f.dtype) for f in self.fields.values()}

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_makes": {}}


def _has(item: Mapping[str, Any], modality: Any) -> bool:
    return all(item.get(f"{array}_present", True) for array in modality.arrays)


def order_of(
    items: int, seed: int, epoch: int, shuffle: bool = True, part: Tuple[int, int] = (0, 1)
) -> np.ndarray:
    """Returns the numbers of the items of an epoch in their order, which follows from `seed` and `epoch`
    alone. Of `part`, (i, n), every n-th of them from the i-th on; up to n - 1 items are left out, so that all
    parts have equally many.
    """
    if not 0 <= part[0] < part[1]:
        raise Error(f"part: expected (i, n) with 0 <= i < n, found {part}")
    order = np.random.default_rng([seed, epoch]).permutation(items) if shuffle else np.arange(items)
    return order[: items - items % part[1]][part[0] :: part[1]]


def samples_of(
    data: Any,
    modalities: Mapping[str, Any],
    split: Optional[str] = None,
    cells: Optional[Iterable[str]] = None,
    sequences: Optional[Iterable[int]] = None,
    missing: str = "error",
) -> Union[Samples, CampaignSamples]:
    """Returns the samples of a data set or of a campaign that have what modalities need."""
    arrays = arrays_of(modalities)
    if isinstance(data, Campaign):
        if sequences is not None:
            raise Error("sequences: expected a split or cells of a campaign, found sequences")
        opened = Campaign(data.path, max(data.most_open, MOST_OPEN), max(data.files.most, MOST_FILES))
        return opened.samples(arrays, split, cells, missing=missing)
    if isinstance(data, Dataset):
        for name, value in (("split", split), ("cells", cells)):
            if value is not None:
                raise Error(
                    f"{name}: expected `sequences` of a data set, which has no {name}, found {value!r}"
                )
        return data.samples(arrays, sequences)
    raise Error(f"data: expected a greatx.Dataset or a greatx.Campaign, found {data!r}")


def batches(
    data: Any,
    modalities: Mapping[str, Any],
    batch: int = 64,
    *,
    split: Optional[str] = None,
    cells: Optional[Iterable[str]] = None,
    sequences: Optional[Iterable[int]] = None,
    items: Optional[Iterable[int]] = None,
    missing: str = "error",
    shuffle: bool = True,
    seed: int = 0,
    part: Tuple[int, int] = (0, 1),
    drop_last: bool = False,
    workers: int = 0,
    prefetch: int = 2,
    context: Optional[str] = None,
) -> Any:
    """Returns greatx.torch_batches.Batches: batches of what networks take, as torch tensors.

        loader = greatx.batches(ds, {"rgb": Picture("uav/front", 224), "csi": CsiMap("csi")}, 64, workers=2)
        for batch in loader: batch["rgb"], batch["csi"], batch["tick"]

    data        a data set or a campaign
    modalities  what an item has, by name: objects of greatx.modalities
    batch       items of a batch; the last one of an epoch may have fewer, unless drop_last leaves it out
    split, cells, missing   of a campaign, as for Campaign.samples. With missing="none", a batch has
                NAME_present, bool [items], for each modality, and zeros where it is missing
    sequences   of a data set, as for Dataset.samples
    items       numbers of those of these items that are used; None: all. To split by place, for instance
    shuffle, seed   whether each epoch has a random order of its own, which follows from `seed` and the number
                of the epoch alone. Batches do not depend on the number of workers
    part        (i, n): the i-th of n disjoint parts of each epoch, for processes that train together
    workers     processes that read; 0: this one. They live as long as the object, and hold `prefetch` batches
                each ahead
    context     how they start: "fork", "spawn" or "forkserver"; by default as torch does

    Workers write into shared memory, which becomes the tensors of a batch without a copy, and which they use
    again when all tensors of a batch are gone. Keep a batch for as long as you like.
    """
    try:
        from .torch_batches import Batches
    except ImportError as error:
        raise ImportError(
            f"greatx.batches needs PyTorch (`pip install torch`): {error}. "
            "greatx.batch_reader.BatchReader reads the same into NumPy arrays"
        ) from error
    for name, value, least in (("batch", batch, 1), ("workers", workers, 0), ("prefetch", prefetch, 1)):
        if value < least:
            raise Error(f"{name}: expected {least} or more, found {value}")
    if seed < 0:
        raise Error(f"seed: expected 0 or more, found {seed}")
    reader = BatchReader(samples_of(data, modalities, split, cells, sequences, missing), modalities)
    numbers = np.arange(len(reader.samples)) if items is None else np.asarray(list(items), np.int64)
    if len(numbers) and not 0 <= numbers.min() <= numbers.max() < len(reader.samples):
        raise Error(
            f"items: expected numbers below {len(reader.samples)}, found {numbers.min()} to {numbers.max()}"
        )
    return Batches(reader, numbers, batch, shuffle, seed, part, drop_last, workers, prefetch, context)
