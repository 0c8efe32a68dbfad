# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Defines the form to which the answers of both tools are converted, and the cases for which they are
asked."""
import dataclasses

import numpy as np

C = 299792458.0


@dataclasses.dataclass
class Path:
    """One path from the transmitter to the receiver."""

    receiver: int
    #: A letter for each interaction: R reflection, T transmission, D diffraction. "" is a line of sight.
    kinds: str
    points: np.ndarray  #: [n + 2, 3] m: transmitter, interactions, receiver
    delay: float  #: s
    departure: np.ndarray  #: zenith, azimuth, rad
    arrival: np.ndarray  #: zenith, azimuth from the receiver back along the path, rad
    #: [2, 2]: (lambda / 4 pi) T, which maps (theta, phi) at the transmitter to (theta, phi) at the receiver.
    transfer: np.ndarray
    materials: list = dataclasses.field(default_factory=list)  #: greatx only: a name for each interaction
    label: str = ""

    @property
    def length(self):
        return np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum()

    @property
    def gain_db(self):
        power = np.sum(np.abs(self.transfer) ** 2) / 2
        return 10 * np.log10(power) if power > 0 else -np.inf


@dataclasses.dataclass
class Case:
    """A case that both tools solve."""

    name: str
    scene: str  #: name in sionna.rt.scene
    transmitter: tuple
    count: int  #: number of receivers
    low: tuple  #: lower corner of the box from which receivers are drawn, m
    high: tuple  #: upper corner of the box, m
    carrier_hz: float = 3.5e9
    depth: int = 3
    walls: int = 3  #: largest number of transmissions; 0: walls are opaque in both tools
    reflection: bool = True
    diffraction: bool = False
    seed: int = 1
    arrays: bool = False  #: compare antennas as well
    #: Whether to run greatx's exhaustive reference, which takes hours for large scenes with transmissions.
    recall: bool = True
    material: str = ""  #: a material of P.2040 that replaces all materials of the scene

    @property
    def wavelength(self):
        return C / self.carrier_hz


CASES = [
    Case("box", "box", (1.1, -0.7, 2.3), 20, (-4.5, -4.5, 0.3), (4.5, 4.5, 4.5)),
    Case("canyon", "simple_street_canyon", (-30, 5, 10), 40, (-60, -12, 1.5), (60, 12, 20), arrays=True),
    Case("canyon_cars", "simple_street_canyon_with_cars", (-30, 5, 10), 20, (-60, -12, 1.5), (60, 12, 20)),
    Case(
        "canyon_28ghz",
        "simple_street_canyon",
        (-30, 5, 10),
        20,
        (-60, -12, 1.5),
        (60, 12, 20),
        carrier_hz=28e9,
    ),
    Case(
        "canyon_edges",
        "simple_street_canyon",
        (-30, 5, 10),
        20,
        (-60, -12, 1.5),
        (60, 12, 20),
        depth=1,
        walls=0,
        diffraction=True,
    ),
    Case(
        "wedge",
        "simple_wedge",
        (10, 5, 1),
        60,
        (-25, -25, -5),
        (25, 20, 5),
        depth=1,
        walls=0,
        diffraction=True,
    ),
    Case(
        "wedge_metal",
        "simple_wedge",
        (10, 5, 1),
        60,
        (-25, -25, -5),
        (25, 20, 5),
        depth=1,
        walls=0,
        diffraction=True,
        material="metal",
    ),
    Case("etoile", "etoile", (60, -80, 25), 100, (-220, -220, 1.5), (220, 220, 30), walls=0),
    Case("etoile_walls", "etoile", (60, -80, 25), 30, (-220, -220, 1.5), (220, 220, 30), recall=False),
    Case("munich", "munich", (8.5, 21, 27), 30, (-150, -150, 1.5), (150, 150, 30), recall=False),
    Case("florence", "florence", (0, 0, 60), 20, (-150, -150, 1.5), (150, 150, 40), walls=0, recall=False),
]


def case_called(name):
    for case in CASES:
        if case.name == name:
            return case
    raise SystemExit(f"sionna_rt.py: no case '{name}'; there are {', '.join(c.name for c in CASES)}")
