# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the file of an exporter whole or not at all, imports optional packages, and reads whole records.

Like folders.py for folders: an exporter writes OUT.part, which gets the name OUT when it is complete.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import os
import pathlib
from typing import Any, Dict, Iterable, Iterator, List, Optional, Tuple, Union

import numpy as np

from ..dataset import Dataset, Sensor, Sequence
from ..errors import DatasetError
from ..layout import EXPORT_SUFFIX
from .common import sequence_argument
from .folders import terminated_as_interrupted


@contextlib.contextmanager
def new_file(out: Union[str, "os.PathLike[str]"]) -> Iterator[pathlib.Path]:
    """Gives a path to write a file at, which becomes `out` at the end of the context. Raises FileExistsError
    if `out` exists."""
    target = pathlib.Path(os.path.abspath(out))
    if os.path.lexists(target):
        raise FileExistsError(f"{out}: exists; nothing is overwritten")
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(target.name + ".part")
    if os.path.lexists(part) and (part.is_symlink() or not part.is_file()):
        raise FileExistsError(
            f"{part}: exists, but is no unfinished export of {target}; nothing is overwritten"
        )
    try:
        with terminated_as_interrupted():
            part.unlink(missing_ok=True)  # of an export that was killed
            yield part
            os.link(part, target)  # unlike a rename, this does not replace a file that has come meanwhile
            part.unlink()
    except BaseException:
        part.unlink(missing_ok=True)
        raise


#: Packages on PyPI by the extra of greatx that has them (pyproject.toml). Messages name the packages, because
#: greatx itself is on no index.
EXTRAS = {
    "hdf5": ("h5py",),
    "mcap": ("mcap", "mcap-protobuf-support", "foxglove-schemas-protobuf"),
    "radar": ("pillow",),
}


def need(extra: str, *modules: str) -> Tuple[Any, ...]:
    """Imports optional packages. Raises ImportError that names the packages to install."""
    try:
        return tuple(importlib.import_module(module) for module in modules)
    except ImportError as error:
        raise ImportError(
            f"this converter needs {', '.join(modules)}, found: {error}; "
            f"`pip install {' '.join(EXTRAS[extra])}` installs what it needs"
        ) from error


def selection_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds --sequence and --sensor."""
    sequence_argument(parser)
    parser.add_argument(
        "--sensor", action="append", metavar="NAME", help="a sensor to write; may be repeated; default: all"
    )


def pick_sensors(dataset: Dataset, names: Optional[Iterable[str]]) -> List[str]:
    """Returns the names of the sensors, in the data set's order; all if None. Raises DatasetError for a name
    that the data set has not."""
    if names is None:
        return list(dataset.sensors)
    wanted = list(names)
    for name in wanted:
        if name not in dataset.sensors:
            raise DatasetError(f"{dataset.path}: has no sensor {name!r}; it has {', '.join(dataset.sensors)}")
    return [name for name in dataset.sensors if name in wanted]


class Records:
    """Reads all arrays of the records of a sensor. A file that holds several of them is decoded once."""

    def __init__(self, sensor: Sensor):
        self.sensor = sensor
        #: arrays of each output from which they are read
        self._groups: Dict[str, List[str]] = {}
        for name in sensor.arrays:
            located = sensor.info.locate(name)
            if located is None or located[0].format in EXPORT_SUFFIX:
                raise DatasetError(
                    f"{sensor.sequence.path / sensor.name}: {name}: expected an output to read"
                )
            self._groups.setdefault(located[0].name, []).append(name)

    def __getitem__(self, row: int) -> Dict[str, np.ndarray]:
        """Returns the arrays of a record by name, in the sensor's order."""
        found: Dict[str, np.ndarray] = {}
        for output, names in self._groups.items():
            if len(names) > 1:
                whole = self.sensor[output][row]
                found.update({name: whole[name] for name in names})
            else:
                found[names[0]] = self.sensor[names[0]][row]
        return {name: np.asarray(found[name]) for name in self.sensor.arrays}


def stacked(sensor: Sensor, name: str, dtype: Any = np.float64) -> np.ndarray:
    """Returns an array of fixed shape of all records, [records, ...]."""
    return np.array(sensor[name][:], dtype)


def record_rows(sequence: Sequence, names: Iterable[str]) -> Iterator[Tuple[str, int]]:
    """Returns (sensor, row) of the records of some sensors, in order of tick, then sensor."""
    wanted = set(names)
    every = list(sequence.sensors)
    for sensor, row in sequence.index[:, [2, 4]]:
        if every[int(sensor)] in wanted:
            yield every[int(sensor)], int(row)
