# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads what inertial sensors and GNSS receivers have measured over a sequence (docs/navigation.md)."""

from __future__ import annotations

import dataclasses
import math
from typing import List, Optional

import numpy as np

from ..dataset import Dataset, Sequence
from ..errors import DatasetError
from ..files import Field, interpreting
from .poses import Pose, mount, node_of, nodes_of

#: The greatest Allan deviation of a first-order Gauss-Markov process of standard deviation 1.
MOST_GAUSS_MARKOV_ALLAN = 0.617364


@dataclasses.dataclass(frozen=True)
class NoiseModel:
    """Holds the two numbers by which Kalibr and most filters describe a triad, in SI units."""

    density: float  #: of white noise, unit / sqrt(Hz)
    walk: float  #: of the bias's random walk, unit / s / sqrt(Hz)


@dataclasses.dataclass(frozen=True)
class Imu:
    """Holds all samples of an inertial sensor of one sequence."""

    name: str
    body_from_sensor: Pose
    rate_hz: float
    time_ns: np.ndarray  #: int64 [n]
    rate: np.ndarray  #: float64 [n, 3] rad/s, sensor axes
    force: np.ndarray  #: float64 [n, 3] m/s^2
    rate_bias: np.ndarray  #: float64 [n, 3] rad/s
    force_bias: np.ndarray  #: float64 [n, 3] m/s^2
    gyroscope: NoiseModel
    accelerometer: NoiseModel


def sensors_of(dataset: Dataset, node: str, kind: str) -> List[str]:
    """Returns the names of a node's sensors of a kind, in the order of the data set."""
    nodes = nodes_of(dataset.sequences[0])
    return [
        name
        for name, info in dataset.sensors.items()
        if info.kind == kind and "/" in name and node_of(name, nodes) == node
    ]


def pick_imu(dataset: Dataset, node: str, name: Optional[str]) -> Optional[str]:
    """Returns the inertial sensor of this name (with or without the node), or the only one; None if the node
    has none, or if the name is `none`. Raises DatasetError if there is no sensor of the name, or if there are
    several."""
    names = sensors_of(dataset, node, "imu")
    if name == "none":
        return None
    if name is not None:
        for each in names:
            if name in (each, each[len(node) + 1 :]):
                return each
        raise DatasetError(f"{node}: expected an imu {name!r} (--imu), found {', '.join(names) or 'none'}")
    if len(names) > 1:
        raise DatasetError(f"{node}: has several imus: say which one (--imu); found {', '.join(names)}")
    return names[0] if names else None


def _noise(errors: Field) -> NoiseModel:
    """A Gauss-Markov process of standard deviation s and time T starts like a random walk of the density
    s sqrt(2 / T)."""
    value = {key: errors[key].number(0, 1e9) for key in ("noise_density", "bias_instability", "bias_walk")}
    time_s = errors["bias_time_s"].number(1e-9, 1e12)
    drive = value["bias_instability"] / MOST_GAUSS_MARKOV_ALLAN * math.sqrt(2.0 / time_s)
    return NoiseModel(value["noise_density"], math.hypot(value["bias_walk"], drive))


def read_imu(sequence: Sequence, name: str) -> Imu:
    """Returns the samples of all records of an inertial sensor. Raises DatasetError if there are none."""
    sensor = sequence[name]
    if len(sensor) == 0:
        raise DatasetError(f"{sequence.path}: {name}: expected records, found none")

    def joined(array: str) -> np.ndarray:
        rows = sensor[array]
        return np.concatenate([np.asarray(rows[i]) for i in range(len(sensor))])

    metadata = sensor.metadata
    field = Field(metadata.where, metadata)
    with interpreting(sequence.path / name):
        return Imu(
            name=name,
            body_from_sensor=mount(sensor.record(0)),
            rate_hz=field["sample_rate_hz"].number(1e-9, 1e12),
            time_ns=joined("time"),
            rate=joined("angular_rate"),
            force=joined("specific_force"),
            rate_bias=joined("gyroscope_bias"),
            force_bias=joined("accelerometer_bias"),
            gyroscope=_noise(field["gyroscope"]),
            accelerometer=_noise(field["accelerometer"]),
        )


def at_times(times_ns: np.ndarray, values: np.ndarray, wanted_ns: np.ndarray) -> np.ndarray:
    """Returns values [n, k] at other times, interpolated linearly, and held before the first and after the
    last."""
    return np.stack([np.interp(wanted_ns, times_ns, column) for column in values.T], axis=1)
