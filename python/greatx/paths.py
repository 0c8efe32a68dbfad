# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Holds the paths of a channel at a tick, and computes channel quantities from them."""

from __future__ import annotations

import json
import math
import warnings
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import gradients
from .errors import Error
from .gradients import Changes, Jacobian, Request, Variation
from .tables import Arrays

#: Number of taps beyond the longest delay, if the caller of taps() gives no number.
TAPS_BEYOND = 8


class Paths:
    """Holds the result of Simulation.paths(). The arrays are memory of the engine and no copies.

    Arrays of the paths, [path, ...], are those of a data set (`paths.arrays` has units and axes): rx, tx
    (int32), amplitude (complex64 [rx_ant, tx_ant], including e^{-j 2 pi f_c tau}), delay (s, absolute),
    doppler (Hz), departure, arrival ((zenith, azimuth) rad, world axes), transfer (complex64 [2, 2], 1/m),
    id, foliage (m), interaction [i], vertex [i, xyz] (m, world; NaN: none), facet, element, object,
    object_material. Links are consecutive: with T transmitters, the paths of receiver rx and transmitter tx
    are offsets[rx * T + tx]:offsets[rx * T + tx + 1]. `link(rx, tx)` returns views of them.

    Arrays of the ends and links are transmitter_position [tx, 3], receiver_position [rx, 3] (m, world) and
    distance [rx, tx] (m).
    """

    def __init__(self, native: Any, receivers: Optional[List[str]]):
        self._native = native
        self.arrays = Arrays(native.take_arrays())
        #: channel, tick, time_s, carrier_hz, counters (path_overflow, ...), notes (how the paths were found,
        #: which guarantee holds), ...
        self.facts: Dict[str, Any] = json.loads(native.facts())
        self.channel: str = self.facts["channel"]
        self.tick: int = self.facts["tick"]
        self.time_s: float = self.facts["time_s"]
        self.carrier_hz: float = self.facts["carrier_hz"]
        self.transmitters: List[str] = self.facts["transmitters"]
        #: names of the channel's receivers; None if the receivers are points
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
        """Returns the number of paths of all links."""
        return len(self.arrays["delay"])

    def link(self, rx: int, tx: int = 0) -> Dict[str, np.ndarray]:
        """Returns views of all arrays of the paths of one link by name, [path, ...]."""
        for what, number, count in (("receiver", rx, self.shape[0]), ("transmitter", tx, self.shape[1])):
            if not 0 <= number < count:
                raise IndexError(f"{self.channel} has {count} {what}s, not one of number {number}")
        first, last = self.arrays["offsets"][rx * self.shape[1] + tx :][:2]
        return {name: array[first:last] for name, array in self.arrays.items() if self._of_paths(name)}

    def _of_paths(self, name: str) -> bool:
        return self.arrays.description(name).startswith("[path")

    def first_delay(self) -> np.ndarray:
        """Returns the delay of the first path of each link, float64 [rx, tx] s; 0 for links without paths."""
        first = np.full(self.shape, np.inf)
        np.minimum.at(first, (self.arrays["rx"], self.arrays["tx"]), self.arrays["delay"])
        return np.where(np.isfinite(first), first, 0.0)

    def cir(self, *, normalize_delays: bool = False) -> Tuple[np.ndarray, np.ndarray]:
        """Returns the impulse response h(t) = sum_i a_i delta(t - tau_i) about the carrier: a, complex64 [rx,
        rx_ant, tx, tx_ant, path], and tau, float64 [rx, tx, path] in seconds, absolute. Links are padded with
        zeros to the longest one.

        If normalize_delays is set, subtracts first_delay() of each link from tau, as in a receiver that is
        synchronised to the first path. The carrier's phase in a stays absolute."""
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
        parameters: Optional[Mapping[str, Any]] = None,
    ) -> Any:
        """Returns the frequency response H(f), complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier], at the
        frequencies carrier + (k - floor(N/2)) * spacing. Delays are absolute, and nothing is normalised. If
        `normalize_delays` is set, subtracts first_delay() of each link from the delays:
        H(f) e^{j 2 pi (f - carrier) first_delay}.

        Without arguments, the grid is the channel's, and the bytes are those of the data set's `cfr` at this
        tick. `bandwidth_hz` is the total bandwidth: the spacing is bandwidth_hz / subcarriers.
        subcarrier_spacing_hz can be given instead. time_samples and time_spacing_s describe samples from the
        tick on, in which the Doppler shift of each path turns its phase. `select` is "all", "line_of_sight"
        (only this path) or "others".

        The response takes one path for all elements of an array. A warning gives the number of links that
        Simulation.run() solves element by element (`every_element` of the scenario's effects).

        `parameters` maps names of parameters() to other values, at which the same paths are solved again
        (docs/gradients.md). Then H is complex128, or, if a value is a torch tensor, a tensor that PyTorch can
        differentiate by its own convention: complex64 if all tensors are single, else complex128. A warning
        counts the paths that do not exist at these values.
        """
        request = self._request(
            bandwidth_hz, subcarriers, subcarrier_spacing_hz, time_samples, time_spacing_s, select
        )
        self._warn_of_near_links()
        if parameters is not None:
            if normalize_delays:
                raise Error("normalize_delays: expected False with parameters, found True")
            return gradients.response(self._native, self.channel, request, parameters)
        response = self._native.cfr(*request)
        if not normalize_delays:
            return response
        spacing = self.facts["subcarrier_spacing_hz"] if request[0] is None else request[0]
        offset = (np.arange(response.shape[-1]) - response.shape[-1] // 2) * spacing
        turn = np.exp(2j * np.pi * self.first_delay()[:, :, None] * offset).astype(np.complex64)
        return response * turn[:, None, :, None, None, :]

    def parameters(self) -> Arrays:
        """Returns the values of all parameters by which the paths can be differentiated, by name, with units:
        "material:NAME.permittivity", "transmitter.position" [tx, 3], "receiver.gain" [rx, port], "carrier",
        ... (docs/gradients.md). Orientations are those of the antennas at attitude 0.
        """
        return gradients.parameters_of(self._native)

    def vary(self, parameters: Optional[Mapping[str, Any]] = None) -> Variation:
        """Returns the same paths at other values of parameters. Its `facts` count those that do not exist
        there, and its quantities() are powers, delays and spreads."""
        return gradients.vary(self._native, self.channel, parameters)

    def jacobian(
        self,
        names: Sequence[str],
        of: str = "cfr",
        *,
        parameters: Optional[Mapping[str, Any]] = None,
        bandwidth_hz: Optional[float] = None,
        subcarriers: Optional[int] = None,
        subcarrier_spacing_hz: Optional[float] = None,
        time_samples: Optional[int] = None,
        time_spacing_s: Optional[float] = None,
        select: str = "all",
    ) -> Jacobian:
        """Returns exact derivatives by the named parameters, at the values `parameters` (by default those of
        the scenario): `values` [..., column], `columns` and `units`.

        `of` is "cfr" (complex128 [rx, rx_ant, tx, tx_ant, time, subcarrier, column], on the grid of the other
        arguments as in cfr()), "power" and "delay" (float64 [path, column]), or "path_gain", "mean_delay" and
        "delay_spread" (float64 [rx, tx, column]).

        A parameter of the ends has columns for the link's own end only: "receiver.position" has three, "x",
        "y" and "z" of the receiver of each link. "receiver.slant" has one, of the port's own polarization.
        "receiver.gain" has one, the complex derivative by the gain of the port itself.
        """
        request = self._request(
            bandwidth_hz, subcarriers, subcarrier_spacing_hz, time_samples, time_spacing_s, select
        )
        if of == "cfr":
            self._warn_of_near_links()
        return self.vary(parameters).jacobian(request, names, of)

    def gradient(
        self,
        names: Sequence[str],
        cotangent: np.ndarray,
        *,
        parameters: Optional[Mapping[str, Any]] = None,
        bandwidth_hz: Optional[float] = None,
        subcarriers: Optional[int] = None,
        subcarrier_spacing_hz: Optional[float] = None,
        time_samples: Optional[int] = None,
        time_spacing_s: Optional[float] = None,
        select: str = "all",
    ) -> Dict[str, np.ndarray]:
        """Returns the gradient of a real loss L by the named parameters, each in the shape of the parameter,
        from cotangent = dL/d Re H + j dL/d Im H in the shape of cfr(). Besides the slopes of the paths it
        costs about twice as much as H, whatever the number of parameters.
        """
        names = [names] if isinstance(names, str) else list(names)
        request = self._request(
            bandwidth_hz, subcarriers, subcarrier_spacing_hz, time_samples, time_spacing_s, select
        )
        self._warn_of_near_links()
        return dict(zip(names, self.vary(parameters).gradient(request, names, cotangent)))

    def changes_since(self, before: "Paths") -> Changes:
        """Counts the paths of each link that were `born` since `before`, `died` or were `kept`, int64 [rx,
        tx], by their identities: where a path is born or dies, the channel jumps."""
        if self.shape != before.shape:
            raise Error(f"changes_since: expected paths of {before.shape} links, found {self.shape}")
        counts = np.zeros((3, self.shape[0] * self.shape[1]), np.int64)
        for link in range(counts.shape[1]):
            now, then = (
                set(of.arrays["id"][slice(*of.arrays["offsets"][link : link + 2])].tolist())
                for of in (self, before)
            )
            counts[:, link] = len(now - then), len(then - now), len(now & then)
        return Changes(*counts.reshape(3, *self.shape))

    def _request(
        self,
        bandwidth_hz: Optional[float],
        subcarriers: Optional[int],
        subcarrier_spacing_hz: Optional[float],
        time_samples: Optional[int],
        time_spacing_s: Optional[float],
        select: str,
    ) -> Request:
        if bandwidth_hz is not None:
            if subcarrier_spacing_hz is not None:
                raise Error(
                    "subcarrier_spacing_hz: expected one of bandwidth_hz and subcarrier_spacing_hz, "
                    "found both"
                )
            subcarrier_spacing_hz = bandwidth_hz / (
                self.facts["subcarriers"] if subcarriers is None else max(subcarriers, 1)
            )
        return subcarrier_spacing_hz, subcarriers, time_samples, time_spacing_s, select

    def _warn_of_near_links(self) -> None:
        if self.facts["near_links"]:
            why = (
                "have arrays and every_element is on"
                if self.facts["every_element"] == "on"
                else "are nearer than the far field of their arrays, 2 D^2/lambda"
            )
            warnings.warn(
                f"{self.facts['near_links']} links of {self.channel} {why}: "
                "cfr() takes one path for all elements of an array, Simulation.run() solves every element",
                stacklevel=3,
            )

    def taps(
        self,
        bandwidth_hz: Optional[float] = None,
        taps: Optional[int] = None,
        *,
        first: int = 0,
        time_samples: int = 1,
        time_spacing_s: float = 1e-3,
    ) -> Arrays:
        """Returns the channel as a discrete filter after an ideal low-pass of a bandwidth: `taps` complex64
        [rx, rx_ant, tx, tx_ant, time, tap], where tap l has the absolute delay (first + l) / bandwidth_hz.
        Also returns `power_outside` and `paths_outside` [rx, tx], the share of the power and the number of
        the paths whose delays lie outside the window of taps.

        bandwidth_hz is the channel's by default. By default, the taps reach 8 taps beyond the longest delay.
        """
        if bandwidth_hz is None:
            bandwidth_hz = self.facts["subcarriers"] * self.facts["subcarrier_spacing_hz"]
        if taps is None:
            longest = float(self.arrays["delay"].max(initial=0.0)) * bandwidth_hz
            taps = max(1, math.ceil(longest) - first + TAPS_BEYOND) if math.isfinite(longest) else 1
        return Arrays(self._native.taps(bandwidth_hz, first, taps, time_samples, time_spacing_s))

    def statistics(self) -> Arrays:
        """Returns the statistics of every link, [rx, tx], as in a data set: path_count, line_of_sight,
        path_gain (sum of the paths' powers, mean over ports), path_gain_deviation (standard deviation of
        path_gain by the draws of scatterings), mean_delay, delay_spread (s), k_factor, angle spreads (rad),
        doppler_spread (Hz).
        """
        return Arrays(self._native.statistics())

    def coherence(self, level: float = 0.5) -> Arrays:
        """Returns `bandwidth` (Hz) and `time` (s) of every link, [rx, tx], at which the correlation falls to
        `level`. inf means that it never falls so far.
        """
        return Arrays(self._native.coherence(level))

    def received(
        self,
        power_w: float = 1.0,
        *,
        resistance_ohm: float = 50.0,
        transmit_port: int = 0,
        receive_port: int = 0,
    ) -> Arrays:
        """Returns the received quantities at the carrier, [rx, tx], if power_w watts enter one transmitting
        port: power_w (fields of the paths added), mean_power_w (powers added), amplitude (complex),
        open_circuit_v (V rms, complex) and field_v_per_m [rx, tx, xyz] (V/m rms, complex, world axes).
        """
        named = self._native.received(power_w, resistance_ohm, transmit_port, receive_port)
        return Arrays(
            (name, unit, text, array.view(np.complex128)[..., 0] if "complex" in text else array)
            for name, unit, text, array in named
        )

    def __repr__(self) -> str:
        return (
            f"<greatx.Paths of {self.channel}, tick {self.tick}: {len(self)} paths, "
            f"{self.shape[0]} receivers, {self.shape[1]} transmitters>"
        )
