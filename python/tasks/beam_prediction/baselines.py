# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Rankings of beams without a network. Each function returns scores [items, beam]: higher is better."""
from __future__ import annotations

import numpy as np

from tasks.street.drives import Drives


def most_frequent(power: np.ndarray, train: np.ndarray, items: np.ndarray) -> np.ndarray:
    """Returns how often each beam was the best one in training, for every item alike."""
    count = np.bincount(power[train].argmax(-1), minlength=power.shape[1])
    return np.broadcast_to(count.astype(float), (len(items), power.shape[1]))


def last_sweep(power: np.ndarray, drives: Drives, items: np.ndarray, delay: int) -> np.ndarray:
    """Returns the powers that a sweep found `delay` ticks before. Items must be at least so far from the
    beginning of their drive."""
    if np.any(drives.order[items] < delay):
        raise ValueError(f"expected items {delay} ticks or more after the beginning of their drive")
    return power[items - delay]


def similar_pictures(
    pictures: np.ndarray, power: np.ndarray, train: np.ndarray, items: np.ndarray, count: int
) -> np.ndarray:
    """Returns the mean powers, over the best beam's, of the `count` training items whose pictures [n, ...]
    are nearest by the sum of squared differences."""
    known = pictures[train].reshape(len(train), -1).astype(np.float32)
    share = power[train] / power[train].max(-1, keepdims=True)
    square = np.sum(known**2, axis=1)
    out = np.empty((len(items), power.shape[1]))
    for first in range(0, len(items), 256):
        part = items[first : first + 256]
        asked = pictures[part].reshape(len(part), -1).astype(np.float32)
        nearest = np.argsort(square - 2 * asked @ known.T, axis=1, kind="stable")[:, :count]
        out[first : first + len(part)] = share[nearest].mean(1)
    return out
