# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes events.h5 and rectify_map.h5 of one event camera, with the conventions of the engine's own output
`hdf5` (docs/events.md): times in microseconds rounded down, and ms_to_idx so that t[ms_to_idx[ms]] >= 1000 ms
and t[ms_to_idx[ms] - 1] < 1000 ms.
"""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np

from ...dataset import Sensor
from ...errors import DatasetError
from ..hdf5_output import hdf5_file
from .rig import View

CHUNK = 1 << 16


class _Column:
    def __init__(self, group: Any, name: str, dtype: str, rows: int):
        options = {"chunks": (min(CHUNK, rows),), "compression": "gzip", "shuffle": True} if rows else {}
        self._data = group.create_dataset(name, (rows,), dtype, track_times=False, **options)
        self._end = 0

    def append(self, values: np.ndarray) -> None:
        self._data[self._end : self._end + len(values)] = values
        self._end += len(values)


def ms_to_index(times_us: np.ndarray, first: int, known: int) -> np.ndarray:
    """Returns the entries of ms_to_idx from millisecond `known` up to that of the last time; `first` is the
    number of the first event."""
    if len(times_us) == 0:
        return np.empty(0, np.uint64)
    wanted = np.arange(known, int(times_us[-1]) // 1000 + 1) * 1000
    return (first + np.searchsorted(times_us, wanted, side="left")).astype(np.uint64)


def write_events(h5py: Any, path: pathlib.Path, sensor: Sensor, start_us: int) -> int:
    """Writes events.h5, and returns the number of events. Raises DatasetError if a time does not fit 32
    bits."""
    total = int(sensor["t"].offsets[-1])
    with hdf5_file(h5py, path) as checked:
        file = checked.file
        group = file.create_group("events")
        columns = {
            n: _Column(group, n, d, total) for n, d in (("p", "u1"), ("t", "<u4"), ("x", "<u2"), ("y", "<u2"))
        }
        index, first, last_us = [], 0, -1
        known = 0
        for row in range(len(sensor)):
            events = sensor.events(row, row + 1)
            times = np.asarray(events.t) // 1000
            if len(times) and (times[0] < max(last_us, 0) or np.any(np.diff(times) < 0)):
                raise DatasetError(f"{sensor.sequence.path / sensor.name}: expected times that grow from 0")
            if len(times) and times[-1] > 0xFFFFFFFF:
                raise DatasetError(
                    f"{sensor.sequence.path / sensor.name}: expected times of at most 4294.967295 s for "
                    f"DSEC's format, found {times[-1]} us"
                )
            entries = ms_to_index(times, first, known)
            index.append(entries)
            known += len(entries)
            for name, values in (("p", events.p), ("t", times), ("x", events.x), ("y", events.y)):
                columns[name].append(values)
            checked.check()
            if len(times):
                last_us = int(times[-1])
            first += len(times)
        index.append(np.array([total], np.uint64))
        file.create_dataset("ms_to_idx", data=np.concatenate(index), track_times=False)
        file.create_dataset("t_offset", data=np.int64(start_us), track_times=False)
    return total


def write_rectify_map(h5py: Any, path: pathlib.Path, view: View) -> None:
    """Writes rectify_map.h5: float32 [h, w, 2], the place of each pixel's centre in the rectified view."""
    rectified = view.rectify(view.grid())
    if not np.all(np.isfinite(rectified)):
        raise DatasetError(f"{view.name}: expected all pixels before the rectified view, found one behind it")
    with hdf5_file(h5py, path) as checked:
        checked.file.create_dataset(
            "rectify_map",
            data=rectified.astype(np.float32),
            track_times=False,
            compression="gzip",
            shuffle=True,
        )
