# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a scenario in memory and gives the records of every sensor as arrays, tick by tick, without files."""
from __future__ import annotations

import json
from fractions import Fraction
from typing import Any, Callable, Dict, Iterator, List

import numpy as np

from .tables import Arrays
from .ticks import TickRecords


class Run:
    """Iterates over the ticks of a run; returned by Simulation.run(). The iteration may be left early."""

    def __init__(self, native: Any, call: Callable[..., Any], tick_rate_hz: Fraction):
        self._native = native
        self._call = call
        self.tick_rate_hz = tick_rate_hz
        #: descriptions of the sensors by name: name, kind, rate_hz, metadata (as in dataset.json), arrays
        #: (name, unit, description)
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

    def restart(self, sequence: int = 0, first_tick: int = 0) -> None:
        """Goes on with another sequence (or with the same one again), whose records are those of a run of its
        own. It begins sooner, because what the sensors need on the device is there already. What is left of
        the present sequence is lost. Counters of summary() go on.
        """
        self._call(self._native.restart, sequence, first_tick)

    def summary(self) -> Dict[str, Any]:
        """Returns the ticks, counters and notes of the run so far, and its warnings: one sentence for each
        kind of data that the run has lost.
        """
        return json.loads(self._native.summary())


class RunTick(TickRecords["RunRecord"]):
    """Maps the names of the sensors that fired at one tick to their records."""

    def __init__(self, run: Run, tick: int, time_ns: int, records: Dict[str, "RunRecord"]):
        super().__init__(tick, time_ns, records)
        self.time_s = float(tick / run.tick_rate_hz)


class RunRecord(Arrays):
    """Holds the measurement of one sensor at one tick. record["NAME"] or record.NAME is the array that a data
    set would have under this name.
    """

    def __init__(self, sensor: Dict[str, Any], tick: int, sample: int, arrays: List[np.ndarray]):
        super().__init__(
            (a["name"], a["unit"], a["description"], array) for a, array in zip(sensor["arrays"], arrays)
        )
        self.sensor = sensor
        self.tick = tick
        self.sample = sample  #: number of the sensor's sample
