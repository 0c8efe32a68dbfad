# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads dataset.json, which describes the sensors, their arrays, and the outputs that hold them
(docs/dataset.md).
"""
from __future__ import annotations

import dataclasses
import pathlib
from fractions import Fraction
from typing import Any, Dict, Mapping, Optional, Tuple

import numpy as np

from .errors import DatasetError
from .files import (
    LARGEST,
    MOST_ARRAYS,
    MOST_AXES,
    MOST_SENSORS,
    Field,
    bytes_of_shape,
    inside,
    is_inside,
    read_json,
)

FORMAT = "greatx-dataset"
FORMAT_VERSION = 1
#: The file formats of outputs. If several outputs hold one array, the format that comes first here is read.
FORMATS = (
    "npy_stack",
    "npy_ragged",
    "npy_frame",
    "hdf5_records",
    "exr",
    "png",
    "ply",
    "pcd",
    "kitti",
    "png_depth24",
    "hdf5_events",
    "text_events",
)
#: The types of arrays by NumPy's names.
DTYPES = ("|u1", "<u2", "<u4", "<u8", "|i1", "<i4", "<i8", "<f4", "<f8", "<c8")
#: The formats of point clouds, whose files may hold several arrays.
CLOUDS = ("ply", "pcd")
#: The format of packed arrays, several of which are in one HDF5 file.
PACKED = "hdf5_records"
#: Suffixes of files for other tools, which hold a whole sequence and are made from its arrays.
EXPORT_SUFFIX = {"hdf5_events": ".h5", "text_events": ".txt"}
SUFFIX = {
    "npy_frame": ".npy",
    "exr": ".exr",
    "png": ".png",
    "ply": ".ply",
    "pcd": ".pcd",
    "kitti": ".bin",
    "png_depth24": ".png",
}


@dataclasses.dataclass(frozen=True)
class ArrayInfo:
    """Describes one array of a sensor's record."""

    name: str
    dtype: np.dtype  #: type of one element
    shape: Tuple[int, ...]  #: shape of one record; an extent of -1 varies from record to record
    unit: str
    description: str  #: axes and meaning
    step: float = 0.0  #: if not 0: values, or the coordinates of points, are multiples of it


@dataclasses.dataclass(frozen=True)
class OutputInfo:
    """Describes an output, which holds one or more arrays of a sensor on disk."""

    name: str
    format: str
    arrays: Tuple[ArrayInfo, ...]


class MissingField(DatasetError, KeyError):
    """Reports a field that dataset.json lacks."""

    __str__ = DatasetError.__str__


class Metadata(Dict[str, Any]):
    """Holds the metadata of a sensor. A missing field raises a DatasetError, which is also a KeyError and
    names the place.
    """

    def __init__(self, fields: Mapping[str, Any] = {}, where: str = ""):
        super().__init__(fields)
        self.where = where

    def __missing__(self, key: str) -> Any:
        raise MissingField(f"{self.where}.{key}: expected a value, found none")

    def __reduce__(self):
        return Metadata, (dict(self), self.where)


@dataclasses.dataclass(frozen=True)
class SensorInfo:
    """Describes a sensor, as in dataset.json."""

    name: str
    kind: str  #: "csi", "camera", "lidar", "pose", ...
    rate_hz: Optional[Fraction]  #: None: the sensor fires whenever another one does
    arrays: Dict[str, ArrayInfo]
    outputs: Dict[str, OutputInfo]
    metadata: Dict[str, Any]

    def locate(self, name: str) -> Optional[Tuple[OutputInfo, Optional[ArrayInfo]]]:
        """Returns the output from which to read `name`, and the array in it. The array is None if `name` is
        an output of several arrays, all of which are read. `name` is an output or an array; returns None if
        it is neither. If several outputs hold the array, an exact one is chosen.
        """
        if name in self.outputs:
            output = self.outputs[name]
            return output, output.arrays[0] if len(output.arrays) == 1 else None
        if name not in self.arrays:
            return None
        holders = [o for o in self.outputs.values() if self.arrays[name] in o.arrays]
        return min(holders, key=lambda o: FORMATS.index(o.format)), self.arrays[name]


def read_info(folder: pathlib.Path) -> Field:
    """Reads dataset.json. Raises DatasetError if the folder is no data set of this version."""
    path = inside(folder, "dataset.json")
    if not path.is_file():
        raise DatasetError(f"{folder}: is no data set of greatx: it has no dataset.json")
    info = read_json(path)
    if "format" not in info or info.value["format"] != FORMAT:
        found = info.value.get("format") if isinstance(info.value, dict) else type(info.value).__name__
        raise DatasetError(f"{path}: expected format '{FORMAT}', found {found!r}")
    version = info.value.get("format_version")
    if version != FORMAT_VERSION:
        raise DatasetError(
            f"{path}: format_version is {version!r}; this greatx reads {FORMAT_VERSION}. "
            "Generate the data set anew, or use the greatx that it was made with"
        )
    return info


def parse_sensors(info: Field) -> Dict[str, SensorInfo]:
    """Returns all sensors by name, in the order of their numbers in the index."""
    sensors: Dict[str, SensorInfo] = {}
    for entry in info["sensors"].items(MOST_SENSORS):
        sensor = _sensor(entry)
        if sensor.name in sensors:
            raise entry["name"].fail("a name of its own for each sensor")
        sensors[sensor.name] = sensor
    return sensors


def _name(field: Field) -> str:
    if not is_inside(field.text()):
        raise field.fail("a name that can be a folder below the data set")
    return field.text()


def _array(entry: Field) -> ArrayInfo:
    name, dtype = entry["name"].text(), entry["dtype"].text()
    if dtype not in DTYPES:
        raise entry["dtype"].fail("one of " + ", ".join(DTYPES))
    extents = entry["shape"].items(MOST_AXES)
    shape = tuple(extent.integer(-1 if i == 0 else 0, 1 << 40) for i, extent in enumerate(extents))
    if bytes_of_shape(shape, np.dtype(dtype).itemsize) > LARGEST:
        raise entry["shape"].fail(f"a record of at most {LARGEST} bytes")
    step = entry["step"].number(1e-9, 1e9) if "step" in entry else 0.0
    return ArrayInfo(name, np.dtype(dtype), shape, entry["unit"].text(), entry["description"].text(), step)


def _sensor(entry: Field) -> SensorInfo:
    name = _name(entry["name"])
    arrays = {a.name: a for a in map(_array, entry["arrays"].items(MOST_ARRAYS))}
    outputs: Dict[str, OutputInfo] = {}
    for o in entry["outputs"].items(MOST_ARRAYS):
        kind = o["format"].text()
        if kind not in FORMATS:
            raise DatasetError(
                f"{o.file}: {name}/{o['name'].text()} has format {kind!r}; this greatx knows "
                + ", ".join(FORMATS)
            )
        holds = o["arrays"].items(MOST_ARRAYS)
        for array in holds:
            if array.text() not in arrays:
                raise array.fail("one of the sensor's arrays")
        several = kind in CLOUDS or kind in EXPORT_SUFFIX or kind == PACKED
        if not holds or (len(holds) > 1 and not several):
            raise o["arrays"].fail("an array or more" if several else "one array")
        info = OutputInfo(_name(o["name"]), kind, tuple(arrays[array.text()] for array in holds))
        varies = info.arrays[0].shape[:1] == (-1,)
        if kind in ("npy_stack", "npy_ragged") and varies != (kind == "npy_ragged"):
            raise o["format"].fail("npy_ragged for an array whose first axis varies, npy_stack for others")
        outputs[info.name] = info
    kept = {array.name for output in outputs.values() for array in output.arrays}
    for array in arrays:
        if array not in kept:
            raise entry["outputs"].fail(f"one that keeps the array {array!r}")
    rate = entry["rate_hz"].rate() if entry["rate_hz"].value != "" else None
    return SensorInfo(
        name,
        entry["kind"].text(),
        rate,
        arrays,
        outputs,
        Metadata(entry["metadata"].object(), f"{entry.file}: {name}: metadata"),
    )
