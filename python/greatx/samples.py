# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Combines the measurements of several sensors at one tick to one dict, for machine learning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Optional, Tuple, Union

import numpy as np

from .arrays import Frames, Ragged
from .errors import DatasetError
from .packed import PackedRagged

if TYPE_CHECKING:
    from .dataset import Dataset


def as_torch(samples: Any, transform: Any, name: str) -> Any:
    """Returns a torch.utils.data.Dataset of samples. `name` is the class whose method `torch` asks for it.
    Raises ImportError without torch.
    """
    try:
        if hasattr(samples, "__getitem__"):
            from .torch_dataset import TorchDataset as Made
        else:
            from .torch_shuffled import TorchShuffled as Made
    except ImportError as error:
        raise ImportError(
            f"{name}.torch needs PyTorch (`pip install torch`): {error}. "
            f"{name}.samples gives the same as NumPy arrays"
        ) from error
    return Made(samples, transform)


def fields_of(dataset: "Dataset", name: str) -> List[Tuple[str, str, str]]:
    """Returns (key of an item, sensor, array) of each array that `name` stands for. Raises KeyError if the
    data set has none.
    """
    sensors = dataset.sensors
    if name in sensors:
        return [
            (f"{name}/{a.name}", name, a.name) for a in sensors[name].arrays.values() if -1 not in a.shape
        ]
    for sensor in sorted((s for s in sensors if name.startswith(s + "/")), key=len, reverse=True):
        array = name[len(sensor) + 1 :]
        located = sensors[sensor].locate(array)
        if located is not None and located[1] is not None:
            return [(name, sensor, array)]
    known = [f"{s.name}/{a}" for s in sensors.values() for a in s.arrays]
    raise KeyError(f"{dataset.path}: has neither a sensor nor an array {name!r}; it has {', '.join(known)}")


class Samples:
    """A sequence of dicts of NumPy arrays, one for every tick at which all requested sensors have a record.

    arrays     one or several names "SENSOR/ARRAY", e.g. "csi/cfr", "uav/cam/rgb", "csi/paths/delay",
               "poses/position"; "SENSOR" stands for all arrays of fixed shape of this sensor
    sequences  indices into Dataset.sequences; None: all sequences, one after the other
    pad        if true, arrays whose length varies from tick to tick (paths, point clouds) are padded with
               zeros to the longest of all ticks, and "SENSOR/ARRAY_count" gives the number of valid rows, so
               that items can be batched. Arrays of one file per record cannot be padded, because their
               lengths are not known beforehand

    An item has the arrays, "sequence" and "tick" (int) and "time_s" (float). Arrays of memory-mapped files
    are read-only views. The object is picklable.
    """

    def __init__(
        self,
        dataset: "Dataset",
        arrays: Union[str, Iterable[str]],
        sequences: Optional[Iterable[int]] = None,
        pad: bool = False,
        items: Optional[np.ndarray] = None,
        longest: Optional[Dict[str, Optional[int]]] = None,
    ):
        """`items` and `longest` are those of an equal object, so that they are not computed again."""
        self.dataset = dataset
        self.pad = pad
        names = [arrays] if isinstance(arrays, str) else list(arrays)
        #: (key of the item, sensor, array)
        self.fields: List[Tuple[str, str, str]] = [f for name in names for f in fields_of(dataset, name)]
        if not self.fields:
            raise ValueError("no arrays are asked for")
        self.sequences = list(range(len(dataset.sequences)) if sequences is None else sequences)
        if items is None:
            rows = [self._rows(i) for i in self.sequences]
            items = np.concatenate(rows or [np.empty((0, 2), np.int64)])
        #: int64 [items, 2]: index into Dataset.sequences, tick
        self.items = items
        if len(self.items) == 0:
            raise DatasetError(
                f"{dataset.path}: there is no tick at which "
                f"{', '.join(sorted({s for _, s, _ in self.fields}))} all have a record"
            )
        #: rows to which each array is padded; None: of fixed shape
        self.longest: Dict[str, Optional[int]] = {}
        if pad:
            self.longest = longest or {key: self._longest_of(key, s, a) for key, s, a in self.fields}

    def _rows(self, number: int) -> np.ndarray:
        """Returns int64 [items, 2]: sequence, tick."""
        sequence = self.dataset.sequences[number]
        ticks = sequence.ticks
        for sensor in {s for _, s, _ in self.fields}:
            ticks = np.intersect1d(ticks, sequence[sensor].ticks, assume_unique=True)
        return np.stack([np.full(len(ticks), number, np.int64), ticks], axis=1)

    def _longest_of(self, key: str, sensor: str, array: str) -> Optional[int]:
        """Returns the largest number of rows of any record in the selected sequences, or None for an array of
        fixed shape.
        """
        longest = None
        for number in self.sequences:
            opened = self.dataset.sequences[number][sensor][array]
            if isinstance(opened, (Ragged, PackedRagged)):
                longest = max(longest or 0, int(opened.counts.max(initial=0)))
            elif isinstance(opened, Frames) and -1 in self.dataset.sensors[sensor].locate(array)[1].shape:
                raise ValueError(
                    f"{key} is kept as one file a record: its longest record is not known without reading "
                    "all of them, so it cannot be padded; pad it in a transform"
                )
        return longest

    def __len__(self) -> int:
        return len(self.items)

    def __getitem__(self, i: int) -> Dict[str, Any]:
        if not -len(self) <= i < len(self):
            raise IndexError(f"item {i} of {len(self)}")
        number, tick = (int(v) for v in self.items[i])
        at = self.dataset.sequences[number].at(tick)
        item: Dict[str, Any] = {
            "sequence": self.dataset.sequences[number].number,
            "tick": tick,
            "time_s": at.time_s,
        }
        for key, sensor, array in self.fields:
            value = at[sensor][array]
            longest = self.longest.get(key)
            if longest is not None:
                item[key + "_count"] = len(value)
                padded = np.zeros((longest, *value.shape[1:]), value.dtype)
                padded[: len(value)] = value
                value = padded
            item[key] = value
        return item

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<greatx.Samples: {len(self)} ticks of {', '.join(key for key, _, _ in self.fields)}>"
