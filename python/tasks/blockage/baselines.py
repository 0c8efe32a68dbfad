# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Probabilities of a blockage without a network: [item, step] has the probability that the line of sight is
blocked within step + 1 ticks."""
from __future__ import annotations

import numpy as np

from tasks.street import geometry


def base_rate(first: np.ndarray, train: np.ndarray, items: np.ndarray, most: int) -> np.ndarray:
    """Returns the shares in the training items, for every item alike."""
    label = first[train]
    share = [np.mean((label > 0) & (label <= step)) for step in range(1, most + 1)]
    return np.broadcast_to(np.array(share), (len(items), most))


def straight_on(link: geometry.Ends, bodies, items: np.ndarray, most: int, step_s: float) -> np.ndarray:
    """Returns what follows from the true boxes and velocities if all go straight on. It knows what no sensor
    says. The sooner a blockage comes, the higher is the score, from 1 for the next tick down to 1 / most; 0
    is none.
    """
    own = geometry.Ends(*(value[items] for value in link))
    boxes = [
        b._replace(**{k: getattr(b, k)[items] for k in ("position_m", "turn", "velocity_m_s")})
        for b in bodies
    ]
    out = np.zeros((len(items), most))
    for step in range(most, 0, -1):
        met = geometry.blocked(own, boxes, step * step_s)
        out[met, step - 1 :] = 1 - (step - 1) / most
    return out
