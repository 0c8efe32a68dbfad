# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Describes where channels come from: a scene, its base stations, and the box from which users are drawn."""
from __future__ import annotations

import dataclasses
import pathlib
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from ..common.config import positive

FOLDER = pathlib.Path(__file__).resolve().parent / "domains"


@dataclasses.dataclass
class Generate:
    """A scene of greatx's generator (docs/generator.md)."""

    kind: str
    seed: int
    size_m: float


@dataclasses.dataclass
class Domain:
    """The fields of domains/*.yaml, which explain them."""

    name: str
    scene: Optional[str]
    radio_materials: Optional[str]
    generate: Optional[Generate]
    carrier_hz: float
    bandwidth_hz: float
    subcarriers: int
    ports: int
    delays: int
    most_outside: float
    max_depth: int
    max_transmissions: int
    effects: Dict[str, bool]
    sites: List[Tuple[float, float, float, float]]
    low_m: Tuple[float, float, float]
    high_m: Tuple[float, float, float]

    def __post_init__(self) -> None:
        positive(carrier_hz=self.carrier_hz, bandwidth_hz=self.bandwidth_hz, ports=self.ports)
        if not 1 <= self.delays <= self.subcarriers:
            raise ValueError(
                f"delays: expected 1 to {self.subcarriers}, the number of subcarriers, found {self.delays}"
            )
        if not self.sites:
            raise ValueError("sites: expected a base station, found none")
        if np.any(np.array(self.low_m) > np.array(self.high_m)):
            raise ValueError(f"high_m: expected nothing below low_m, {self.low_m}, found {self.high_m}")

    def draw(self, count: int, generator: np.random.Generator) -> np.ndarray:
        """Returns uniformly drawn positions, float64 [count, 3] m. Whole millimetres, which other programs'
        single precision keeps as well."""
        return np.round(generator.uniform(self.low_m, self.high_m, (count, 3)), 3)


def counts(total: int, sites: int) -> List[int]:
    """Returns how many of `total` users each base station serves."""
    return [total // sites + (i < total % sites) for i in range(sites)]


def facts(domain: Domain, users: Dict[str, Any], outside: np.ndarray, made_by: str) -> Dict[str, Any]:
    """Returns what set.json tells about a set of a domain, whatever program computed its channels."""
    return {
        "name": domain.name,
        "made_by": made_by,
        "carrier_hz": domain.carrier_hz,
        "bandwidth_hz": domain.bandwidth_hz,
        "subcarriers": domain.subcarriers,
        "array": f"{domain.ports} isotropic elements of vertical polarization in a line, half a wavelength",
        "sites": [list(site) for site in domain.sites],
        "max_depth": domain.max_depth,
        "max_transmissions": domain.max_transmissions,
        "most_outside": domain.most_outside,
        "users": {"low_m": list(domain.low_m), "high_m": list(domain.high_m), **users},
        "power_outside": {"mean": float(outside.mean()), "p95": float(np.percentile(outside, 95))},
    }
