# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the inputs of the networks once, and maps them into memory.

A folder holds MODALITY.npy with the input of every record, uint8 for pictures and float16 for the rest, and
provenance.json, which is written last and says from which data and by which settings they were made.
Training then decodes no picture and transforms no channel.
"""
from __future__ import annotations

import dataclasses
import json
import pathlib
from typing import Any, Callable, Dict, Optional

import numpy as np

import greatx
from greatx import inputs, links, precoding
from greatx.errors import Error
from tasks.common.data import Opened
from tasks.common.files import write_text
from tasks.common.inputs import GLARE
from tasks.common.progress import Countdown

from .records import Records
from .settings import Inputs

PROVENANCE = "provenance.json"


@dataclasses.dataclass
class Cached:
    """The inputs of all records."""

    arrays: Dict[str, np.ndarray]  #: by modality: [n, channels, height, width], memory-mapped
    seconds: float  #: that making them took
    bytes: int

    def channels(self) -> Dict[str, int]:
        return {name: array.shape[1] for name, array in self.arrays.items()}


def cached(folder: pathlib.Path, opened: Opened, records: Records, settings: Inputs) -> Cached:
    """Returns the inputs in `folder`, which are made first if it does not hold those of these records and
    settings. Raises Error if the folder holds other files.
    """
    beams = beams_of(opened, records)
    provenance = {
        "greatx": greatx.__version__,
        "data": records.fingerprint,
        "cells": records.cells,
        "records": len(records),
        "modalities": records.modalities,
        "beams": beams,
        "inputs": dataclasses.asdict(settings),
    }
    path = folder / PROVENANCE
    found = json.loads(path.read_text()) if path.is_file() else None
    if found is None or {**found, "seconds": 0} != {**provenance, "seconds": 0}:
        if found is None and folder.is_dir() and any(not f.name.endswith(".npy") for f in folder.iterdir()):
            raise Error(f"{folder}: expected a cache of this task, or no folder, found other files")
        path.unlink(missing_ok=True)
        seconds = _make(folder, opened, records, settings, beams)
        found = {**provenance, "seconds": seconds}
        write_text(path, json.dumps(found, indent=1) + "\n")
    arrays = {m: np.load(folder / f"{m}.npy", mmap_mode="r") for m in records.modalities}
    return Cached(arrays, found["seconds"], sum(array.nbytes for array in arrays.values()))


def beams_of(opened: Opened, records: Records) -> int:
    """Returns the ports of the channel, which are the same in all cells."""
    counts = {}
    for cell, sensors in zip(records.cells, records.sensors):
        dataset = opened[cell] if isinstance(opened, greatx.Campaign) else opened
        shape = dataset.sensors[sensors["csi"]].arrays["cfr"].shape
        counts[shape[1] * shape[3]] = cell
    if len(counts) > 1:
        raise Error(
            f"{opened.path}: expected as many ports in all cells, found {', '.join(map(str, counts))}"
        )
    return next(iter(counts))


def _make(folder: pathlib.Path, opened: Opened, records: Records, settings: Inputs, beams: int) -> float:
    folder.mkdir(parents=True, exist_ok=True)
    countdown = Countdown("inputs", len(records))
    shapes = settings.shapes(beams)
    arrays = {
        m: np.lib.format.open_memmap(
            folder / f"{m}.npy", "w+", np.uint8 if m == "rgb" else np.float16, (len(records), *shapes[m])
        )
        for m in records.modalities
    }
    for i in range(len(records)):
        tick = _tick(opened, records, i)
        sensors = records.sensors[records.cell[i]]
        for k, name in enumerate(records.modalities):
            if records.present[i, k]:
                arrays[name][i] = MAKERS[name](tick[sensors[name]], settings, i)
        countdown.show(i + 1)
    for array in arrays.values():
        array.flush()
    return countdown.seconds


def _tick(opened: Opened, records: Records, i: int) -> "greatx.Tick":
    cell = records.cells[records.cell[i]]
    dataset = opened[cell] if isinstance(opened, greatx.Campaign) else opened
    return dataset.sequences[records.sequence[i]].at(int(records.tick[i]))


def channel_noise(spacing_hz: float, subcarriers: int, power_dbm: float, noise_figure_db: float) -> float:
    """Returns the standard deviation of the error of an estimated channel coefficient, with thermal noise k T
    B F in each subcarrier and the power spread evenly over all of them.
    """
    pilot_w = 10 ** ((power_dbm - 30) / 10) / subcarriers
    return float(np.sqrt(precoding.noise_w(spacing_hz, noise_figure_db) / pilot_w))


def _csi(record: "greatx.Record", settings: Inputs, i: int) -> np.ndarray:
    h = inputs.link_cfr(record["cfr"])
    meta = record.sensor.metadata
    if settings.csi_power_dbm is not None:
        sigma = channel_noise(
            meta["subcarrier_spacing_hz"], h.shape[-1], settings.csi_power_dbm, settings.csi_noise_figure_db
        )
        draw = np.random.default_rng((2028, i)).standard_normal((2, *h.shape), np.float32)
        h = h + np.float32(sigma / np.sqrt(2)) * (draw[0] + 1j * draw[1])
    # The drone has one port: its transmitter's panel makes the beams.
    antenna = links.transmitters(record.sensor)[0]
    panel: Optional[tuple] = inputs.panel_of(antenna) if "rows" in antenna else None
    if panel is not None and np.prod(panel) != h.shape[0]:
        panel = None
    delays = min(settings.csi_delays, h.shape[-1])
    out = np.zeros((4, h.shape[0], settings.csi_delays), np.float32)
    out[..., :delays] = inputs.csi_map(h, delays, panel=panel, floor_db=settings.csi_floor_db)
    return out


def _lidar(record: "greatx.Record", settings: Inputs, i: int) -> np.ndarray:
    meta = record.sensor.metadata
    rows = min(settings.lidar_rows, len(meta.get("elevations_deg", range(settings.lidar_rows))))
    image = inputs.lidar_map(record["points"], meta, (rows, settings.lidar_columns))
    # Of a LiDAR with fewer channels than rows, each channel is several rows.
    image = image[:, np.arange(settings.lidar_rows) * rows // settings.lidar_rows]
    return np.minimum(image, GLARE)


def _radar(record: "greatx.Record", settings: Inputs, i: int) -> np.ndarray:
    name = "range_azimuth" if "range_azimuth" in record.sensor else "range_doppler"
    return inputs.radar_map(record[name], (settings.radar_rows, settings.radar_columns))


def _events(record: "greatx.Record", settings: Inputs, i: int) -> np.ndarray:
    grid = inputs.event_voxels(record.events(), settings.event_bins, settings.event_px)
    return np.sign(grid) * np.log1p(np.abs(grid))  # counts of a few to hundreds


#: modality -> input of a record, from the record, the settings, and the record's number
MAKERS: Dict[str, Callable[[Any, Inputs, int], np.ndarray]] = {
    "rgb": lambda record, s, i: inputs.picture(record["rgb"], s.picture_px),
    "depth": lambda record, s, i: inputs.depth_map(record["depth"], s.picture_px, s.depth_m),
    "csi": _csi,
    "lidar": _lidar,
    "radar": _radar,
    "events": _events,
}
