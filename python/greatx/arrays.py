# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Opens the arrays of a sensor over a sequence: stacks, ragged stacks, and outputs of one file per record."""
from __future__ import annotations

import pathlib
from typing import Any, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np

from .errors import DatasetError
from .frames import load_npy, read_frame
from .layout import SUFFIX, ArrayInfo, OutputInfo


def _open(path: pathlib.Path, dtype: np.dtype, wanted: Tuple[int, ...]) -> np.ndarray:
    """Returns a memory map. Raises DatasetError if its type or shape differs; an extent of -1 accepts any
    value.
    """
    array = load_npy(path, mmap_mode="r")
    fits = array.ndim == len(wanted) and all(w in (-1, n) for w, n in zip(wanted, array.shape))
    if not fits or array.dtype != dtype:
        raise DatasetError(
            f"{path}: expected {dtype.name} {list(wanted)} (dataset.json and index.npy), "
            f"found {array.dtype.name} {list(array.shape)}"
        )
    return array


def open_stack(path: pathlib.Path, array: ArrayInfo, records: int) -> np.ndarray:
    """Returns a read-only memory map [records, *shape of a record]."""
    return _open(path, array.dtype, (records, *array.shape))


class Ragged:
    """Holds records of different lengths, which are joined along their first axis. ragged[i] is a view [rows,
    ...] of record i.
    """

    def __init__(self, values: np.ndarray, offsets: np.ndarray):
        self.values = values  #: [rows of all records, ...], memory-mapped
        self.offsets = offsets  #: int64 [records + 1]: record i is values[offsets[i]:offsets[i + 1]]

    @classmethod
    def open(cls, base: pathlib.Path, array: ArrayInfo, records: int) -> "Ragged":
        """Opens the files BASE.npy and BASE_offsets.npy. Raises DatasetError if they do not fit `array` and
        `records`."""
        values = _open(base.with_name(base.name + ".npy"), array.dtype, array.shape)
        path = base.with_name(base.name + "_offsets.npy")
        offsets = load_npy(path)
        if offsets.dtype != np.int64:
            raise DatasetError(f"{path}: expected int64, found {offsets.dtype.name}")
        if (
            offsets.shape != (records + 1,)
            or offsets[0] != 0
            or offsets[-1] != len(values)
            or np.any(np.diff(offsets) < 0)
        ):
            raise DatasetError(
                f"{path}: expected {records + 1} offsets from 0 up to {len(values)}, found "
                f"{list(offsets.shape)}{f' from {offsets[0]} to {offsets[-1]}' if offsets.size else ''}"
            )
        return cls(values, offsets)

    @property
    def counts(self) -> np.ndarray:
        """Returns int64 [records], the number of rows of each record."""
        return np.diff(self.offsets)

    def rows(self, first: int, last: int) -> np.ndarray:
        """Returns the rows of the records first to last - 1, a view [rows, ...]."""
        return self.values[self.offsets[first] : self.offsets[last]]

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, i: int) -> np.ndarray:
        if not -len(self) <= i < len(self):
            raise IndexError(f"record {i} of {len(self)}")
        i = int(i) % len(self)
        return self.values[self.offsets[i] : self.offsets[i + 1]]

    def __iter__(self) -> Iterator[np.ndarray]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<greatx.Ragged: {len(self)} records, {self.values.dtype} {list(self.values.shape)} in all>"


class Frames:
    """Reads an output of one file per record. frames[i] reads and decodes the file of record i and returns an
    array, or a dict of arrays by name if the files hold several arrays. A slice returns a list.
    """

    def __init__(
        self, folder: pathlib.Path, output: OutputInfo, array: Optional[ArrayInfo], samples: np.ndarray
    ):
        self.folder = folder
        self._output = output
        self._array = array
        self._samples = samples

    def path(self, i: int) -> pathlib.Path:
        """Returns the path of the file of record i."""
        return self.folder / f"{int(self._samples[i]):06d}{SUFFIX[self._output.format]}"

    def __len__(self) -> int:
        return len(self._samples)

    def __getitem__(self, i: Union[int, slice]) -> Union[np.ndarray, Dict[str, np.ndarray], List[Any]]:
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        if not -len(self) <= i < len(self):
            raise IndexError(f"record {i} of {len(self)}")
        arrays = read_frame(self.path(i), self._output)
        return arrays if self._array is None else arrays[self._array.name]

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<greatx.Frames: {len(self)} files {self._output.format} in {self.folder}>"
