# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs the paths of two answers one to one, and measures how far the pairs are apart."""
import numpy as np

#: Largest distance of equal points, m. fp32 moves points of grazing reflections by some 30 mm at some hundred
#: metres.
POINT_M = 0.25
LENGTH_M = 2e-3


def same_polyline(a, b):
    return (
        a.receiver == b.receiver
        and a.kinds == b.kinds
        and abs(a.length - b.length) < LENGTH_M
        and np.abs(a.points - b.points).max() < POINT_M
    )


def pair(greatx, sionna):
    """Returns (pairs, paths missing in Sionna RT, paths of Sionna RT left over, paths doubled in Sionna RT).
    The last list holds (path, the first path that equals it)."""
    by_receiver = {}
    for path in greatx:
        by_receiver.setdefault((path.receiver, path.kinds), []).append(path)
    pairs, extra, doubled, taken = [], [], [], {}
    for path in sionna:
        fits = [p for p in by_receiver.get((path.receiver, path.kinds), []) if same_polyline(p, path)]
        fits.sort(key=lambda p: np.abs(p.points - path.points).max())
        free = [p for p in fits if id(p) not in taken]
        if free:
            taken[id(free[0])] = path
            pairs.append((free[0], path))
        elif fits:
            doubled.append((path, taken[id(fits[0])]))
        else:
            twin = next((e for e in extra if same_polyline(e, path)), None)
            if twin is None:
                extra.append(path)
            else:
                doubled.append((path, twin))
    missing = [p for p in greatx if id(p) not in taken]
    return pairs, missing, extra, doubled


def doubled_within(paths):
    """Returns the number of paths that equal an earlier path of the same answer."""
    groups = {}
    for p in paths:
        groups.setdefault((p.receiver, p.kinds), []).append(p)
    return sum(
        any(same_polyline(p, q) for q in group[:i]) for group in groups.values() for i, p in enumerate(group)
    )


def angle_between(a, b):
    """Returns the angle in rad between two directions given by zenith and azimuth."""
    u, v = (np.array([np.sin(z) * np.cos(p), np.sin(z) * np.sin(p), np.cos(z)]) for z, p in (a, b))
    return np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v)


def relative(found, expected):
    size = np.linalg.norm(expected)
    return np.linalg.norm(found - expected) / size if size > 0 else np.inf


def differences(pairs):
    """Returns for each pair the differences of delay (s), both angles (rad), transfer (relative) and points
    (m)."""
    out = []
    for ours, theirs in pairs:
        out.append(
            (
                abs(ours.delay - theirs.delay),
                angle_between(ours.departure, theirs.departure),
                angle_between(ours.arrival, theirs.arrival),
                relative(theirs.transfer, ours.transfer),
                np.abs(ours.points - theirs.points).max(),
            )
        )
    return np.array(out).reshape(-1, 5)


def response(paths, case, frequencies, count):
    """Returns H [count of receivers, 2, 2, k] of a list of paths with fp64 phases. Frequencies are relative
    to the carrier."""
    out = np.zeros((count, 2, 2, len(frequencies)), complex)
    for p in paths:
        phase = np.exp(-2j * np.pi * (((case.carrier_hz + frequencies) * p.delay) % 1.0))
        out[p.receiver] += p.transfer[:, :, None] * phase
    return out


def nmse_db(found, expected):
    """Returns the median and the largest NMSE in dB over the receivers with any power. The NMSE of a receiver
    covers all its values."""
    values = []
    for a, b in zip(found, expected):
        power = np.sum(np.abs(b) ** 2)
        if power > 0:
            values.append(10 * np.log10(max(np.sum(np.abs(a - b) ** 2) / power, 1e-32)))
    return (float(np.median(values)), float(np.max(values))) if values else (np.nan, np.nan)
