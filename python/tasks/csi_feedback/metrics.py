# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""How well matrices over angle and delay are restored, as C.-K. Wen et al. define it ("Deep learning for
massive MIMO CSI feedback", 2018, equations 6 and 7)."""
from __future__ import annotations

import numpy as np

from .transforms import delay_matrix


def normalized_errors(true: np.ndarray, found: np.ndarray) -> np.ndarray:
    """Returns ||H - H'||^2 / ||H||^2 of each matrix, float64 [n], of complex [n, angle, delay]."""
    error = np.square(np.abs(true - found), dtype=np.float64).sum((1, 2))
    return error / np.square(np.abs(true), dtype=np.float64).sum((1, 2))


def nmse_db(errors: np.ndarray) -> float:
    """Returns the NMSE in dB, 10 log10 of the mean of normalized_errors."""
    return float(10 * np.log10(np.mean(errors)))


def similarities(true: np.ndarray, found: np.ndarray, subcarriers: int, step: int = 1) -> np.ndarray:
    """Returns rho of each matrix, float64 [n]: the mean over subcarriers of |h'^H h| / (||h'|| ||h||), where
    h and h' are the vectors over the ports.

    Both are transformed back from the truncated matrices, so that rho tells the loss by the feedback alone;
    data sets tell the share of power that the truncation leaves out. The transform over the ports is unitary
    and does not change the products, so it is left out. A vector without power counts as 0.

    step  takes every step-th subcarrier only
    """
    back = np.conj(delay_matrix(subcarriers, true.shape[2])[::step]).T
    out = np.empty(len(true))
    for first in range(0, len(true), 64):  # the responses of all would take gigabytes
        part = slice(first, first + 64)
        h, g = true[part] @ back, found[part] @ back
        product = np.abs(np.einsum("nps,nps->ns", np.conj(g), h))
        norms = np.linalg.norm(g, axis=1) * np.linalg.norm(h, axis=1)
        out[part] = np.divide(product, norms, out=np.zeros_like(product), where=norms > 0).mean(1)
    return out
