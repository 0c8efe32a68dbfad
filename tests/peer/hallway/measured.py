# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the measured hallway: a folder with the power maps, distributions, survey and model of DICHASUS's
file dc01 as NVlabs/diff-rt-calibration publishes them (arXiv 2311.18558). Its licence is for evaluation, so
that nothing of it is in this repository: every number of it is read from the folder.
"""

import csv
import dataclasses
import json
import pathlib

import numpy as np

CARRIER_HZ = 3.438e9
BANDWIDTH_HZ = 50e6
SUBCARRIERS = 1024
#: taps of the delay spread, in samples of 1 / bandwidth, around the first path of a traced channel
TAPS = np.arange(-8, 80)
#: height of the robot's antenna in the scene's frame, m
ROBOT_HEIGHT_M = 1.04


def table(path):
    """Returns the columns of a CSV file by name, float64."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


@dataclasses.dataclass
class Distribution:
    """A measured distribution: values, ascending, and the share of values up to each."""

    value: np.ndarray
    cdf: np.ndarray

    def quantile(self, share):
        return np.interp(share, self.cdf, self.value)

    def distance(self, values):
        """Returns the Kolmogorov-Smirnov distance of a sample, over the range of this distribution."""
        values = np.sort(np.ravel(values))
        ranks = np.arange(len(values) + 1) / len(values)
        inside = (values >= self.value[0]) & (values <= self.value[-1])
        there = np.interp(values, self.value, self.cdf)
        apart = np.maximum(np.abs(there - ranks[:-1]), np.abs(there - ranks[1:]))
        return float(apart[inside].max(initial=0.0))


@dataclasses.dataclass
class ArrayPlace:
    center: np.ndarray  # m, scene
    along: np.ndarray  # unit, scene: along the corridor, as the paper takes it


class Measured:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        maps = [table(self.folder / f"power_map_rx{i}.csv") for i in (1, 2)]
        #: [cells, 2] m, centres of the cells in the scene's frame
        self.cells = np.stack([maps[0]["scene_x_m"], maps[0]["scene_y_m"]], axis=1)
        if any((m["scene_x_m"] != self.cells[:, 0]).any() for m in maps):
            raise SystemExit(f"{folder}: expected the same cells in both power maps")
        #: [array, cells] dB, up to one constant
        self.power_db = np.stack([m["measured_dB"] for m in maps])
        spread = table(self.folder / "cdf_delay_spread_measured.csv")
        self.delay_spread_ns = Distribution(spread["delay_spread_ns"], spread["cdf"])
        self.arrays = self._arrays()

    def _survey(self):
        """Returns surveyed points by name, (west, south, height) m, without those that were not seen."""
        points = {}
        with open(self.folder / "data/coordinates.csv", newline="") as file:
            for row in csv.DictReader(file):
                if "noLoS" not in row.values():
                    points[row["Name"]] = np.array([float(row[n]) for n in ("West", "South", "Height")])
        return points

    def _arrays(self):
        """Returns the arrays, north first. The survey's frame turns into the scene's about the vertical: the
        point AU is the origin, and NWU lies on +y."""
        points = self._survey()
        origin, north = points["AU"], points["NWU"] - points["AU"]
        turn = np.pi / 2 - np.arctan2(north[1], north[0])
        to_scene = np.array(
            [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0.0, 0.0, 1.0]]
        )
        with open(self.folder / "data/spec.json") as file:
            antennas = json.load(file)["antennas"]
        places = []
        for antenna in antennas:
            direction = to_scene @ np.array(antenna["direction"])
            places.append(
                ArrayPlace(
                    center=to_scene @ (np.array(antenna["location"]) - origin),
                    along=np.array([0.0, np.sign(direction[1]), 0.0]),
                )
            )
        return places

    def responses(self):
        """Returns four measured impulse responses, (delays ns, |h|), the shapes of which count."""
        found = [table(self.folder / f"cir_{i}_measured.csv") for i in range(1, 5)]
        return [(t["delay_ns"], t["abs_h"]) for t in found]

    def blocks(self, side_m):
        """Returns the block of a checkerboard that each cell lies in, 0 or 1."""
        return (np.floor(self.cells / side_m).astype(int).sum(axis=1) % 2).astype(int)
