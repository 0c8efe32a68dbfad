# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""When the line of sight ends, and at which ticks that is a question."""
from __future__ import annotations

import numpy as np

from greatx.errors import Error


def first_blockage(line_of_sight: np.ndarray, most: int) -> np.ndarray:
    """Returns after how many ticks the line of sight of a drive is blocked for the first time, int64 [ticks]:
    1 to `most`, or 0 if it is not within `most` ticks. It is -1, unknown, if the line of sight is blocked
    already, or if the drive ends before `most` ticks have passed.

    line_of_sight  bool [ticks], at evenly spaced ticks
    """
    sight = np.asarray(line_of_sight, bool)
    out = np.full(len(sight), -1)
    for tick in range(len(sight) - most):
        if sight[tick]:
            ahead = np.flatnonzero(~sight[tick + 1 : tick + 1 + most])
            out[tick] = ahead[0] + 1 if len(ahead) else 0
    return out


def onsets(line_of_sight: np.ndarray) -> np.ndarray:
    """Returns the ticks of a drive at which the line of sight is blocked for the first time after a tick with
    line of sight."""
    sight = np.asarray(line_of_sight, bool)
    return np.flatnonzero(sight[:-1] & ~sight[1:]) + 1


def check_steps(tick: np.ndarray, drive: np.ndarray) -> int:
    """Returns the ticks from one item of a drive to the next. Raises Error unless all are equal, because "k
    ticks ahead" would have no meaning."""
    steps = np.unique(np.diff(tick)[np.diff(drive) == 0])
    if len(steps) != 1:
        raise Error(
            f"expected records of all sensors at even steps of ticks, found steps of {steps.tolist()}"
        )
    return int(steps[0])
