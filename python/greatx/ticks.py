# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The base class of the ticks of a data set and of a run in memory."""
from __future__ import annotations

from typing import Dict, Iterator, Mapping, TypeVar

R = TypeVar("R")


class TickRecords(Mapping[str, R]):
    """Maps the names of the sensors that fired at one tick to their records."""

    tick: int
    time_ns: int  #: exact time, rounded to nanoseconds
    time_s: float

    def __init__(self, tick: int, time_ns: int, records: Dict[str, R], where: str = ""):
        self.tick = tick
        self.time_ns = time_ns
        self._records = records
        self._where = where  # beginning of messages

    def __getitem__(self, sensor: str) -> R:
        if sensor not in self._records:
            raise KeyError(
                f"{self._where}sensor {sensor!r} has no record at tick {self.tick}; "
                f"{', '.join(self._records)} have"
            )
        return self._records[sensor]

    def __iter__(self) -> Iterator[str]:
        return iter(self._records)

    def __len__(self) -> int:
        return len(self._records)

    def __repr__(self) -> str:
        return f"<greatx.{type(self).__name__} {self.tick}, {self.time_s:g} s: {', '.join(self._records)}>"
