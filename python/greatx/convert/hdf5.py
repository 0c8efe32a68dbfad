# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a whole data set to one HDF5 file, which h5py alone reads (docs/exports.md, "HDF5").

Data flow: dataset.json and scenario.yaml become datasets of text; each sequence becomes a group, each sensor
a group in it, and each array a dataset of all records. Arrays whose length varies are joined along their
first axis, with NAME_offsets beside them. Every record is written as it is read, so memory holds one record.
"""

from __future__ import annotations

import argparse
import json
import os
from typing import Any, Dict, Iterable, List, Optional, Union

import numpy as np

from ..dataset import Dataset, Sensor
from ..errors import DatasetError
from ..files import LARGEST_JSON, interpreting, read_bytes
from ..layout import ArrayInfo
from .common import Command
from .files import Records, need, new_file, pick_sensors, selection_arguments
from .folders import Progress
from .hdf5_output import hdf5_file
from .rig import sequences_of

FORMAT, VERSION = "greatx-hdf5", 1
#: Bytes of a chunk, about; a record of a fixed shape that is larger is one chunk.
CHUNK = 1 << 18
INDEX_COLUMNS = ("tick", "time_ns", "sample")


def write_hdf5(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    sequence: Optional[int] = None,
    sensors: Optional[Iterable[str]] = None,
    level: int = 4,
) -> Dict[str, int]:
    """Writes the sequences and sensors (all if None) to the file `out`. `level` is gzip's, 0 to 9; 0 leaves
    the arrays as they are, one after another. Returns counts of the written objects. The same data set and
    versions of h5py and HDF5 give the same bytes. Raises DatasetError, FileExistsError, or ImportError
    without h5py.
    """
    if not 0 <= level <= 9:
        raise DatasetError(f"level: expected 0 to 9, found {level}")
    (h5py,) = need("hdf5", "h5py")
    sequences, names = sequences_of(dataset, sequence), pick_sensors(dataset, sensors)
    _check_names(dataset, names)
    counts = {"sequences": len(sequences), "sensors": len(names), "records": 0, "arrays": 0}
    progress = Progress(sum(len(s[name]) for s in sequences for name in names), "records")
    with new_file(out) as path, hdf5_file(h5py, path) as checked:
        file = checked.file
        file.attrs.update({"format": FORMAT, "format_version": VERSION})
        file.attrs["tick_rate_hz"] = str(dataset.tick_rate_hz)
        for text in ("dataset.json", "scenario.yaml"):
            if (dataset.path / text).is_file():
                data = read_bytes(dataset.path / text, LARGEST_JSON).decode("utf-8")
                file.create_dataset(text, data=data, track_times=False)
        for each in sequences:
            group = file.create_group(each.path.name)
            index = group.create_dataset("index", data=each.index, track_times=False)
            index.attrs["columns"] = "tick,time_ns,sensor,sample,row"
            index.attrs["sensors"] = list(each.sensors)
            for name in names:
                counts["arrays"] += _write_sensor(
                    checked, group.create_group(name), each[name], level, progress
                )
                counts["records"] += len(each[name])
    progress.end()
    return counts


def _check_names(dataset: Dataset, names: List[str]) -> None:
    """Raises DatasetError if two objects of the file would have one name."""
    paths: Dict[str, str] = {"index": "the index"}
    for name in names:
        arrays = dataset.sensors[name].arrays
        ragged = [f"{a.name}_offsets" for a in arrays.values() if a.shape[:1] == (-1,)]
        for path in [f"{name}/{x}" for x in [*arrays, *ragged, *INDEX_COLUMNS]]:
            if path in paths:
                raise DatasetError(f"{dataset.path}: {path} of {name} and of {paths[path]} have one name")
            paths[path] = name
    for name in names:
        if name in paths:
            raise DatasetError(f"{dataset.path}: the sensor {name} has the name of an array of {paths[name]}")


def _write_sensor(checked: Any, group: Any, sensor: Sensor, level: int, progress: Progress) -> int:
    group.attrs["kind"] = sensor.kind
    group.attrs["rate_hz"] = "" if sensor.info.rate_hz is None else str(sensor.info.rate_hz)
    for key, value in sensor.metadata.items():
        # Larger ones are in dataset.json; HDF5 stores up to 64 KiB of attributes in a group.
        if isinstance(value, (bool, int, float, str)):
            group.attrs[f"metadata.{key}"] = value
        elif len(text := json.dumps(value, sort_keys=True)) <= 4096:
            group.attrs[f"metadata.{key}"] = text
    for column, values in zip(INDEX_COLUMNS, sensor.index[:, [0, 1, 3]].T):
        group.create_dataset(column, data=np.ascontiguousarray(values), track_times=False)
    columns = [_Column(group, array, len(sensor), level) for array in sensor.arrays.values()]
    records = Records(sensor)
    for row in range(len(sensor)):
        with interpreting(sensor.sequence.path / sensor.name):
            arrays = records[row]
        for column in columns:
            column.append(arrays[column.array.name])
        checked.check()
        progress.step()
    for column in columns:
        column.finish()
    return len(columns)


class _Column:
    """Writes one array of all records."""

    def __init__(self, group: Any, array: ArrayInfo, records: int, level: int):
        self.array, self._group = array, group
        self._varies = array.shape[:1] == (-1,)
        self._rows, self._offsets = 0, [0]
        shape = (0, *array.shape[1:]) if self._varies else (records, *array.shape)
        row_bytes = max(int(np.prod(shape[1:], dtype=object)) * array.dtype.itemsize, 1)
        chunk_rows = max(1, min(CHUNK // row_bytes, 1 << 20))
        if not self._varies:
            chunk_rows = min(chunk_rows, max(records, 1))
        options: Dict[str, Any] = {"track_times": False}
        if self._varies:
            options["maxshape"] = (None, *shape[1:])
        packed = level > 0 and 0 not in shape[1:] and (self._varies or records > 0)
        if packed or self._varies:
            options["chunks"] = tuple(max(n, 1) for n in (chunk_rows, *shape[1:]))
        if packed:
            options.update(compression="gzip", compression_opts=level, shuffle=True)
        self._dataset = group.create_dataset(array.name, shape, array.dtype, **options)
        self._dataset.attrs.update({"unit": array.unit, "description": array.description})
        if self._varies:
            self._dataset.attrs["offsets"] = f"{array.name}_offsets"

    def append(self, values: np.ndarray) -> None:
        if not self._varies:
            self._dataset[self._rows] = values
            self._rows += 1
            return
        last = self._rows + len(values)
        if len(values):
            self._dataset.resize(last, axis=0)
            self._dataset[self._rows : last] = values
        self._rows = last
        self._offsets.append(last)

    def finish(self) -> None:
        if self._varies:
            name = f"{self.array.name}_offsets"
            offsets = self._group.create_dataset(
                name, data=np.array(self._offsets, np.int64), track_times=False
            )
            offsets.attrs["description"] = (
                f"[records + 1]: record i has the rows offsets[i] to offsets[i + 1] of {self.array.name}"
            )


def _arguments(parser: argparse.ArgumentParser) -> None:
    selection_arguments(parser)
    parser.add_argument("--level", type=int, default=4, help="gzip's level, 0 (none) to 9; default: 4")


COMMAND = Command(
    "hdf5",
    "one HDF5 file with all sequences, for h5py",
    lambda dataset, given: write_hdf5(dataset, given.OUT, given.sequence, given.sensor, given.level),
    _arguments,
    "file to make; it must not exist",
)
