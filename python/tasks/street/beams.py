# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The beams of a panel, the power that each of them brings to the car, and the beam that geometry chooses.

Beams are in the order of their direction cosine along the panel's columns, from -1 (right, seen along
boresight) to 1. With half a wavelength between columns, beam b and beam -b modulo their number are mirror
images of each other: -1 and 1 are the same beam.
"""
from __future__ import annotations

from typing import Any, Dict, NamedTuple

import numpy as np

from greatx import links, precoding
from greatx.errors import Error

from .drives import Drives


class Beams(NamedTuple):
    """The codebook."""

    weights: np.ndarray  #: complex128 [beam, port], of unit norm
    cosine: np.ndarray  #: [beam], ascending: direction cosine along the columns (+y of the antenna)
    spacing_wl: float  #: from column to column

    def mirrored(self, beam: np.ndarray) -> np.ndarray:
        """Returns the mirror images of beams (half a wavelength between columns)."""
        return -np.asarray(beam) % len(self.cosine)


def codebook(columns: int, oversampling: int, spacing_wl: float = 0.5) -> Beams:
    """Returns the DFT codebook of a row of columns (greatx.precoding.dft), sorted by direction."""
    weights = precoding.dft(columns, oversampling)
    cosine = precoding.beam_cosine(np.arange(len(weights)), columns, oversampling, spacing_wl)
    # A cosine of +1 and of -1 is the same beam at half a wavelength; it is counted as -1.
    cosine = np.where(cosine >= 0.5 / spacing_wl, cosine - 1 / spacing_wl, cosine)
    order = np.argsort(cosine)
    return Beams(weights[order], cosine[order], spacing_wl)


def codebook_of(channel: Any, oversampling: int) -> Beams:
    """Returns the codebook of a channel's transmitter. Raises Error unless it is one row in the plane yz of
    its mount, with one port for each column."""
    antenna: Dict[str, Any] = links.transmitters(channel)[0]
    columns, rows, ports = (antenna.get(name, 0) for name in ("columns", "rows", "ports"))
    if rows != 1 or ports != columns or antenna.get("plane") != "yz":
        raise Error(
            f"{channel.name}: expected a transmitter of one row in the plane yz with one polarization, found "
            f"{rows} rows, {columns} columns and {ports} ports in the plane {antenna.get('plane')}"
        )
    spacing_wl = antenna["column_spacing_m"] * channel.metadata["carrier_hz"] / links.SPEED_OF_LIGHT
    return codebook(columns, oversampling, round(spacing_wl, 9))


def powers(cfr: np.ndarray, beams: Beams) -> np.ndarray:
    """Returns the gain that each beam has for the channel's first receiver, float64 [n, beam], from `cfr` [n,
    rx, rx_ant, tx, tx_ant, time, subcarrier]: |H w|^2, the mean over times and subcarriers.
    """
    h = precoding.matrices(cfr)[..., :1, :, :]  # [n, time, subcarrier, rx, rx_ant, tx_ant]
    return precoding.beam_gains(h, beams.weights).mean(axis=(1, 2))[:, 0]


def powers_of(drives: Drives, channel: str, beams: Beams) -> np.ndarray:
    """Returns powers() of a channel at all items, [n, beam]. It reads drive by drive."""
    parts = []
    for drive in range(len(drives.sequences)):
        sensor, rows = drives.rows(drive, channel)
        parts.append(powers(np.asarray(sensor["cfr"])[rows], beams))
    return np.concatenate(parts)


def free_space(direction: np.ndarray, beams: Beams) -> np.ndarray:
    """Returns the gain of each beam in a direction (unit vectors [n, 3] in the antenna's axes), [n, beam]:
    that of a single path, an element at y being ahead by 2 pi y u_y / lambda (3GPP TR 38.901, eq. 7.5-22).
    """
    columns = beams.weights.shape[1]
    y_wl = (np.arange(columns) - (columns - 1) / 2) * beams.spacing_wl
    response = np.exp(2j * np.pi * direction[:, 1:2] * y_wl)
    return np.abs(response @ beams.weights.T) ** 2
