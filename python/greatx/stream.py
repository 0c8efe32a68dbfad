# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A run in memory: every sensor's records as arrays, tick by tick, without files."""
from __future__ import annotations

import json
from fractions import Fraction
from typing import Any, Callable, Dict, Iterator, List

import numpy as np

from .tables import Arrays
from .ticks import TickRecords


class Run:
    """What Simulation.run() gives: an iterator over ticks. Leaving it early is fine."""

    def __init__(self, native: Any, call: Callable[..., Any], tick_rate_hz: Fraction):
        self._native = native
        self._call = call
        self.tick_rate_hz = tick_rate_hz
        #: every sensor's description: name, kind, rate_hz, metadata (as in dataset.json), arrays (name, unit,
        #: description)
        self.sensors: Dict[str, Dict[str, Any]] = {s["name"]: s for s in json.loads(native.sensors())}
        self._names = list(self.sensors)

    def __iter__(self) -> Iterator["RunTick"]:
        return self

    def __next__(self) -> "RunTick":
        packet = self._call(self._native.next)
        if packet is None:
            raise StopIteration
        tick, time_ns, records = packet
        return RunTick(
            self,
            tick,
            time_ns,
            {
                self._names[sensor]: RunRecord(self.sensors[self._names[sensor]], tick, sample, arrays)
                for sensor, sample, arrays in records
            },
        )

    def summary(self) -> Dict[str, Any]:
        """ticks, counters and notes of the run so far, and warnings: what it lost, a sentence each."""
        return json.loads(self._native.summary())


class RunTick(TickRecords["RunRecord"]):
    """The records of one tick by the sensor's name; only of the sensors that fired."""

    def __init__(self, run: Run, tick: int, time_ns: int, records: Dict[str, "RunRecord"]):
        super().__init__(tick, time_ns, records)
        self.time_s = float(tick / run.tick_rate_hz)


class RunRecord(Arrays):
    """What one sensor measured at one tick: record["NAME"], or record.NAME, the arrays that a data set would
    have."""

    def __init__(self, sensor: Dict[str, Any], tick: int, sample: int, arrays: List[np.ndarray]):
        super().__init__(
            (a["name"], a["unit"], a["description"], array) for a, array in zip(sensor["arrays"], arrays)
        )
        self.sensor = sensor
        self.tick = tick
        self.sample = sample  #: the sensor's own count
