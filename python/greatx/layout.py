# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What dataset.json says: sensors, their arrays and where these lie on disk (docs/dataset.md)."""
from __future__ import annotations

import dataclasses
import json
import pathlib
from fractions import Fraction
from typing import Any, Dict, Optional, Tuple

import numpy as np

from .errors import DatasetError

FORMAT = "greatx-dataset"
FORMAT_VERSION = 1
#: The file formats of an output, from the one to read first to the one to read last where several hold one array.
FORMATS = ("npy_stack", "npy_ragged", "npy_frame", "exr", "png", "ply", "pcd", "kitti", "png_depth24", "hdf5_events",
           "text_events")
#: Of files of a whole sequence for other tools, made from its arrays.
EXPORT_SUFFIX = {"hdf5_events": ".h5", "text_events": ".txt"}
SUFFIX = {"npy_frame": ".npy", "exr": ".exr", "png": ".png", "ply": ".ply", "pcd": ".pcd", "kitti": ".bin",
          "png_depth24": ".png"}


@dataclasses.dataclass(frozen=True)
class ArrayInfo:
    """One array of a sensor's record."""

    name: str
    dtype: np.dtype  #: of one element
    shape: Tuple[int, ...]  #: of one record; -1: differs from record to record
    unit: str
    description: str  #: axes and meaning


@dataclasses.dataclass(frozen=True)
class OutputInfo:
    """How one or more arrays of a sensor are kept on disk."""

    name: str
    format: str
    arrays: Tuple[ArrayInfo, ...]


@dataclasses.dataclass(frozen=True)
class SensorInfo:
    """A sensor as dataset.json describes it."""

    name: str
    kind: str  #: "csi", "camera", "lidar", "pose", ...
    rate_hz: Optional[Fraction]  #: None: fires whenever another one does
    arrays: Dict[str, ArrayInfo]
    outputs: Dict[str, OutputInfo]
    metadata: Dict[str, Any]

    def locate(self, name: str) -> Optional[Tuple[OutputInfo, Optional[ArrayInfo]]]:
        """The output to read `name` from and the array in it (None: all of a file of several). `name` is an output or
        an array; None if it is neither. Of several outputs that hold an array, the exact one is taken."""
        if name in self.outputs:
            output = self.outputs[name]
            return output, output.arrays[0] if len(output.arrays) == 1 else None
        if name not in self.arrays:
            return None
        holders = [o for o in self.outputs.values() if self.arrays[name] in o.arrays]
        return min(holders, key=lambda o: FORMATS.index(o.format)), self.arrays[name]


def read_json(path: pathlib.Path) -> Any:
    """The contents of a JSON file; DatasetError if there is none."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DatasetError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise DatasetError(f"{path}: is no JSON: {error}") from error


def read_info(folder: pathlib.Path) -> Dict[str, Any]:
    """dataset.json of a data set of this version, as it is."""
    path = folder / "dataset.json"
    if not path.is_file():
        raise DatasetError(f"{folder}: is no data set of greatx: it has no dataset.json")
    info = read_json(path)
    if not isinstance(info, dict) or info.get("format") != FORMAT:
        found = info.get("format") if isinstance(info, dict) else type(info).__name__
        raise DatasetError(f"{path}: expected format '{FORMAT}', found {found!r}")
    version = info.get("format_version")
    if version != FORMAT_VERSION:
        raise DatasetError(f"{path}: format_version is {version!r}; this greatx reads {FORMAT_VERSION}. "
                           "Generate the data set anew, or use the greatx that it was made with")
    return info


def parse_sensors(path: pathlib.Path, info: Dict[str, Any]) -> Dict[str, SensorInfo]:
    """All sensors by name, in the order of their numbers in the index. `path` stands for the file in messages."""
    try:
        sensors = [_sensor(path, entry) for entry in info["sensors"]]
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, DatasetError):
            raise
        raise DatasetError(f"{path}: sensors are not described as expected: {error!r}") from error
    return {sensor.name: sensor for sensor in sensors}


def _sensor(path: pathlib.Path, entry: Dict[str, Any]) -> SensorInfo:
    arrays = {a["name"]: ArrayInfo(a["name"], np.dtype(a["dtype"]), tuple(a["shape"]), a["unit"], a["description"])
              for a in entry["arrays"]}
    outputs = {}
    for o in entry["outputs"]:
        if o["format"] not in FORMATS:
            raise DatasetError(f"{path}: {entry['name']}/{o['name']} has format '{o['format']}'; this greatx knows "
                               + ", ".join(FORMATS))
        outputs[o["name"]] = OutputInfo(o["name"], o["format"], tuple(arrays[name] for name in o["arrays"]))
    rate = Fraction(entry["rate_hz"]) if entry["rate_hz"] else None
    return SensorInfo(entry["name"], entry["kind"], rate, arrays, outputs, entry["metadata"])
