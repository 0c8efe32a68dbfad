# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The arrays of a sensor over a sequence: stacks, ragged stacks, one file a record."""
from __future__ import annotations

import pathlib
from typing import Any, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np

from .errors import DatasetError
from .frames import load_npy, read_frame
from .layout import SUFFIX, ArrayInfo, OutputInfo


def _open(path: pathlib.Path, dtype: np.dtype, wanted: Tuple[int, ...]) -> np.ndarray:
    """A memory map after a look at whether its shape is the one wanted; -1 fits anything."""
    array = load_npy(path, mmap_mode="r")
    fits = array.ndim == len(wanted) and all(w in (-1, n) for w, n in zip(wanted, array.shape))
    if not fits or array.dtype != dtype:
        raise DatasetError(
            f"{path}: expected {dtype.name} {list(wanted)} (dataset.json and index.npy), "
            f"found {array.dtype.name} {list(array.shape)}"
        )
    return array


def open_stack(path: pathlib.Path, array: ArrayInfo, records: int) -> np.ndarray:
    """A read-only memory map [records, *shape of a record]."""
    return _open(path, array.dtype, (records, *array.shape))


class Ragged:
    """Records of different lengths, joined along their first axis. ragged[i] is record i, a view [rows,
    ...]."""

    def __init__(self, values: np.ndarray, offsets: np.ndarray):
        self.values = values  #: [rows of all records, ...], memory-mapped
        self.offsets = offsets  #: int64 [records + 1]: record i is values[offsets[i]:offsets[i + 1]]

    @classmethod
    def open(cls, base: pathlib.Path, array: ArrayInfo, records: int) -> "Ragged":
        """Of the files BASE.npy and BASE_offsets.npy."""
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
        """int64 [records]: rows of each record"""
        return np.diff(self.offsets)

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
    """One file a record. frames[i] reads and decodes the file of record i: an array, or a dict of arrays by
    name for the files that hold several. A slice gives a list."""

    def __init__(
        self, folder: pathlib.Path, output: OutputInfo, array: Optional[ArrayInfo], samples: np.ndarray
    ):
        self.folder = folder
        self._output = output
        self._array = array
        self._samples = samples

    def path(self, i: int) -> pathlib.Path:
        """The file of record i."""
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
