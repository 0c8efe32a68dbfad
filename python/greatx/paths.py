# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The paths of a channel at a tick, and every channel quantity that is made of them."""
from __future__ import annotations

import json
import math
import warnings
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from .errors import Error
from .tables import Arrays

#: Beyond the last delay, if taps() is not told how many.
TAPS_BEYOND = 8


class Paths:
    """What Simulation.paths() gives. Every array is memory of the engine, not a copy of it.

    Of each path, [path, ...], as in a data set (`paths.arrays` has units and axes): rx, tx (int32), amplitude
    (complex64 [rx_ant, tx_ant], with e^{-j 2 pi f_c tau}), delay (s, absolute), doppler (Hz), departure,
    arrival ((zenith, azimuth) rad, world axes), transfer (complex64 [2, 2], 1/m), id, foliage (m),
    interaction [i], vertex [i, xyz] (m, world; NaN: none), facet, element, object, object_material. Links lie
    one after the other: those of receiver rx and transmitter tx are offsets[rx * T + tx]:offsets[rx * T + tx
    + 1], T transmitters; `link(rx, tx)` are views of them.

    Of ends and links: transmitter_position [tx, 3], receiver_position [rx, 3] (m, world), distance [rx, tx]
    (m).
    """

    def __init__(self, native: Any, receivers: Optional[List[str]]):
        self._native = native
        self.arrays = Arrays(native.take_arrays())
        #: channel, tick, time_s, carrier_hz, counters (path_overflow, ...), notes (how paths were found, what
        #: holds), ...
        self.facts: Dict[str, Any] = json.loads(native.facts())
        self.channel: str = self.facts["channel"]
        self.tick: int = self.facts["tick"]
        self.time_s: float = self.facts["time_s"]
        self.carrier_hz: float = self.facts["carrier_hz"]
        self.transmitters: List[str] = self.facts["transmitters"]
        #: names of the channel's receivers; None: points
        self.receivers = receivers
        #: (receivers, transmitters)
        self.shape: Tuple[int, int] = self.arrays["distance"].shape

    def __getattr__(self, name: str) -> np.ndarray:
        arrays = self.__dict__.get("arrays")
        if arrays is not None and name in arrays:
            return arrays[name]
        raise AttributeError(f"greatx.Paths has no {name!r}")

    def __getitem__(self, name: str) -> np.ndarray:
        return self.arrays[name]

    def __dir__(self) -> List[str]:
        return sorted({*super().__dir__(), *self.arrays})

    def __len__(self) -> int:
        """Number of paths of all links."""
        return len(self.arrays["delay"])

    def link(self, rx: int, tx: int = 0) -> Dict[str, np.ndarray]:
        """All arrays of the paths of one link by name, [path, ...]: views."""
        for what, number, count in (("receiver", rx, self.shape[0]), ("transmitter", tx, self.shape[1])):
            if not 0 <= number < count:
                raise IndexError(f"{self.channel} has {count} {what}s, not one of number {number}")
        first, last = self.arrays["offsets"][rx * self.shape[1] + tx :][:2]
        return {name: array[first:last] for name, array in self.arrays.items() if self._of_paths(name)}

    def _of_paths(self, name: str) -> bool:
        return self.arrays.description(name).startswith("[path")

    def first_delay(self) -> np.ndarray:
        """Of the first path of each link, float64 [rx, tx] s; 0 where there is none."""
        first = np.full(self.shape, np.inf)
        np.minimum.at(first, (self.arrays["rx"], self.arrays["tx"]), self.arrays["delay"])
        return np.where(np.isfinite(first), first, 0.0)

    def cir(self, *, normalize_delays: bool = False) -> Tuple[np.ndarray, np.ndarray]:
        """The impulse response h(t) = sum_i a_i delta(t - tau_i) about the carrier, links filled up with
        zeros to the longest: a complex64 [rx, rx_ant, tx, tx_ant, path], tau float64 [rx, tx, path] in
        seconds, absolute.

        normalize_delays: tau without each link's first_delay(), as from a receiver that is in time with its
        first path. The carrier's phase in a stays absolute."""
        rx, tx, amplitude = self.arrays["rx"], self.arrays["tx"], self.arrays["amplitude"]
        counts = np.diff(self.arrays["offsets"])
        number = np.arange(len(self)) - np.repeat(self.arrays["offsets"][:-1], counts)
        longest = int(counts.max(initial=0))
        a = np.zeros(
            (self.shape[0], amplitude.shape[1], self.shape[1], amplitude.shape[2], longest), np.complex64
        )
        tau = np.zeros((*self.shape, longest))
        a[rx, :, tx, :, number] = amplitude
        tau[rx, tx, number] = self.arrays["delay"] - (self.first_delay()[rx, tx] if normalize_delays else 0.0)
        return a, tau

    def cfr(
        self,
        bandwidth_hz: Optional[float] = None,
        subcarriers: Optional[int] = None,
        *,
        subcarrier_spacing_hz: Optional[float] = None,
        time_samples: Optional[int] = None,
        time_spacing_s: Optional[float] = None,
        select: str = "all",
        normalize_delays: bool = False,
    ) -> np.ndarray:
        """The frequency response, complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier]: H(f) at carrier + (k
        - floor(N/2)) * spacing, absolute delays, nothing normalised unless `normalize_delays` asks for delays
        without each link's first_delay(): H(f) e^{j 2 pi (f - carrier) first_delay}.

        Without arguments it is the channel's grid and the bytes of the data set's `cfr` at this tick.
        `bandwidth_hz` is all of it: the spacing is bandwidth_hz / subcarriers, unless subcarrier_spacing_hz
        is given instead. time_samples, time_spacing_s: samples about the tick, turned by each path's Doppler
        shift. `select`: "all" paths, the "line_of_sight" alone, or the "others".
        A plane wave passes over each array; a warning counts the links that
        Simulation.run() solves element by element (`every_element` of the scenario's effects).
        """
        if bandwidth_hz is not None:
            if subcarrier_spacing_hz is not None:
                raise Error(
                    "subcarrier_spacing_hz: expected one of bandwidth_hz and subcarrier_spacing_hz, found both"
                )
            subcarrier_spacing_hz = bandwidth_hz / (
                self.facts["subcarriers"] if subcarriers is None else max(subcarriers, 1)
            )
        if self.facts["near_links"]:
            why = (
                "have arrays and every_element is on"
                if self.facts["every_element"] == "on"
                else "are nearer than the far field of their arrays, 2 D^2/lambda"
            )
            warnings.warn(
                f"{self.facts['near_links']} links of {self.channel} {why}: "
                "cfr() takes a plane wave over each array, Simulation.run() solves every element",
                stacklevel=2,
            )
        response = self._native.cfr(subcarrier_spacing_hz, subcarriers, time_samples, time_spacing_s, select)
        if not normalize_delays:
            return response
        spacing = (
            self.facts["subcarrier_spacing_hz"] if subcarrier_spacing_hz is None else subcarrier_spacing_hz
        )
        offset = (np.arange(response.shape[-1]) - response.shape[-1] // 2) * spacing
        turn = np.exp(2j * np.pi * self.first_delay()[:, :, None] * offset).astype(np.complex64)
        return response * turn[:, None, :, None, None, :]

    def taps(
        self,
        bandwidth_hz: Optional[float] = None,
        taps: Optional[int] = None,
        *,
        first: int = 0,
        time_samples: int = 1,
        time_spacing_s: float = 1e-3,
    ) -> Arrays:
        """The channel as a filter at a bandwidth: `taps` complex64 [rx, rx_ant, tx, tx_ant, time, tap], tap l
        the absolute delay (first + l) / bandwidth_hz, ideal low-pass; `power_outside` [rx, tx], the share of
        the power that the window leaves out, and `paths_outside` [rx, tx], the number of paths.

        bandwidth_hz: the channel's by default. taps: by default as many as reach 8 beyond the longest delay.
        """
        if bandwidth_hz is None:
            bandwidth_hz = self.facts["subcarriers"] * self.facts["subcarrier_spacing_hz"]
        if taps is None:
            longest = float(self.arrays["delay"].max(initial=0.0)) * bandwidth_hz
            taps = max(1, math.ceil(longest) - first + TAPS_BEYOND) if math.isfinite(longest) else 1
        return Arrays(self._native.taps(bandwidth_hz, first, taps, time_samples, time_spacing_s))

    def statistics(self) -> Arrays:
        """Of every link, [rx, tx]: path_count, line_of_sight, path_gain (sum of the paths' powers, mean over
        ports), mean_delay, delay_spread (s), k_factor, angle spreads (rad), doppler_spread (Hz), as in a data
        set."""
        return Arrays(self._native.statistics())

    def coherence(self, level: float = 0.5) -> Arrays:
        """Of every link, [rx, tx]: `bandwidth` (Hz) and `time` (s) at which the correlation falls to `level`;
        inf: never."""
        return Arrays(self._native.coherence(level))

    def received(
        self,
        power_w: float = 1.0,
        *,
        resistance_ohm: float = 50.0,
        transmit_port: int = 0,
        receive_port: int = 0,
    ) -> Arrays:
        """What arrives at the carrier for power_w watts into one port, [rx, tx]: power_w (fields added),
        mean_power_w (powers added), amplitude, open_circuit_v (V rms, complex), field_v_per_m [rx, tx, xyz]
        (V/m rms, complex, world axes)."""
        named = self._native.received(power_w, resistance_ohm, transmit_port, receive_port)
        return Arrays(
            (name, unit, text, array.view(np.complex128)[..., 0] if "complex" in text else array)
            for name, unit, text, array in named
        )

    def __repr__(self) -> str:
        return (
            f"<greatx.Paths of {self.channel}, tick {self.tick}: {len(self)} paths, {self.shape[0]} receivers, "
            f"{self.shape[1]} transmitters>"
        )
