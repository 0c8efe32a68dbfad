# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""How good a ranking of beams is. The base station tries the first k beams of the ranking with pilots, and
takes the best of them.
"""
from __future__ import annotations

import numpy as np


def ranking(score: np.ndarray) -> np.ndarray:
    """Returns the beams in descending order of their scores [n, beam]; of equal scores, the lower number
    first."""
    return np.argsort(-score, axis=-1, kind="stable")


def hits(rank: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Returns whether the best beam is among the first k, bool [n, k - 1] for k from 1 to all beams."""
    return np.cumsum(rank == power.argmax(-1)[:, None], axis=-1) > 0


def losses_db(rank: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Returns the loss of power if the best of the first k beams is used in place of the best of all, dB [n,
    k - 1]."""
    tried = np.maximum.accumulate(np.take_along_axis(power, rank, -1), axis=-1)
    best = power.max(-1)[:, None]
    return 10 * np.log10(best / np.maximum(tried, best * 1e-12))


def beams_to_try(loss_db: np.ndarray, limit_db: float) -> int:
    """Returns the least number of beams with a mean loss [n, k - 1] of at most `limit_db`. All beams have a
    loss of 0."""
    return int(np.argmax(loss_db.mean(0) <= limit_db)) + 1


def saved_share(loss_db: np.ndarray, limit_db: float) -> float:
    """Returns the share of the sweep over all beams that is saved at a mean loss of `limit_db`."""
    return 1 - beams_to_try(loss_db, limit_db) / loss_db.shape[1]
