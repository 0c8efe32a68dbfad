# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Measures of time: wall clock, and processor time of this process and of its workers."""
from __future__ import annotations

import dataclasses
import os
import pathlib
import time
from typing import Dict, Iterable, List, Sequence

import numpy as np


@dataclasses.dataclass
class Spread:
    """The median of several measurements, the least and the largest."""

    median: float
    least: float
    most: float

    @classmethod
    def of(cls, values: Sequence[float]) -> "Spread":
        return cls(float(np.median(values)), float(min(values)), float(max(values)))

    def text(self, digits: int = 0) -> str:
        return f"{self.median:.{digits}f} ({self.least:.{digits}f} to {self.most:.{digits}f})"


def cpu_seconds(processes: Iterable[int] = ()) -> float:
    """Returns the user and system time of this process and of other running ones, in s. That of others is in
    steps of a clock tick (10 ms), and 0 where there is no /proc.
    """
    total = time.process_time()
    for number in processes:
        try:
            fields = pathlib.Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return total


def load() -> float:
    """Returns the mean number of processes that wanted a core in the last minute."""
    return os.getloadavg()[0]


class Parts:
    """Adds up processor time of this thread by part of the work."""

    def __init__(self) -> None:
        self.seconds: Dict[str, List[float]] = {}
        self._begin = 0.0

    def __enter__(self) -> "Parts":
        self._begin = time.thread_time()
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def end(self, part: str) -> None:
        """Ends a part, and begins the next one."""
        now = time.thread_time()
        self.seconds.setdefault(part, []).append(now - self._begin)
        self._begin = now
