# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Says how much of a long work is done, and how long the rest will take."""
from __future__ import annotations

import time

#: Seconds from one line to the next.
_PERIOD_S = 10.0


def duration(seconds: float) -> str:
    """Returns a time for people: 42 s, 7 min, 2.5 h."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


class Countdown:
    """Prints a line with the time that is left every ten seconds."""

    def __init__(self, title: str, total: int):
        self.title, self.total = title, total
        self._began = self._shown = time.perf_counter()

    @property
    def seconds(self) -> float:
        """The time since the beginning."""
        return time.perf_counter() - self._began

    def show(self, done: int) -> None:
        """Tells how many of all are done."""
        now = time.perf_counter()
        if done == 0 or now - self._shown < _PERIOD_S:
            return
        self._shown = now
        left = (now - self._began) / done * (self.total - done)
        print(f"{self.title}: {done} of {self.total}, {duration(left)} left", flush=True)
