# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Converts paths and channels to arrays in the conventions of Sionna RT 2.2 (sionna.rt.Paths with synthetic
arrays; docs/converters.md). Delays are absolute: `cir` and `cfr` equal those of Sionna's methods with
normalize_delays=False.
"""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Dict, Optional, Union

import numpy as np

from ..dataset import Dataset, Record, Sensor
from ..errors import DatasetError
from ..files import Field, interpreting
from ..links import (
    DIFFRACTION,
    REFLECTION,
    SCATTERING,
    TARGET,
    TRANSMISSION,
    antenna_pose,
    check_channel,
    paths_of,
    receivers,
    transmitters,
)
from .common import Command, channel_arguments, pick_channel, pick_sequence, save_npz, turns
from .folders import new_folder

#: Values of sionna.rt.constants.InteractionType of our interactions: SPECULAR, DIFFUSE, REFRACTION,
#: DIFFRACTION.
INTERACTION = {REFLECTION: 1, SCATTERING: 2, TRANSMISSION: 4, DIFFRACTION: 8, TARGET: 2}
_INTERACTIONS = np.array([INTERACTION.get(i, 0) for i in range(max(INTERACTION) + 1)], np.uint32)
INVALID = 0xFFFFFFFF  #: value in `objects` that stands for no object


@dataclasses.dataclass
class SionnaPaths:
    """Holds the arrays of a record under the names of sionna.rt.Paths. Links with fewer paths than the axis
    `path` are padded: a, angles, Doppler shifts, vertices and interactions with 0, tau with -1, objects with
    INVALID. There, `valid` is False.
    """

    a: np.ndarray  #: complex64 [rx, rx_ant, tx, tx_ant, path]: coefficients without e^{-j 2 pi f_c tau}
    tau: np.ndarray  #: float64 [rx, tx, path] s, absolute
    theta_t: np.ndarray  #: float32 [rx, tx, path] rad: zenith of departure
    phi_t: np.ndarray  #: float32 [rx, tx, path] rad: azimuth of departure
    #: float32 [rx, tx, path] rad: zenith of arrival, the direction from the receiver back along the path
    theta_r: np.ndarray
    phi_r: np.ndarray  #: float32 [rx, tx, path] rad: azimuth of arrival
    doppler: np.ndarray  #: float32 [rx, tx, path] Hz
    valid: np.ndarray  #: bool [rx, tx, path]
    interactions: np.ndarray  #: uint32 [depth, rx, tx, path]: sionna.rt.constants.InteractionType
    objects: np.ndarray  #: uint32 [depth, rx, tx, path]: index into run.instances of dataset.json
    vertices: np.ndarray  #: float32 [depth, rx, tx, path, 3] m, world
    cir: np.ndarray  #: complex64 [rx, rx_ant, tx, tx_ant, path, time]: a e^{-j 2 pi f_c tau} e^{j 2 pi nu t}
    cfr: np.ndarray  #: complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier]: the data set's own H
    frequencies: np.ndarray  #: float64 [subcarrier] Hz, about the carrier: the argument of Paths.cfr
    times: np.ndarray  #: float64 [time] s, relative to the tick
    sources: np.ndarray  #: float64 [tx, 3] m, world
    targets: np.ndarray  #: float64 [rx, 3] m, world
    frequency: float  #: Hz, the carrier
    synthetic_array: bool = True  #: a path has one direction and one delay for a whole array


def sionna_paths(record: Record) -> SionnaPaths:
    """Converts one record of a channel. Paths keep their order (docs/dataset.md)."""
    sensor = check_channel(record.sensor)
    with interpreting(sensor.sequence.path / sensor.name):
        return _paths(record, sensor)


def _paths(record: Record, sensor: Sensor) -> SionnaPaths:
    meta = sensor.metadata
    carrier = meta["carrier_hz"]
    rx_count, tx_count = len(receivers(sensor)), len(transmitters(sensor))
    links = {(rx, tx): paths_of(record, rx, tx) for rx in range(rx_count) for tx in range(tx_count)}
    cfr = np.array(record["cfr"])
    ports = cfr.shape[1], cfr.shape[3]
    n = max(len(p["delay"]) for p in links.values())
    depth = links[0, 0]["interaction"].shape[1]
    link = (rx_count, tx_count, n)
    out: Dict[str, Any] = {
        "tau": np.full(link, -1.0),
        "valid": np.zeros(link, bool),
        "interactions": np.zeros((depth, *link), np.uint32),
        "objects": np.full((depth, *link), INVALID, np.uint32),
        "vertices": np.zeros((depth, *link, 3), np.float32),
        "doppler": np.zeros(link, np.float32),
    }
    out.update({name: np.zeros(link, np.float32) for name in ("theta_t", "phi_t", "theta_r", "phi_r")})
    a = np.zeros((rx_count, ports[0], tx_count, ports[1], n), complex)
    for (rx, tx), p in links.items():
        at = (rx, tx, slice(0, len(p["delay"])))
        out["tau"][at], out["valid"][at], out["doppler"][at] = p["delay"], True, p["doppler"]
        out["theta_t"][at], out["phi_t"][at] = p["departure"][:, 0], p["departure"][:, 1]
        out["theta_r"][at], out["phi_r"][at] = p["arrival"][:, 0], p["arrival"][:, 1]
        out["interactions"][(slice(None), *at)] = _INTERACTIONS[p["interaction"]].T
        out["objects"][(slice(None), *at)] = np.where(p["object"] > 0, p["object"] - np.uint32(1), INVALID).T
        out["vertices"][(slice(None), *at)] = np.nan_to_num(p["vertex"]).transpose(1, 0, 2)
        a[rx, :, tx, :, : len(p["delay"])] = np.moveaxis(p["amplitude"], 0, -1)
    # `amplitude` is the baseband coefficient, which includes the carrier's phase. Paths.a does not include
    # it.
    passband = (
        a * np.exp(2j * np.pi * turns(carrier, np.where(out["valid"], out["tau"], 0)))[:, None, :, None]
    )
    times = np.arange(cfr.shape[4]) * meta["time_spacing_s"]
    moving = times if meta["doppler_in_time_samples"] else 0 * times
    over_time = np.exp(2j * np.pi * out["doppler"][..., None] * moving)[:, None, :, None]
    subcarriers = Field(sensor.metadata.where, meta)["subcarriers"].integer(1, 1 << 20)
    frequencies = (meta["first_subcarrier"] + np.arange(subcarriers)) * meta["subcarrier_spacing_hz"]
    return SionnaPaths(
        a=passband.astype(np.complex64),
        cir=(a[..., None] * over_time).astype(np.complex64),
        cfr=cfr,
        frequencies=frequencies,
        times=times,
        frequency=carrier,
        sources=np.array([antenna_pose(record, end)[0] for end in transmitters(sensor)]),
        targets=np.array([antenna_pose(record, end)[0] for end in receivers(sensor)]),
        **out,
    )


def write_sionna(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    channel: Optional[str] = None,
    sequence: Optional[int] = None,
) -> Dict[str, int]:
    """Writes OUT/sequence_0000/000000.npz, ...: one file per record, with the fields of SionnaPaths, `tick`
    and `time_s`. Writes one sequence, or all if `sequence` is None. Returns counts of the written objects.
    Raises DatasetError, or FileExistsError if the folder is not empty.
    """
    sequences = dataset.sequences if sequence is None else [pick_sequence(dataset, sequence)]
    sensors = [pick_channel(s, channel) for s in sequences]
    for sensor in sensors:
        for needed in ("cfr", "delay"):
            if needed not in sensor.arrays:
                raise DatasetError(
                    f"{sensor.name}: expected an array {needed!r}, found none; the scenario's channel needs "
                    "outputs: [cfr, paths]"
                )
    written = 0
    with new_folder(out) as root:
        for sensor in sensors:
            folder = root / sensor.sequence.path.name
            folder.mkdir()
            for record in sensor:
                arrays = vars(sionna_paths(record))
                save_npz(
                    folder / f"{record.sample:06d}.npz", tick=record.tick, time_s=record.time_s, **arrays
                )
                written += 1
    return {"sequences": len(sensors), "files": written}


COMMAND = Command(
    "sionna",
    "Sionna RT's arrays, .npz",
    lambda dataset, given: write_sionna(dataset, given.OUT, given.channel, given.sequence),
    lambda parser: channel_arguments(parser, "default: all"),
)
