# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What anything that learns has to beat: the mean of the training positions, and nearest neighbours."""
from __future__ import annotations

from typing import Tuple

import numpy as np


def mean_errors(train_m: np.ndarray, test_m: np.ndarray) -> np.ndarray:
    """Returns the distances [n] of test positions from the mean of the training positions, m."""
    return np.linalg.norm(test_m - train_m.mean(0), axis=1)


def neighbours(train: np.ndarray, query: np.ndarray, most: int) -> np.ndarray:
    """Returns the indices [queries, most] of the nearest training features, nearest first, by Euclidean
    distance; of equally near ones the first. Features are [n, values].
    """
    most = min(most, len(train))
    norms = np.einsum("ij,ij->i", train, train, dtype=np.float64)
    out = np.empty((len(query), most), np.int64)
    for first in range(0, len(query), 256):
        part = query[first : first + 256]
        # |q - t|^2 less |q|^2, which is the same for all t
        distance = norms - 2 * (part.astype(np.float32) @ train.T.astype(np.float32)).astype(np.float64)
        out[first : first + 256] = np.argsort(distance, axis=1, kind="stable")[:, :most]
    return out


def neighbour_positions(order: np.ndarray, train_m: np.ndarray) -> np.ndarray:
    """Returns the mean positions of the nearest 1, 2, ... neighbours, [queries, most, 3]."""
    count = np.arange(1, order.shape[1] + 1)
    return np.cumsum(train_m[order], axis=1) / count[None, :, None]


def neighbour_errors(
    features: Tuple[np.ndarray, np.ndarray, np.ndarray],
    positions_m: Tuple[np.ndarray, np.ndarray, np.ndarray],
    most: int,
) -> Tuple[np.ndarray, int]:
    """Returns the errors [test records] of the mean of the k nearest neighbours, m, and k, which has the
    least mean error on the validation part. Both tuples are those of training, validation and test.
    """
    train, validation, test = features
    train_m, validation_m, test_m = positions_m
    found = neighbour_positions(neighbours(train, validation, most), train_m)
    errors = np.linalg.norm(found - validation_m[:, None], axis=2).mean(0)
    k = int(np.argmin(errors)) + 1
    found = neighbour_positions(neighbours(train, test, k), train_m)[:, -1]
    return np.linalg.norm(found - test_m, axis=1), k
