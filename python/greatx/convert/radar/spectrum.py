# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes spectra, beams and maps from the samples (`cube`) of a radar with ramps, as the engine does
(docs/radar.md, "Windows, transforms, maps").

Transforms divide by the sum of their window, so that a tone at the centre of a bin has its power there. A
beam is the mean of the virtual antennas, each turned back by the phase of its direction and by that of the
time of its slot. python/tests/test_export_radar.py holds the maps against those that the engine has written.
"""

from __future__ import annotations

import dataclasses
from typing import Dict

import numpy as np

from ...dataset import Sensor
from ...errors import DatasetError
from ...files import Field
from ...links import SPEED_OF_LIGHT

#: Coefficients of the windows, which are sums of cosines (Harris, Proc. IEEE 66(1), 1978).
WINDOWS: Dict[str, tuple] = {
    "rectangular": (1.0,),
    "hann": (0.5, 0.5),
    "hamming": (0.54, 0.46),
    "blackman": (0.42, 0.5, 0.08),
}


def window(name: str, size: int) -> np.ndarray:
    """Returns the periodic form of a window, float64 [size]."""
    n = np.arange(size) - size // 2
    return sum(c * np.cos(2 * np.pi * m * n / size) for m, c in enumerate(WINDOWS[name]))  # type: ignore


def noise_bandwidth(values: np.ndarray) -> float:
    """Returns the equivalent noise bandwidth of a window in bins."""
    return float(len(values) * np.sum(values**2) / np.sum(values) ** 2)


@dataclasses.dataclass(frozen=True)
class Axes:
    """Holds the values at the cells of a radar's maps."""

    range_m: np.ndarray  #: [ranges]
    velocity_m_s: np.ndarray  #: [velocities], positive receding, ascending
    azimuth_rad: np.ndarray  #: [azimuths], positive to the left


def axes_of(sensor: Sensor) -> Axes:
    """Returns the axes of a radar that has maps. Raises DatasetError if its description lacks them."""
    shape = {}
    for name in ("range_doppler", "range_azimuth"):
        if name not in sensor.arrays:
            raise DatasetError(
                f"{sensor.sequence.dataset.path}: {sensor.name}: expected an array {name!r} (outputs of the "
                "radar), found none"
            )
        shape[name] = sensor.arrays[name].shape
    field = Field(sensor.metadata.where, sensor.metadata)
    number = {
        key: field[key].number(-1e9, 1e9)
        for key in (
            "range_bin_m",
            "velocity_min_m_s",
            "velocity_bin_m_s",
            "azimuth_min_rad",
            "azimuth_max_rad",
        )
    }
    ranges, velocities = shape["range_doppler"]
    return Axes(
        np.arange(ranges) * number["range_bin_m"],
        number["velocity_min_m_s"] + np.arange(velocities) * number["velocity_bin_m_s"],
        np.linspace(number["azimuth_min_rad"], number["azimuth_max_rad"], shape["range_azimuth"][1]),
    )


def _waveform(sensor: Sensor) -> Field:
    return Field(sensor.metadata.where, sensor.metadata)["waveform"]


def has_beams(sensor: Sensor) -> bool:
    """Whether spectra and beams can be computed: a monostatic radar of ramps that keeps its samples, whose
    transmitters send in turn."""
    if "cube" not in sensor.arrays or sensor.metadata.get("bistatic"):
        return False
    waveform = _waveform(sensor)
    turn = "slot_order" in waveform and waveform.value.get("multiplexing", "tdm") == "tdm"
    return turn and waveform.value.get("type", "fmcw") == "fmcw"


def spectrum(cube: np.ndarray, name: str) -> np.ndarray:
    """Returns complex128 [rx, tx, range, velocity] in sqrt(W) of a cube [rx, tx, chirp, sample], with the
    velocities ascending."""
    chirps, samples = cube.shape[2:]
    over_time, over_range = window(name, chirps), window(name, samples)
    ranges = np.fft.fft(cube * over_range, axis=3) / np.sum(over_range)
    both = np.fft.fft(ranges * over_time[:, None], axis=2) / np.sum(over_time)
    return np.fft.fftshift(both, axes=2).swapaxes(2, 3)


def beams(values: np.ndarray, sensor: Sensor, azimuth_rad: np.ndarray) -> np.ndarray:
    """Returns the power of the beams at elevation 0 of a spectrum [rx, tx, range, velocity]: float64 [range,
    azimuth, velocity] in W."""
    field = Field(sensor.metadata.where, sensor.metadata)
    places = {}
    for side, count in (("receive_m", values.shape[0]), ("transmit_m", values.shape[1])):
        rows = [[x.number(-1e6, 1e6) for x in row.items(3)] for row in field[side].items(4096)]
        if len(rows) != count or any(len(row) != 3 for row in rows):
            raise field[side].fail(f"{count} places of three numbers")
        places[side] = np.array(rows)
    wavelength = SPEED_OF_LIGHT / _waveform(sensor)["carrier_hz"].number(1.0, 1e15)
    velocities = values.shape[3]
    doppler = np.arange(velocities) - velocities // 2
    slots = np.arange(values.shape[1])[:, None] * doppler / (velocities * values.shape[1])
    turned = values * np.exp(-2j * np.pi * slots)[None, :, None, :]
    direction = np.stack([np.cos(azimuth_rad), np.sin(azimuth_rad), np.zeros_like(azimuth_rad)])
    elements = places["receive_m"][:, None] + places["transmit_m"][None]
    steering = np.exp(2j * np.pi * (elements @ direction) / wavelength)  # [rx, tx, azimuth]
    sums = np.einsum("rtnv,rta->nav", turned, steering, optimize=True) / (values.shape[0] * values.shape[1])
    return np.abs(sums) ** 2
