# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes what the hallway's measurement reports, from paths of greatx, by the definitions of the paper:
powers of cells and delay spreads of single elements.
"""

import dataclasses
import time
import warnings

import numpy as np

import greatx

from hallway import measured as m

#: a measured cell is a hexagon, stretched along the corridor: half of its height across it and along it, m
CELL_M = np.array([0.043, 0.284])


def places_in_cells(cells, count):
    """Returns `count` positions in each cell, [cells, count, 3] m: the centre and a ring at half the way."""
    around = 2 * np.pi * np.arange(count - 1) / max(count - 1, 1) + 0.3
    ring = 0.6 * CELL_M * np.stack([np.cos(around), np.sin(around)], axis=1)
    offsets = np.concatenate([np.zeros((1, 2)), ring])
    plan = cells[:, None, :] + offsets[None]
    return np.concatenate([plan, np.full((*plan.shape[:2], 1), m.ROBOT_HEIGHT_M)], axis=2)


@dataclasses.dataclass
class Prediction:
    """What a setting predicts, by its definition in the measurement. Power is that of the traced channel: the
    mean over the band and the elements of an array."""

    power_db: np.ndarray  # [array, cells]: mean in dB over the positions in a cell
    mean_power_db: np.ndarray  # [array, cells]: powers of paths added instead, without their phases
    delay_spread_ns: np.ndarray  # [array, positions, elements]
    responses: np.ndarray  # complex [array, positions, taps] of one element
    paths: float  # of a link, mean
    wall_s: float


def simulation(measured, glb, materials, *, effects, **channel):
    sim = greatx.Simulation.from_scene(str(glb), radio_materials=str(materials), effects=effects)
    for number, place in enumerate(measured.arrays, 1):
        sim.place_transmitter(
            f"array{number}",
            place.center,
            look_at=place.center + place.along,
            array=greatx.Array(rows=4, columns=8, pattern="tr38901", polarization="v"),
        )
    sim.add_channel(
        "hallway",
        carrier_hz=m.CARRIER_HZ,
        bandwidth_hz=m.BANDWIDTH_HZ,
        subcarriers=m.SUBCARRIERS,
        **channel,
    )
    return sim


def delay_spread_ns(response):
    """Returns the RMS delay spread of responses over the band [..., subcarrier], as the paper defines it: of
    the taps m.TAPS of the inverse transform, without a window and without a threshold."""
    taps = np.fft.ifft(np.fft.ifftshift(response, axes=-1), axis=-1)[..., m.TAPS]
    power = np.abs(taps) ** 2
    with np.errstate(invalid="ignore"):  # a place that no path reaches has no spread: NaN
        power = power / power.sum(axis=-1, keepdims=True)
    mean = (power * m.TAPS).sum(axis=-1, keepdims=True)
    return 1e9 / m.BANDWIDTH_HZ * np.sqrt((power * (m.TAPS - mean) ** 2).sum(axis=-1)), taps


def predict(measured, sim, cells, *, places=7, subcarriers=m.SUBCARRIERS, batch=64):
    """Runs the channel at `places` positions in each of the cells [n, 2]. Fewer subcarriers over the same
    band give the same powers and spreads as long as no path is longer than their spacing allows."""
    at = places_in_cells(cells, places)
    points = at.reshape(-1, 3)
    robot = greatx.Array(pattern="short_dipole", polarization="v")
    power, path_power, spreads, taps, paths = [], [], [], [], 0
    begin = time.perf_counter()
    for first in range(0, len(points), batch):
        found = sim.paths(receivers=points[first : first + batch], array=robot)
        paths += len(found)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the paper, too, takes one direction for a whole array
            response = found.cfr(m.BANDWIDTH_HZ, subcarriers, normalize_delays=True)[:, 0, :, :, 0]
        power.append((np.abs(response) ** 2).mean(axis=(2, 3)))
        spread, tap = delay_spread_ns(response)
        spreads.append(spread)
        taps.append(tap[:, :, 0])
        sums = np.zeros(found.shape)
        np.add.at(sums, (found.rx, found.tx), (np.abs(found.amplitude) ** 2).mean(axis=(1, 2)))
        path_power.append(sums)
    wall_s = time.perf_counter() - begin
    shape = (len(cells), places, len(measured.arrays))
    with np.errstate(divide="ignore"):
        power_db = 10 * np.log10(np.concatenate(power).reshape(shape)).mean(axis=1).T
        mean_db = 10 * np.log10(np.concatenate(path_power).reshape(shape).mean(axis=1)).T
    return Prediction(
        power_db=power_db,
        mean_power_db=mean_db,
        delay_spread_ns=np.moveaxis(np.concatenate(spreads), 1, 0),
        responses=np.moveaxis(np.concatenate(taps), 1, 0),
        paths=paths / len(points) / len(measured.arrays),
        wall_s=wall_s,
    )


@dataclasses.dataclass
class Score:
    constant_db: float
    median_db: float
    mean_db: float
    three_quarters_db: float
    spread_ns: tuple  # quantiles 0.25, 0.5, 0.75
    distance: float  # Kolmogorov-Smirnov, of the delay spread
    mean_median_db: float  # median error of powers without phases, with a constant of their own
    mean_constant_db: float
    dark: int  # pairs of cell and array with a position that no path reaches; the mean error leaves them out

    def __str__(self):
        low, middle, high = self.spread_ns
        return (
            f"power {self.median_db:5.2f} {self.mean_db:5.2f} {self.three_quarters_db:5.2f} dB "
            f"(no phases: {self.mean_median_db:4.2f}{f', dark: {self.dark}' if self.dark else ''})   "
            f"delay spread {low:5.1f} {middle:5.1f} {high:5.1f} ns, KS {self.distance:.2f}"
        )


def constant_of(predicted_db, measured_db):
    """Returns the one constant of both arrays in dB, with the least sum of absolute errors."""
    return float(np.median(measured_db - predicted_db))


def score(measured, prediction, cells, seen=None):
    """Compares a prediction for `cells` (indices) with the measurement. `seen`: the score of other cells, the
    constants of which hold for cells that are held out."""
    there = measured.power_db[:, cells]
    constant = constant_of(prediction.power_db, there) if seen is None else seen.constant_db
    mean_constant = constant_of(prediction.mean_power_db, there) if seen is None else seen.mean_constant_db
    errors = np.abs(prediction.power_db + constant - there)
    lit = np.isfinite(errors)
    mean_errors = np.abs(prediction.mean_power_db + mean_constant - there)
    spreads = prediction.delay_spread_ns[np.isfinite(prediction.delay_spread_ns)]
    return Score(
        constant_db=constant,
        median_db=float(np.median(errors)),
        mean_db=float(errors[lit].mean()),
        three_quarters_db=float(np.quantile(errors, 0.75)),
        spread_ns=tuple(np.quantile(spreads, (0.25, 0.5, 0.75))),
        distance=measured.delay_spread_ns.distance(spreads),
        mean_median_db=float(np.median(mean_errors)),
        mean_constant_db=mean_constant,
        dark=int((~lit).sum()),
    )
