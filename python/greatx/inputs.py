# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Turns what sensors record into the arrays that networks take (docs/python.md). Needs NumPy alone.

Every function takes arrays of a record, of a data set or of Simulation.run() alike, and returns an array with
the channels first. With `out`, it writes into an array of the caller instead, such as the item's place in a
batch. greatx.modalities names these functions for whole data sets.

Pictures and maps cover the whole field of view of their sensor: their sides may be scaled differently.
"""
from __future__ import annotations

import functools
from typing import Any, Mapping, Optional, Tuple

import numpy as np

from .errors import Error
from .events import Events
from .range_image import lidar_map
from .sizes import Size, positive, result, sides_of

__all__ = [
    "Size",
    "angle_delay",
    "csi_channels",
    "csi_map",
    "csi_scale_db",
    "depth_map",
    "event_voxels",
    "lidar_map",
    "link_cfr",
    "panel_of",
    "picture",
    "radar_map",
]

# The next functions make maps of channels.


def angle_delay(
    cfr: Any,
    delays: Optional[int] = None,
    beams: Optional[int] = None,
    panel: Optional[Tuple[int, int, int]] = None,
) -> np.ndarray:
    """Returns a channel by angle and delay, complex64 [..., beams, delays], of H [..., ports, subcarriers].

    Column l is the absolute delay l / B for the bandwidth B = subcarriers * spacing (a delay of 1/spacing or
    more appears a whole number of 1/spacing earlier); `delays` is how many columns are kept, by default all.
    Of 64 delays at 100 MHz, the last one is 189 m: what comes later than that is left out.
    Row i is the beam k = i - beams // 2, which adds up waves whose phase grows by 2 pi k / beams from port to
    port. For a line of elements at d wavelengths, this is the direction cosine k / (beams d) along the line
    (3GPP TR 38.901, eq. 7.5-22); the middle row is broadside. `beams` is the number of beams, by default as
    many as ports; more of them interpolate.

    With `panel`, (rows, columns, polarizations) of an array in greatx's order, port = (row * columns +
    column) * polarizations + polarization, the rows and the columns are transformed by themselves, so that a
    plane wave is one beam of each polarization. Row i is then (polarization * rows + row beam) * columns +
    column beam, where both beams have their broadside in the middle.

    The values are means: a path of amplitude a in the middle of a beam and of a delay gives a there, and
    sum |map|^2 = sum |H|^2 / (ports * subcarriers) if all delays are kept (Parseval); with a panel, ports are
    those of one polarization.
    """
    h = np.asarray(cfr)
    if h.ndim < 2 or not np.issubdtype(h.dtype, np.number) or 0 in h.shape:
        raise Error(
            f"cfr: expected complex numbers [..., ports, subcarriers], found {h.dtype} {list(h.shape)}"
        )
    ports, subcarriers = h.shape[-2:]
    kept = subcarriers if delays is None else delays
    if not 1 <= kept <= subcarriers:
        raise Error(f"delays: expected 1 to {subcarriers}, the subcarriers, found {delays}")
    if panel is None:
        panel, count = (1, ports, 1), ports if beams is None else beams
        if count < ports:
            raise Error(f"beams: expected {ports}, the ports, or more, found {beams}")
    else:
        rows, columns, polarizations = panel
        if rows * columns * polarizations != ports:
            raise Error(
                f"panel: expected rows * columns * polarizations = {ports} ports, found {tuple(panel)}"
            )
        count = columns
        if beams not in (None, ports):
            raise Error(f"beams: expected as many as ports, {ports}, with a panel, found {beams}")
    taps = np.fft.ifft(h, axis=-1)[..., :kept]
    taps *= _factors(panel, count, subcarriers, kept)
    grid = taps.reshape(*h.shape[:-2], *panel, kept)
    grid = np.fft.fft2(grid, s=(panel[0], count), axes=(-4, -3))
    out = np.empty((*h.shape[:-2], panel[2], panel[0], count, kept), np.complex64)
    out[...] = np.moveaxis(grid, -2, -4)
    return out.reshape(*h.shape[:-2], -1, kept)


@functools.lru_cache(maxsize=64)
def _factors(panel: Tuple[int, int, int], beams: int, subcarriers: int, kept: int) -> np.ndarray:
    """Returns complex128 [ports, kept], by which angle_delay() multiplies taps before it transforms ports."""

    def turned(count: int, period: int) -> np.ndarray:
        """The transform of values times this has its zero at period // 2."""
        return np.exp(2j * np.pi * (period // 2) * np.arange(count) / period)

    rows, columns, polarizations = panel
    elements = np.outer(turned(rows, rows), turned(columns, beams)).reshape(-1)
    # Subcarrier i is i - subcarriers // 2 spacings off the carrier (docs/dataset.md).
    delays = np.conj(turned(kept, subcarriers))
    return np.outer(np.repeat(elements, polarizations), delays) / (rows * columns)


def panel_of(antenna: Mapping[str, Any]) -> Tuple[int, int, int]:
    """Returns `panel` of angle_delay() for an antenna, an entry of `transmitters` or `receivers` of a
    channel's metadata.
    """
    rows, columns, ports = (int(antenna[key]) for key in ("rows", "columns", "ports"))
    return rows, columns, ports // (rows * columns)


def csi_channels(
    angle_delay_map: Any,
    floor_db: float = 60.0,
    reference: Any = None,
    out: Optional[np.ndarray] = None,
) -> np.ndarray:
    """Returns the four channels of complex maps [..., beams, delays], float32 [..., 4, beams, delays]: the
    real part and the imaginary part over `reference`; 20 log10(|map| / reference) from -floor_db to 0,
    scaled to 0..1 and cut off there; and the phase over pi.

    `reference` is an amplitude, or one for each map. By default, it is the largest magnitude of each map,
    whose logarithm csi_scale_db() gives. A map of zeros gives zeros.
    """
    positive(floor_db=floor_db)
    value = np.asarray(angle_delay_map)
    out = result(out, (*value.shape[:-2], 4, *value.shape[-2:]), np.float32)
    magnitude = np.abs(value)
    largest = magnitude.max(axis=(-2, -1)) if reference is None else np.asarray(reference, np.float32)
    scale = np.broadcast_to(1.0 / np.where(largest > 0, largest, 1), value.shape[:-2]).astype(np.float32)
    scale = scale[..., None, None]
    np.multiply(value.real, scale, out=out[..., 0, :, :])
    np.multiply(value.imag, scale, out=out[..., 1, :, :])
    level = out[..., 2, :, :]
    np.multiply(magnitude, scale, out=level)
    np.maximum(level, np.float32(10.0 ** (-floor_db / 20.0)), out=level)
    np.log10(level, out=level)
    level *= np.float32(20.0 / floor_db)
    level += 1
    np.clip(level, 0, 1, out=level)
    np.arctan2(value.imag, value.real, out=out[..., 3, :, :])
    out[..., 3, :, :] *= np.float32(1.0 / np.pi)
    return out


def csi_scale_db(angle_delay_map: Any) -> np.ndarray:
    """Returns the largest magnitude of each map [..., beams, delays] in dB, float32 [...]; -inf if the map is
    zero. It is what csi_channels() divides by, and close to the gain of the strongest path.
    """
    largest = np.abs(np.asarray(angle_delay_map)).max(axis=(-2, -1))
    with np.errstate(divide="ignore"):
        return np.asarray(20.0 * np.log10(largest), np.float32)


def csi_map(
    cfr: Any,
    delays: Optional[int] = 64,
    beams: Optional[int] = None,
    panel: Optional[Tuple[int, int, int]] = None,
    floor_db: float = 60.0,
    reference: Any = None,
    out: Optional[np.ndarray] = None,
) -> np.ndarray:
    """Returns a link's channel H [..., ports, subcarriers] as a picture for a network, float32 [..., 4,
    beams, delays]: csi_channels() of angle_delay(), which describe the arguments. The delay is kept
    absolute, so that the range of the link is in the map. link_cfr() takes H out of a record.
    """
    return csi_channels(angle_delay(cfr, delays, beams, panel), floor_db, reference, out)


def link_cfr(cfr: Any, rx: int = 0, tx: int = 0, time: int = 0) -> np.ndarray:
    """Returns H [..., ports, subcarriers] of a link, from the array `cfr` of records, [..., rx, rx_ant, tx,
    tx_ant, time, subcarrier]. Ports are rx_ant * (ports of tx) + tx_ant. Of a receiver with one port, the
    result is a view.
    """
    h = np.asarray(cfr)
    if h.ndim < 6:
        raise Error(f"cfr: expected [..., rx, rx_ant, tx, tx_ant, time, subcarrier], found {list(h.shape)}")
    for name, index, count in (("rx", rx, h.shape[-6]), ("tx", tx, h.shape[-4]), ("time", time, h.shape[-2])):
        if not 0 <= index < count:
            raise IndexError(f"{name}: expected 0 to {count - 1}, found {index}")
    link = h[..., rx, :, tx, :, time, :]
    return link.reshape(*link.shape[:-3], -1, link.shape[-1])


# The next functions make pictures of what cameras, LiDARs, radars and event cameras record.


@functools.lru_cache(maxsize=64)
def _area_weights(count: int, size: int) -> np.ndarray:
    """Returns float32 [size, count]: the shares of `count` pixels in each of `size` equal parts of a line."""
    edges = np.arange(size + 1) * (count / size)
    pixels = np.arange(count)
    low = np.maximum(edges[:-1, None], pixels)
    high = np.minimum(edges[1:, None], pixels + 1)
    return (np.maximum(high - low, 0) * (size / count)).astype(np.float32)


def _averaged(plane: np.ndarray, size: Tuple[int, int]) -> np.ndarray:
    """Returns the means of a plane [h, w] over the parts of a grid, float32 [*size]."""
    rows, columns = (_area_weights(count, side) for count, side in zip(plane.shape, size))
    return rows @ (plane.astype(np.float32) @ columns.T)


def picture(rgb: Any, size: Size, out: Optional[np.ndarray] = None) -> np.ndarray:
    """Returns a picture, uint8 [3, rows, columns], of uint8 [h, w, 3]. A pixel is the mean over its area,
    rounded; where whole pixels of the camera fall on it, no resampling takes place.
    """
    image = np.asarray(rgb)
    if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8 or 0 in image.shape:
        raise Error(f"rgb: expected uint8 [h, w, 3], found {image.dtype} {list(image.shape)}")
    sides = sides_of(size)
    out = result(out, (3, *sides), np.uint8)
    if image.shape[:2] == sides:
        out[...] = image.transpose(2, 0, 1)
        return out
    for channel in range(3):
        out[channel] = np.rint(_averaged(image[..., channel], sides))
    return out


@functools.lru_cache(maxsize=64)
def _nearest(count: int, size: int) -> np.ndarray:
    """Returns int64 [size], the pixel in which the middle of each of `size` equal parts of a line lies."""
    return (2 * np.arange(size) + 1) * count // (2 * size)


def depth_map(depth_m: Any, size: Size, max_m: float, out: Optional[np.ndarray] = None) -> np.ndarray:
    """Returns a depth picture, float32 [1, rows, columns], of float32 [h, w] in metres: depth / max_m, cut
    off at 1. Where there is no surface (+inf: the sky), it is 0, which no surface beyond the camera's near
    plane has. A pixel has the depth at its middle and no mean, which would lie in the air behind an edge.
    """
    depth = np.asarray(depth_m)
    if depth.ndim != 2 or 0 in depth.shape:
        raise Error(f"depth_m: expected [h, w], found {list(depth.shape)}")
    positive(max_m=max_m)
    rows, columns = sides_of(size)
    out = result(out, (1, rows, columns), np.float32)
    if depth.shape != (rows, columns):
        depth = depth[np.ix_(_nearest(depth.shape[0], rows), _nearest(depth.shape[1], columns))]
    np.divide(depth, np.float32(max_m), out=out[0], casting="same_kind")
    out[0][~np.isfinite(out[0])] = 0
    np.minimum(out[0], 1, out=out[0])
    return out


def radar_map(
    power_w: Any,
    size: Optional[Size] = None,
    span_db: float = 60.0,
    noise_w: Optional[float] = None,
    out: Optional[np.ndarray] = None,
) -> np.ndarray:
    """Returns a radar's map, float32 [1, rows, columns], of the powers of its cells [h, w] in W, a
    range-Doppler or a range-azimuth map (docs/radar.md): 10 log10(power / noise) from 0 to span_db, scaled to
    0..1 and cut off there.

    `noise_w` is the noise of a cell. By default it is the median of the map, which is that of the noise where
    targets fill less than half of it (H. Rohling, IEEE Trans. Aerosp. Electron. Syst. 19(4), 1983, uses order
    statistics for the same reason). With `size`, the powers are averaged over areas before, as by picture().
    """
    power = np.asarray(power_w)
    if power.ndim != 2 or 0 in power.shape:
        raise Error(f"power_w: expected [h, w], found {list(power.shape)}")
    positive(span_db=span_db)
    noise = float(np.median(power)) if noise_w is None else noise_w
    sides = power.shape if size is None else sides_of(size)
    out = result(out, (1, *sides), np.float32)
    if power.shape != sides:
        # Powers lie far below the least float32 that has all its digits.
        power = _averaged(power * (1.0 / (noise or 1.0)), sides)
        noise = 1.0 if noise else 0.0
    if noise <= 0:
        out[...] = 0
        return out
    np.multiply(power, np.float32(1.0 / noise), out=out[0], casting="same_kind")
    np.maximum(out[0], 1, out=out[0])
    np.log10(out[0], out=out[0])
    out[0] *= np.float32(10.0 / span_db)
    np.minimum(out[0], 1, out=out[0])
    return out


@functools.lru_cache(maxsize=64)
def _part_of(count: int, size: int, step: int) -> np.ndarray:
    """Returns int64 [count]: which of `size` equal parts of a line each of `count` pixels begins in, times
    `step`.
    """
    return np.arange(count) * size // count * step


def event_voxels(
    events: Events,
    bins: int,
    size: Optional[Size] = None,
    span_ns: Optional[Tuple[int, int]] = None,
    out: Optional[np.ndarray] = None,
) -> np.ndarray:
    """Returns a voxel grid of events, float32 [bins, rows, columns]: the polarities (1, -1) distributed
    linearly to the two nearest bins in time (A. Zhu et al., "Unsupervised Event-based Learning of Optical
    Flow, Depth, and Egomotion", CVPR 2019, eq. 1-2).

    span_ns  times of the first and the last bin, by default those of the first and the last event. An event
             between a bin and the next one counts in both, with weights that sum to 1; one within a bin's
             distance outside of the span counts with the rest of its weight
    size     pixels of the grid; an event counts in the part of the picture in which its pixel begins

    Without `size`, the grid is that of Events.voxel_grid, which takes two to four times as long for hundreds
    of thousands of events.
    """
    if bins < 1:
        raise Error(f"bins: expected 1 or more, found {bins}")
    rows, columns = sides_of((events.height, events.width) if size is None else size)
    out = result(out, (bins, rows, columns), np.float32)
    out[...] = 0
    if not len(events.t):
        return out
    begin, end = span_ns or (int(events.t[0]), int(events.t[-1]))
    time = (events.t - begin) * ((bins - 1) / max(end - begin, 1))
    pixel = _part_of(events.height, rows, columns).take(events.y)
    pixel += _part_of(events.width, columns, 1).take(events.x)
    sign = events.p * 2.0 - 1.0
    flat = out.reshape(bins, -1)
    # Events are sorted by time, so those between two bins are a slice, and a sum has the size of a picture.
    edges = np.searchsorted(time, np.arange(-1, bins + 1))
    for bin_, first, last in zip(range(-1, bins), edges[:-1], edges[1:]):
        if first == last:
            continue
        where, signs = pixel[first:last], sign[first:last]
        later = np.bincount(where, signs * (time[first:last] - bin_), minlength=rows * columns)
        if bin_ >= 0:
            flat[bin_] += np.bincount(where, signs, minlength=rows * columns) - later
        if bin_ + 1 < bins:
            flat[bin_ + 1] += later
    return out
