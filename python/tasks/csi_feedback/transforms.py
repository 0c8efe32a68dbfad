# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Turns frequency responses into matrices over angle and delay, and back.

A channel H [port, subcarrier] of a line of P ports and N subcarriers has the frequencies
(k - floor(N/2)) / (N T), where T = 1 / bandwidth is the length of a bin of delay. Its matrix over angle and
delay is

    X[a, d] = 1/sqrt(P N) sum_m sum_k H[m, k] e^{-j 2 pi a m / P} e^{+j 2 pi d (k - floor(N/2)) / N}

so that a path of delay tau lies about d = tau / T, with greatx's absolute delays. Both transforms are
unitary: with all N bins, the power is that of H. Only the first bins are kept, as C.-K. Wen et al. do ("Deep
learning for massive MIMO CSI feedback", 2018, section II), because the paths of a cell arrive within them.
"""
from __future__ import annotations

from typing import Tuple

import numpy as np

from greatx.errors import Error


def delay_matrix(subcarriers: int, delays: int) -> np.ndarray:
    """Returns the transform from subcarriers to the first bins of delay, complex64 [subcarrier, delay]."""
    if not 1 <= delays <= subcarriers:
        raise Error(f"delays: expected 1 to {subcarriers}, the number of subcarriers, found {delays}")
    k = np.arange(subcarriers) - subcarriers // 2
    turns = np.outer(k, np.arange(delays)) / subcarriers
    return (np.exp(2j * np.pi * turns) / np.sqrt(subcarriers)).astype(np.complex64)


def angle_matrix(ports: int) -> np.ndarray:
    """Returns the transform from ports to angles, complex64 [port, angle], unitary and symmetric."""
    turns = np.outer(np.arange(ports), np.arange(ports)) % ports / ports
    return (np.exp(-2j * np.pi * turns) / np.sqrt(ports)).astype(np.complex64)


def angular_delay(response: np.ndarray, delays: int) -> Tuple[np.ndarray, np.ndarray]:
    """Returns X of frequency responses, complex64 [n, angle, delay], and the share of the power of each that
    lies in later bins, float32 [n].

    response  [n, port, subcarrier], each with power
    """
    response = np.asarray(response)
    if response.ndim != 3:
        raise Error(f"response: expected [n, port, subcarrier], found {list(response.shape)}")
    kept = response.astype(np.complex64) @ delay_matrix(response.shape[2], delays)
    matrices = angle_matrix(response.shape[1]) @ kept
    # In double precision, because the share that is left out may be a small difference.
    power = np.square(np.abs(response), dtype=np.float64).sum((1, 2))
    if np.any(power == 0):
        raise Error(f"response: expected power in each, found none in number {int(np.argmin(power))}")
    outside = 1 - np.square(np.abs(matrices), dtype=np.float64).sum((1, 2)) / power
    return matrices, np.maximum(outside, 0).astype(np.float32)


def frequency_response(matrices: np.ndarray, subcarriers: int) -> np.ndarray:
    """Returns the frequency responses of X [n, angle, delay], complex64 [n, port, subcarrier], where the bins
    that were left out are zero."""
    angles, delays = matrices.shape[1:]
    ports = np.conj(angle_matrix(angles)) @ matrices
    return ports @ np.conj(delay_matrix(subcarriers, delays)).T


def in_ports(matrices: np.ndarray) -> np.ndarray:
    """Returns X over ports and delay, complex64 [n, port, delay]."""
    return np.conj(angle_matrix(matrices.shape[1])) @ matrices


def in_angles(matrices: np.ndarray) -> np.ndarray:
    """Returns the inverse of in_ports, complex64 [n, angle, delay]."""
    return angle_matrix(matrices.shape[1]) @ matrices


def images(matrices: np.ndarray) -> np.ndarray:
    """Returns what networks take: real and imaginary part, float32 [n, 2, angle, delay], scaled into [0, 1]
    around 0.5.

    Each matrix is divided by its norm, so that no entry leaves the range: its power is one number that a user
    reports apart. Raises Error for a matrix without power.
    """
    norm = np.linalg.norm(matrices, axis=(1, 2), keepdims=True)
    if np.any(norm == 0):
        raise Error(f"matrices: expected power in each, found none in number {int(np.argmin(norm))}")
    unit = matrices / norm
    return (0.5 + 0.5 * np.stack([unit.real, unit.imag], axis=1)).astype(np.float32)


def matrices(pictures: np.ndarray) -> np.ndarray:
    """Returns the matrices of images, complex64 [n, angle, delay], of norm 1 if the images are exact."""
    parts = 2 * np.asarray(pictures, np.float32) - 1
    return parts[:, 0] + 1j * parts[:, 1]
