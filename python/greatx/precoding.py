# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes precoders, combiners, codebooks and what they give, from channels as greatx stores them
(docs/precoding.md). Needs NumPy alone.

A channel matrix has the last axes [rx_ant, tx_ant]; `matrices` takes them out of the arrays of a data set
and of `Paths.cfr()`. All other axes are in front, and every function works on all of them at once. A
transmitter sends x = W s, where the columns of W [tx_ant, stream] are precoders and the streams s have a
power of 1 W. A receiver gets y = H x + n. Powers and noise are in watts, gains are ratios of powers, and
rates are in bit/s/Hz. Everything is computed in complex128.
"""
from __future__ import annotations

from typing import Any, NamedTuple, Tuple

import numpy as np

from .errors import Error

BOLTZMANN = 1.380649e-23  #: J/K (exact, SI)


def _matrix(h: Any, name: str, axes: str, least: int = 2) -> np.ndarray:
    array = np.asarray(h)
    if array.ndim < least or not np.issubdtype(array.dtype, np.number):
        raise Error(f"{name}: expected numbers [..., {axes}], found {array.dtype} {list(array.shape)}")
    return array.astype(np.complex128)


def _hermitian(a: np.ndarray) -> np.ndarray:
    return np.conj(np.swapaxes(a, -1, -2))


def matrices(cfr: Any, tx: int = 0) -> np.ndarray:
    """Returns the channels of all receivers to transmitter `tx`, complex128 [..., time, subcarrier, rx,
    rx_ant, tx_ant], from the array `cfr` of a data set or of Paths, [..., rx, rx_ant, tx, tx_ant, time,
    subcarrier]. The receivers are the users of the functions below.
    """
    h = np.asarray(cfr)
    if h.ndim < 6:
        raise Error(f"cfr: expected [..., rx, rx_ant, tx, tx_ant, time, subcarrier], found {list(h.shape)}")
    if not 0 <= tx < h.shape[-4]:
        raise IndexError(f"tx: expected 0 to {h.shape[-4] - 1}, found {tx}")
    of_tx = h[..., tx, :, :, :]  # [..., rx, rx_ant, tx_ant, time, subcarrier]
    return np.moveaxis(of_tx, (-2, -1), (-5, -4)).astype(np.complex128)


def noise_w(bandwidth_hz: float, noise_figure_db: float = 0.0) -> float:
    """Returns the thermal noise k 290 K B F of a receive port, W. Of a subcarrier, B is its spacing."""
    return BOLTZMANN * 290.0 * bandwidth_hz * 10.0 ** (noise_figure_db / 10.0)


# The next functions make codebooks.


def dft(elements: int, oversampling: int = 1) -> np.ndarray:
    """Returns the DFT codebook of a line of elements, complex128 [beam, element] with oversampling * elements
    unit-norm beams: w_b[m] = exp(j 2 pi b m/(oversampling elements))/sqrt(elements). Without oversampling the
    beams are orthogonal (D. J. Love, R. W. Heath, IEEE Trans. Commun. 51(7), 2003).
    """
    if elements < 1 or oversampling < 1:
        raise Error(f"dft: expected 1 or more elements and beams, found {elements} and {oversampling}")
    b, m = np.arange(oversampling * elements)[:, None], np.arange(elements)
    return np.exp(2j * np.pi * (b * m % (oversampling * elements)) / (oversampling * elements)) / np.sqrt(
        elements
    )


def dft_panel(rows: int, columns: int, oversampling: Tuple[int, int] = (1, 1)) -> np.ndarray:
    """Returns the DFT codebook of a panel with one polarization, [beam, element], in greatx's order: element
    = row * columns + column, beam = row_beam * (oversampling[1] columns) + column_beam. A beam is the product
    of one of the rows and one of the columns.
    """
    return np.kron(dft(rows, oversampling[0]), dft(columns, oversampling[1]))


def beam_cosine(beam: Any, elements: int, oversampling: int = 1, spacing_wl: float = 0.5) -> np.ndarray:
    """Returns the cosine between the axis of a line of elements and the direction in which a beam of `dft`
    adds up, from -0.5/spacing_wl to 0.5/spacing_wl. For greatx's panel (plane yz) the axis of the columns is
    +y and that of the rows +z.

    An element at distance d along the axis is ahead by 2 pi d cos/lambda (TR 38.901, eq. 7.5-22), so beam b
    makes up for it where cos = -b/(oversampling elements spacing_wl), a whole number of turns aside.
    """
    turns = np.asarray(beam) / (oversampling * elements)
    return (np.floor(turns + 0.5) - turns) / spacing_wl


def cross_polarized(codebook: Any, phases: int = 4) -> np.ndarray:
    """Returns beams of cross-polarized elements for a codebook [beam, element] of one polarization, [beam *
    phases + n, element * 2 + polarization]: both polarizations send the beam, the second one turned by 2 pi
    n/phases, as in Type I but for any panel.
    """
    book = _matrix(codebook, "codebook", "beam, element")
    return np.kron(
        book, np.stack([np.ones(phases), np.exp(2j * np.pi * np.arange(phases) / phases)], -1)
    ) / np.sqrt(2)


#: Oversampling of Type I: along N1, and along N2 if N2 > 1 (TS 38.214, Table 5.2.2.2.1-2).
TYPE1_OVERSAMPLING = 4
#: (N1, N2) of the Type I single-panel codebook (TS 38.214, Table 5.2.2.2.1-2).
TYPE1_PANELS = (
    *((2, 1), (2, 2), (4, 1), (3, 2), (6, 1), (4, 2), (8, 1)),
    *((4, 3), (6, 2), (12, 1), (4, 4), (8, 2), (16, 1)),
)


class Codebook(NamedTuple):
    """Precoders and the indices by which the standard calls them."""

    precoders: np.ndarray  #: complex128 [entry, port, layer]; the power of an entry's layers adds up to 1
    indices: np.ndarray  #: int64 [entry, index]
    names: Tuple[str, ...]  #: of the indices, ("i11", "i12", "i13", "i2")


def _offsets(n1: int, n2: int, o1: int, o2: int) -> Tuple[Tuple[int, int], ...]:
    """Returns (k1, k2) for each i_1,3 of two layers (TS 38.214, Table 5.2.2.2.1-3)."""
    if n2 == 1:
        return tuple((i * o1, 0) for i in range(min(n1, 4)))
    return ((0, 0), (o1, 0), (0, o2), (o1, o2) if n1 == n2 else (2 * o1, 0))


def type1(n1: int, n2: int = 1, layers: int = 1) -> Codebook:
    """Returns the Type I single-panel codebook of 3GPP TS 38.214 (V17), 5.2.2.2.1, codebookMode 1, for
    N1 x N2 cross-polarized elements and one or two layers (Tables 5.2.2.2.1-5 and -6); (1, 1) gives that of
    two ports (Table 5.2.2.2.1-1, whose index is called i2 here). Ports are in greatx's order of an array with
    N1 columns, N2 rows and polarization `slant` or `vh`: (row * N1 + column) * 2 + polarization.

    The standard counts ports as polarization * N1 N2 + column * N2 + row.
    """
    if layers not in (1, 2):
        raise Error(f"type1: expected 1 or 2 layers, found {layers}")
    if (n1, n2) == (1, 1):
        phases = np.array([1, 1j, -1, -1j]) if layers == 1 else np.array([1, 1j])
        upper = np.ones((len(phases), 1, layers))
        signs = np.array([1, -1])[:layers]
        lower = phases[:, None, None] * signs
        precoders = np.concatenate([upper, lower], axis=1) / np.sqrt(2 * layers)
        return Codebook(precoders, np.arange(len(phases))[:, None], ("i2",))
    if (n1, n2) not in TYPE1_PANELS:
        raise Error(f"type1: expected N1, N2 of TS 38.214, one of {TYPE1_PANELS}, found {(n1, n2)}")
    o1, o2 = TYPE1_OVERSAMPLING, TYPE1_OVERSAMPLING if n2 > 1 else 1
    # v[l, m] in greatx's order of elements: exp(j 2 pi l column/(O1 N1)) exp(j 2 pi m row/(O2 N2)).
    along_columns, along_rows = dft(n1, o1) * np.sqrt(n1), dft(n2, o2) * np.sqrt(n2)
    v = np.einsum("mr,lc->lmrc", along_rows, along_columns).reshape(n1 * o1, n2 * o2, n1 * n2)
    offsets = ((0, 0),) if layers == 1 else _offsets(n1, n2, o1, o2)
    phases = 1j ** np.arange(4 if layers == 1 else 2)
    entries, indices = [], []
    for l in range(n1 * o1):
        for m in range(n2 * o2):
            for i13, (k1, k2) in enumerate(offsets):
                beams = [v[l, m], v[(l + k1) % (n1 * o1), (m + k2) % (n2 * o2)]][:layers]
                for n, phase in enumerate(phases):
                    columns = [
                        np.stack([beam, sign * phase * beam], -1).reshape(-1)  # polarization runs fastest
                        for beam, sign in zip(beams, (1, -1))
                    ]
                    entries.append(np.stack(columns, -1) / np.sqrt(layers * 2 * n1 * n2))
                    indices.append((l, m, n) if layers == 1 else (l, m, i13, n))
    names = ("i11", "i12", "i2") if layers == 1 else ("i11", "i12", "i13", "i2")
    return Codebook(np.array(entries), np.array(indices), names)


# The next functions choose beams.


def beam_gains(h: Any, codebook: Any, receive_codebook: Any = None) -> np.ndarray:
    """Returns the gain of every beam for h [..., rx_ant, tx_ant] and a codebook [beam, tx_ant]: |H w_b|^2
    [..., beam], the power that the receiver collects with all its antennas (maximum-ratio combining). With a
    receive_codebook [rx_beam, rx_ant] of combiners it is |u^H H w|^2, [..., rx_beam, beam].
    """
    h = _matrix(h, "h", "rx_ant, tx_ant")
    book = _matrix(codebook, "codebook", "beam, tx_ant")
    if book.ndim != 2 or book.shape[1] != h.shape[-1]:
        raise Error(f"codebook: expected [beam, {h.shape[-1]}], found {list(book.shape)}")
    through = h @ book.T
    if receive_codebook is None:
        return np.sum(np.abs(through) ** 2, axis=-2)
    receive = _matrix(receive_codebook, "receive_codebook", "rx_beam, rx_ant")
    if receive.ndim != 2 or receive.shape[1] != h.shape[-2]:
        raise Error(f"receive_codebook: expected [rx_beam, {h.shape[-2]}], found {list(receive.shape)}")
    return np.abs(np.conj(receive) @ through) ** 2


class Labels(NamedTuple):
    """The best beams of each receiver, the best one first."""

    beam: np.ndarray  #: int64 [..., rx, k]: indices into the codebook; -1: no power reaches the receiver
    gain: np.ndarray  #: float64 [..., rx, k]: mean of |H w|^2 over time and subcarriers


def best_beams(cfr: Any, codebook: Any, tx: int = 0, k: int = 1) -> Labels:
    """Returns the k beams of `codebook` [beam, tx_ant] that bring most power to each receiver, from the array
    `cfr` of a data set or of Paths. One beam serves all times and subcarriers of a record. Of equal beams the
    one with the lower index comes first.
    """
    h = matrices(cfr, tx)
    gains = beam_gains(h, codebook).mean(axis=(-4, -3))  # over time and subcarrier
    if not 1 <= k <= gains.shape[-1]:
        raise Error(f"k: expected 1 to {gains.shape[-1]} beams, found {k}")
    order = np.argsort(-gains, axis=-1, kind="stable")[..., :k]
    gain = np.take_along_axis(gains, order, axis=-1)
    return Labels(np.where(gain > 0, order, -1), gain)


# The next functions make precoders. A row of h is the channel of one stream.


def combined(h: Any) -> Tuple[np.ndarray, np.ndarray]:
    """Returns the strongest stream of each user: rows u^H H [..., user, tx_ant] and combiners u [..., user,
    rx_ant] for h [..., user, rx_ant, tx_ant], u being the left singular vector of the largest singular value.
    The rows are the channels that `maximum_ratio`, `zero_forcing` and `regularized` take.
    """
    h = _matrix(h, "h", "user, rx_ant, tx_ant", 3)
    u = np.linalg.svd(h, full_matrices=False)[0][..., :, 0]
    return np.einsum("...kr,...krt->...kt", np.conj(u), h), u


def _unit_columns(w: np.ndarray) -> np.ndarray:
    norm = np.linalg.norm(w, axis=-2, keepdims=True)
    return np.divide(w, norm, out=np.zeros_like(w), where=norm > 0)


def maximum_ratio(h: Any) -> np.ndarray:
    """Returns w_k = h_k^H/|h_k|, [..., tx_ant, stream] with unit columns, for rows h [..., stream, tx_ant]:
    the largest gain |h_k|^2 for every stream, whatever it does to the others (T. K. Y. Lo, "Maximum Ratio
    Transmission", IEEE Trans. Commun. 47(10), 1999). A stream without channel gets zeros.
    """
    return _unit_columns(_hermitian(_matrix(h, "h", "stream, tx_ant")))


def zero_forcing(h: Any) -> np.ndarray:
    """Returns the columns of H^H (H H^H)^-1, scaled to unit norm, [..., tx_ant, stream], for rows h [...,
    stream, tx_ant]: no stream reaches another's receiver (Q. H. Spencer, A. L. Swindlehurst, M. Haardt, IEEE
    Trans. Signal Process. 52(2), 2004). Raises Error if the rows are linearly dependent, as those of a user
    without a path are.
    """
    h = _matrix(h, "h", "stream, tx_ant")
    streams, ports = h.shape[-2:]
    if streams > ports:
        raise Error(f"h: expected at most as many streams as antennas, found {streams} and {ports}")
    u, s, vh = np.linalg.svd(h, full_matrices=False)
    lost = s[..., -1] <= s[..., 0] * ports * np.finfo(float).eps
    if np.any(lost):
        raise Error(f"h: expected independent rows, found {np.count_nonzero(lost)} dependent matrices")
    return _unit_columns((_hermitian(vh) / s[..., None, :]) @ _hermitian(u))


def regularized(h: Any, noise_w: Any, power_w: Any) -> np.ndarray:
    """Returns the columns of H^H (H H^H + K noise/power I)^-1, scaled to unit norm, [..., tx_ant, stream],
    for K rows h [..., stream, tx_ant]: regularized zero-forcing (C. B. Peel, B. M. Hochwald, A. L.
    Swindlehurst, IEEE Trans. Commun. 53(1), 2005), also called MMSE precoding. noise_w is the noise of a
    receiver, and power_w the power of all streams. It approaches zero-forcing without noise, and maximum
    ratio in much of it.
    """
    h = _matrix(h, "h", "stream, tx_ant")
    load = np.asarray(noise_w, float) / np.asarray(power_w, float) * h.shape[-2]
    if not np.all(load > 0):
        raise Error("regularized: expected noise and power above 0 W; without noise use zero_forcing")
    gram = h @ _hermitian(h) + load[..., None, None] * np.eye(h.shape[-2])
    return _unit_columns(_hermitian(np.linalg.solve(gram, h)))


def scaled(w: Any, power_w: Any) -> np.ndarray:
    """Returns w [..., tx_ant, stream] with columns of unit norm times the root of their power. power_w is the
    power of each stream [..., stream], W; a number is the power of all, in equal parts.
    """
    w = _matrix(w, "w", "tx_ant, stream")
    power = np.asarray(power_w, float)
    if power.ndim == 0:
        power = np.full(w.shape[-1], power / w.shape[-1])
    if np.any(power < 0):
        raise Error("power_w: expected 0 W or more")
    return w * np.sqrt(power)[..., None, :]


# The next functions say what a single user's streams can carry.


class Streams(NamedTuple):
    """Independent streams of one link."""

    combiner: np.ndarray  #: complex128 [..., rx_ant, stream], unit columns: U
    gain: np.ndarray  #: float64 [..., stream], descending: squares of the singular values
    precoder: np.ndarray  #: complex128 [..., tx_ant, stream], unit columns: V


def svd(h: Any) -> Streams:
    """Returns the singular value decomposition H = U sqrt(gain) V^H of h [..., rx_ant, tx_ant]: with V as
    precoder and U^H as combiner the streams do not meet (E. Telatar, European Trans. Telecommun. 10(6),
    1999).
    """
    u, s, vh = np.linalg.svd(_matrix(h, "h", "rx_ant, tx_ant"), full_matrices=False)
    return Streams(u, s**2, _hermitian(vh))


def water_filling(gain: Any, power_w: Any, noise_w: Any) -> np.ndarray:
    """Returns the powers p [..., stream] of sum power_w that carry most over streams of power gains [...,
    stream]: p_i = max(0, level - noise_w/gain_i) (T. M. Cover, J. A. Thomas, "Elements of Information
    Theory", 2nd ed., 9.4). The level is found exactly, by the number of streams under water. Where no stream
    has a gain, all powers are 0.
    """
    gain = np.asarray(gain, float)
    power, noise = np.asarray(power_w, float)[..., None], np.asarray(noise_w, float)[..., None]
    if np.any(gain < 0) or np.any(power < 0) or not np.all(noise > 0):
        raise Error("water_filling: expected gains and power of 0 or more and noise above 0")
    ground = np.divide(noise, gain, out=np.full(np.broadcast(noise, gain).shape, np.inf), where=gain > 0)
    ascending = np.sort(ground, axis=-1)
    count = np.arange(1, gain.shape[-1] + 1)
    levels = (power + np.cumsum(ascending, axis=-1)) / count
    wet = np.maximum(np.count_nonzero(levels > ascending, axis=-1), 1)
    level = np.take_along_axis(levels, wet[..., None] - 1, axis=-1)
    return np.where(
        np.isfinite(ground), np.maximum(np.where(np.isfinite(level), level, 0.0) - ground, 0.0), 0.0
    )


def capacity(h: Any, power_w: Any, noise_w: Any) -> np.ndarray:
    """Returns the capacity of links h [..., rx_ant, tx_ant] that both ends know, bit/s/Hz [...]: the sum of
    log2(1 + p gain/noise) over the streams of `svd`, with the powers of `water_filling`.
    """
    gain = svd(h).gain
    p = water_filling(gain, power_w, noise_w)
    return np.sum(np.log2(1.0 + p * gain / np.asarray(noise_w, float)[..., None]), axis=-1)


def rate(h: Any, w: Any, noise_w: Any) -> np.ndarray:
    """Returns log2 det(I + H W W^H H^H/noise), bit/s/Hz [...], of one user's streams with precoders w [...,
    tx_ant, stream] (their powers included) and the best receiver; h [..., rx_ant, tx_ant].
    """
    through = _matrix(h, "h", "rx_ant, tx_ant") @ _matrix(w, "w", "tx_ant, stream")
    gram = _hermitian(through) @ through / np.asarray(noise_w, float)[..., None, None]
    return np.linalg.slogdet(np.eye(gram.shape[-1]) + gram)[1] / np.log(2.0)


def best_entry(
    h: Any, codebook: Codebook, power_w: float, noise_w: float, over: Tuple[int, ...] = ()
) -> Tuple[np.ndarray, np.ndarray]:
    """Returns the entry of a codebook such as `type1` that gives h [..., rx_ant, tx_ant] the largest `rate`,
    int64 [...], and this rate. `over` names axes of h over which one entry serves all and the rate is their
    mean, such as (0, 1) for the time and the subcarriers of `matrices`.
    """
    if any(not 0 <= axis < np.ndim(h) - 2 for axis in over):
        raise Error(f"over: expected axes from 0 to {np.ndim(h) - 3}, found {over}")
    rates = np.stack(
        [np.mean(rate(h, np.sqrt(power_w) * w, noise_w), axis=over) for w in codebook.precoders], axis=-1
    )
    best = np.argmax(rates, axis=-1)
    return best, np.take_along_axis(rates, best[..., None], axis=-1)[..., 0]


# The next functions say what several users get.


def sinr(h: Any, w: Any, noise_w: Any, combiners: Any = None) -> np.ndarray:
    """Returns the ratio of the signal to interference and noise of every user, [..., user], for h [..., user,
    rx_ant, tx_ant], where column k of w [..., tx_ant, user] is user k's precoder with its power, and noise_w
    the noise of a receive port (a number or [..., user]).

    With combiners u [..., user, rx_ant]: |u^H H w_k|^2/(sum_{j != k} |u^H H w_j|^2 + noise |u|^2). Without:
    the largest value that any combiner reaches, w_k^H H^H R^-1 H w_k with R = noise I + sum_{j != k} H w_j
    w_j^H H^H, that of the MMSE combiner R^-1 H w_k (D. Tse, P. Viswanath, "Fundamentals of Wireless
    Communication", 8.3.3).

    For interference from other transmitters, put their antennas beside each other: join their channels along
    tx_ant and their precoders as blocks of w.
    """
    h, w = _matrix(h, "h", "user, rx_ant, tx_ant", 3), _matrix(w, "w", "tx_ant, user")
    users, ports = h.shape[-3], h.shape[-1]
    if w.shape[-2:] != (ports, users):
        raise Error(f"w: expected [..., {ports}, {users}] (tx_ant, user), found {list(w.shape)}")
    noise = np.asarray(noise_w, float)
    if not np.all(noise > 0):
        raise Error("noise_w: expected more than 0 W")
    arriving = h @ w[..., None, :, :]  # [..., user, rx_ant, stream]
    own = np.eye(users, dtype=bool)
    if combiners is not None:
        u = _matrix(combiners, "combiners", "user, rx_ant")
        powers = np.abs(np.einsum("...kr,...krs->...ks", np.conj(u), arriving)) ** 2
        quiet = noise * np.sum(np.abs(u) ** 2, axis=-1)
        signal = np.sum(powers * own, axis=-1)
        return signal / (np.sum(np.where(own, 0.0, powers), axis=-1) + quiet)
    signal = np.einsum("...krk->...kr", arriving)[..., None]
    others = np.where(own[:, None, :], 0.0, arriving)
    around = others @ _hermitian(others) + noise[..., None, None] * np.eye(h.shape[-2])
    return np.real(_hermitian(signal) @ np.linalg.solve(around, signal))[..., 0, 0]


def spectral_efficiency(sinr: Any) -> np.ndarray:
    """Returns log2(1 + SINR), bit/s/Hz, for every value: Shannon's rate if interference is Gaussian noise."""
    return np.log2(1.0 + np.asarray(sinr, float))
