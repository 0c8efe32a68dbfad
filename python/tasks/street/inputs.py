# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the inputs of the networks once, as files that are mapped into memory.

NAME.npy has the input of each item, and NAME.json, which is written last, says from which data and by which
settings it was made. If they are the same, the next run takes what is there.
"""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Callable, Dict, Tuple

import numpy as np

import greatx
from greatx import inputs
from tasks.common.files import write_text
from tasks.common.inputs import GLARE
from tasks.common.progress import Countdown

from .drives import Drives

Make = Callable[[Any], np.ndarray]  #: the input of a record of a sensor
Maker = Tuple[str, np.dtype, Make]  #: sensor, type of the array, function


def camera(sensor: str, size: Tuple[int, int]) -> Maker:
    """Returns how pictures are made, uint8 [3, rows, columns]."""
    return sensor, np.dtype(np.uint8), lambda record: inputs.picture(record["rgb"], tuple(size))


def lidar(sensor: str, size: Tuple[int, int]) -> Maker:
    """Returns how range images are made, float16 [2, rows, columns]."""

    def make(record: Any) -> np.ndarray:
        image = inputs.lidar_map(record["points"], record.sensor.metadata, tuple(size))
        return np.minimum(image, GLARE)

    return sensor, np.dtype(np.float16), make


def events(sensor: str, size: Tuple[int, int]) -> Maker:
    """Returns how events of a tick are made, float16 [2, rows, columns]: ln(1 + number) of the darker and of
    the brighter events in each part of the picture."""
    rows, columns = size

    def make(record: Any) -> np.ndarray:
        found = record.events()
        row = found.y.astype(np.int64) * rows // found.height
        column = found.x.astype(np.int64) * columns // found.width
        cell = (found.p.astype(np.int64) * rows + row) * columns + column
        return np.log1p(np.bincount(cell, minlength=2 * rows * columns).reshape(2, rows, columns))

    return sensor, np.dtype(np.float16), make


def radar(sensor: str, size: Tuple[int, int], span_db: float) -> Maker:
    """Returns how radar maps are made, float16 [2, rows, columns]: range and azimuth, range and velocity."""

    def make(record: Any) -> np.ndarray:
        maps = [inputs.radar_map(record[n], tuple(size), span_db) for n in ("range_azimuth", "range_doppler")]
        return np.concatenate(maps)

    return sensor, np.dtype(np.float16), make


def cached(
    folder: pathlib.Path, drives: Drives, makers: Dict[str, Maker], settings: Any
) -> Dict[str, np.ndarray]:
    """Returns the inputs of all items by name, [n, channels, rows, columns], memory-mapped from `folder`.
    Those that the folder lacks, or that were made from other data or by other settings, are made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    out = {}
    for name, maker in makers.items():
        provenance = {
            "greatx": greatx.__version__,
            "data": drives.fingerprint,
            "items": len(drives),
            "sensor": maker[0],
            "settings": json.loads(json.dumps(settings)),
        }
        said, path = folder / f"{name}.json", folder / f"{name}.npy"
        if not said.is_file() or json.loads(said.read_text()) != provenance:
            part = path.with_name(f"{name}.{os.getpid()}.part.npy")  # other runs may have `path` open
            _make(part, name, drives, maker)
            os.replace(part, path)
            write_text(said, json.dumps(provenance, indent=1) + "\n")
        out[name] = np.load(path, mmap_mode="r")
    return out


def _make(path: pathlib.Path, name: str, drives: Drives, maker: Maker) -> None:
    sensor, dtype, make = maker
    countdown = Countdown(f"inputs of {name}", len(drives))
    array, done = None, 0
    for drive in range(len(drives.sequences)):
        found, rows = drives.rows(drive, sensor)
        for row in rows:
            value = make(found.record(int(row)))
            if array is None:
                array = np.lib.format.open_memmap(path, "w+", dtype, (len(drives), *value.shape))
            array[done] = value
            done += 1
        countdown.show(done)
    array.flush()
