# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the packed records of compressed data sets: NAME.h5 and its table NAME.npy (docs/dataset.md).

The table tells where the packed bytes of each array of each record lie, so that neither h5py nor the HDF5
library is needed. Both are made for files of known origin.
"""

from __future__ import annotations

import dataclasses
import os
import pathlib
import zlib
from typing import Any, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np

from .errors import DatasetError
from .files import LARGEST, bytes_of_shape, check_plain, inflate, reading
from .frames import load_npy
from .layout import ArrayInfo, OutputInfo

#: Numbers that tell a place: offset, bytes, rows, type, first (io/formats/packed_columns.h).
PLACE_NUMBERS = 5
#: Types of a column by their numbers in the table; 0 is the type of the array.
_TYPES = {1: np.dtype("<u4"), 2: np.dtype("<i8"), 3: np.dtype("<i2"), 4: np.dtype("<i4")}
#: Deflate never packs more than 1032 bytes into one.
_MOST_DEFLATED = 1032


@dataclasses.dataclass(frozen=True)
class _Column:
    name: str  #: path in the HDF5 file
    array: ArrayInfo
    shape: Tuple[int, ...]  #: of one record
    types: Tuple[int, ...]  #: that it may have


def _columns(output: OutputInfo) -> List[_Column]:
    columns = []
    for array in output.arrays:
        if array.shape == (-1, 4) and array.dtype == np.float32:
            for i, part in enumerate(("x", "y", "z", "intensity")):
                types = (0, 3, 4) if i < 3 and array.step > 0 else (0,)
                columns.append(_Column(f"{array.name}/{part}", array, (-1,), types))
        elif array.shape == (-1,) and array.dtype == np.int64:
            columns.append(_Column(f"{array.name}_steps", array, array.shape, (1, 2)))
        else:
            columns.append(_Column(array.name, array, array.shape, (0,)))
    return columns


def count_columns(output: OutputInfo) -> int:
    """Returns the number of columns of a record in the table."""
    return len(_columns(output))


class PackedFile:
    """Opens the packed arrays of a sensor in one sequence. Unpickled, it opens its files anew."""

    def __init__(
        self,
        base: pathlib.Path,
        output: OutputInfo,
        records: int,
        first_records: bool = False,
        stream: Optional[Tuple[pathlib.Path, int, np.ndarray]] = None,
    ):
        """Opens BASE.h5 and BASE.npy, which may hold further records if `first_records` is set. `stream` is
        the path, the descriptor, which is closed with this object, and the table of an open sequence instead.
        Raises DatasetError if the files do not fit `output` and `records`.
        """
        self.path = base.with_name(base.name + ".h5")
        self.records = records
        self._columns = _columns(output)
        self._file: Optional[int] = None
        if stream is not None:
            self.path, self._file, self._places = stream
            self._table = self.path
            self._size = os.fstat(self._file).st_size
            return
        table = base.with_name(base.name + ".npy")
        wanted = (records, len(self._columns), PLACE_NUMBERS)
        self._places = load_npy(table, mmap_mode="r")
        if first_records:
            self._places = self._places[:records]
        if self._places.dtype != np.int64 or self._places.shape != wanted:
            raise DatasetError(
                f"{table}: expected int64 {list(wanted)} (dataset.json and index.npy), "
                f"found {self._places.dtype.name} {list(self._places.shape)}"
            )
        self._table = table
        check_plain(self.path, 1 << 62)
        with reading(self.path):
            self._size = os.path.getsize(self.path)

    def __del__(self) -> None:
        if self.__dict__.get("_file") is not None:
            os.close(self._file)
            self._file = None

    def numbers_of(self, array: ArrayInfo) -> List[int]:
        """Returns the numbers of the columns of an array."""
        return [i for i, column in enumerate(self._columns) if column.array is array]

    def rows(self, column: int) -> np.ndarray:
        """Returns int64 [records], the numbers of rows of a column that varies. Raises DatasetError if one is
        negative or beyond what its packed bytes can hold.
        """
        places = np.asarray(self._places[:, column, :])
        rows, size = places[:, 2], places[:, 1]
        bad = np.flatnonzero((rows < 0) | (size < 0) | (size > self._size) | (rows > _MOST_DEFLATED * size))
        if len(bad):
            raise DatasetError(
                f"{self._table}: record {bad[0]}: {self._columns[column].name}: expected a number of rows, "
                f"found {rows[bad[0]]} in {size[bad[0]]} bytes"
            )
        return rows

    def load(self, record: int, column: int) -> np.ndarray:
        """Returns a column of a record, with the type of its array."""
        info = self._columns[column]
        offset, size, rows, kind, first = (int(n) for n in self._places[record, column])
        stored = _TYPES.get(kind, info.array.dtype)
        shape = (rows, *info.shape[1:]) if info.shape[:1] == (-1,) else info.shape
        plain = int(np.prod(shape, dtype=object)) * stored.itemsize
        if (
            kind not in info.types
            or rows < 0
            or bytes_of_shape(shape, max(stored.itemsize, info.array.dtype.itemsize)) > LARGEST
            or not 0 <= size <= self._size
            or not 0 <= offset <= self._size - size
            or (plain == 0) != (size == 0)
            or plain > _MOST_DEFLATED * size + 64
        ):
            raise DatasetError(
                f"{self._table}: record {record}: {info.name}: expected a place of packed bytes below "
                f"{self._size}, found offset {offset}, {size} bytes, {rows} rows, type {kind}"
            )
        if plain == 0:
            return np.empty(shape, info.array.dtype)
        try:
            values = self._unpack(offset, size, plain, stored).reshape(shape)
        except (ValueError, zlib.error) as error:
            raise DatasetError(f"{self.path}: record {record}: {info.name}: is damaged: {error}") from error
        if kind in (1, 2):
            # The sum wraps as it does where the steps are made.
            return np.cumsum(values, dtype=np.int64) + np.int64(first)
        if kind in (3, 4):
            return (values.astype(np.float64) * info.array.step).astype(np.float32)
        return values

    def _unpack(self, offset: int, size: int, plain: int, stored: np.dtype) -> np.ndarray:
        with reading(self.path):
            if self._file is None:
                self._file = os.open(self.path, os.O_RDONLY)
            packed = os.pread(self._file, size, offset)
        data = inflate(packed, plain)
        if len(data) != plain:
            raise ValueError(f"unpacks to {len(data)} bytes instead of {plain}")
        if stored.itemsize == 1:
            return np.frombuffer(bytearray(data), stored)
        planes = np.frombuffer(data, np.uint8).reshape(stored.itemsize, -1)
        return np.ascontiguousarray(planes.T).view(stored)[:, 0]

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_file": None, "_places": np.array(self._places)}


class _Packed:
    """What packed arrays share: records that are read and unpacked one by one."""

    def __init__(self, file: PackedFile, array: ArrayInfo):
        self.file = file
        self.dtype = array.dtype
        self._array = array
        self._numbers = file.numbers_of(array)

    def _load(self, record: int) -> np.ndarray:
        parts = [self.file.load(record, number) for number in self._numbers]
        if len(parts) == 1:
            return parts[0]
        if len({len(part) for part in parts}) != 1:
            raise DatasetError(
                f"{self.file.path}: record {record}: expected as many x, y, z and intensity of "
                f"{self._array.name}, found {[len(part) for part in parts]}"
            )
        return np.stack(parts, axis=-1)

    def __len__(self) -> int:
        return self.file.records

    def __getitem__(self, i: Union[int, np.integer, slice]) -> Any:
        if isinstance(i, slice):
            return self._of_slice(range(*i.indices(len(self))))
        if not -len(self) <= i < len(self):
            raise IndexError(f"record {i} of {len(self)}")
        return self._load(int(i) % len(self))

    def _of_slice(self, records: range) -> Any:
        raise NotImplementedError

    def __iter__(self) -> Iterator[np.ndarray]:
        return (self[i] for i in range(len(self)))


class PackedStack(_Packed):
    """Holds records of one shape. stack[i] reads and unpacks record i; a slice gives an array [records, ...],
    and so does numpy.asarray(stack).
    """

    @property
    def shape(self) -> Tuple[int, ...]:
        return (len(self), *self._array.shape)

    @property
    def ndim(self) -> int:
        return len(self.shape)

    def _of_slice(self, records: range) -> np.ndarray:
        out = np.empty((len(records), *self._array.shape), self.dtype)
        for place, record in enumerate(records):
            out[place] = self._load(record)
        return out

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return self[:] if dtype is None else self[:].astype(dtype)

    def __repr__(self) -> str:
        return f"<greatx.PackedStack: {self.dtype} {list(self.shape)} in {self.file.path}>"


class PackedRagged(_Packed):
    """Holds records of different lengths, as Ragged does. ragged[i] reads and unpacks record i."""

    @property
    def counts(self) -> np.ndarray:
        """Returns int64 [records], the number of rows of each record."""
        return self.file.rows(self._numbers[0])

    @property
    def offsets(self) -> np.ndarray:
        """Returns int64 [records + 1]: record i has the rows offsets[i] to offsets[i + 1] of all records."""
        return np.concatenate([[0], np.cumsum(self.counts, dtype=np.int64)])

    @property
    def values(self) -> np.ndarray:
        """Reads and unpacks the rows of all records, [rows, ...]."""
        return self.rows(0, len(self))

    def rows(self, first: int, last: int) -> np.ndarray:
        """Returns the rows of the records first to last - 1, [rows, ...]."""
        parts = [self._load(record) for record in range(first, last)]
        if len(parts) == 1:
            return parts[0]
        return np.concatenate([np.empty((0, *self._array.shape[1:]), self.dtype), *parts])

    def _of_slice(self, records: range) -> List[np.ndarray]:
        return [self._load(record) for record in records]

    def __repr__(self) -> str:
        return f"<greatx.PackedRagged: {len(self)} records, {self.dtype} in {self.file.path}>"


class PackedTable:
    """Holds all packed arrays of a sensor. table[i] is a dict of the arrays of record i by name."""

    def __init__(self, arrays: Dict[str, Union[PackedStack, PackedRagged]], records: int):
        self.arrays = arrays
        self._records = records

    def __len__(self) -> int:
        return self._records

    def __getitem__(self, i: Union[int, slice]) -> Any:
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        return {name: array[i] for name, array in self.arrays.items()}

    def __iter__(self) -> Iterator[Dict[str, np.ndarray]]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<greatx.PackedTable: {len(self)} records of {', '.join(self.arrays)}>"
