# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Finds a hidden transmitter in the embedded room from the channels to six receivers (docs/gradients.md).

    PYTHONPATH=build/release/python python3 python/examples/localise.py

The phase of a channel comes back with every wavelength, so a search by H alone ends in the nearest of many
minima. The search has two stages: the delay of the first arrival over 1 GHz, which has one minimum in the
room and leads to within a quarter of the wavelength, and then H with all its phases and reflections.
"""
import warnings

import numpy as np

import greatx

C, CARRIER_HZ, BANDWIDTH_HZ, SUBCARRIERS = 299792458.0, 3.5e9, 1e9, 256
RECEIVERS = [[-4.2, -2.3, 1.5], [4.2, -2.3, 1.9], [4.2, 2.3, 1.4]]
RECEIVERS += [[-4.2, 2.3, 1.8], [0.3, -2.4, 2.1], [-0.6, 2.4, 1.2]]
HIDDEN, START = np.array([2.86, -2.33, 1.77]), np.array([-2.0, 1.0, 1.2])
PLACE = "transmitter.position"
GRID = {"carrier_hz": CARRIER_HZ, "bandwidth_hz": BANDWIDTH_HZ, "subcarriers": SUBCARRIERS}


def solve(place):
    """Returns all paths from a transmitter at this place to the receivers."""
    sim = greatx.Simulation("room")
    sim.place_transmitter("hidden", place)
    sim.add_channel("search", receivers=[], max_depth=3, **GRID)
    return sim.paths("search", receivers=np.array(RECEIVERS))


def first_arrival(h):
    """Returns the delay of the first strong peak of the band's impulse response, s."""
    size = 32 * len(h)
    profile = np.abs(np.fft.ifft(h * np.hanning(len(h) + 2)[1:-1], size))
    higher = (profile >= np.roll(profile, 1)) & (profile >= np.roll(profile, -1))
    i = np.flatnonzero(higher & (profile > 0.5 * profile.max()))[0]
    before, at, after = profile[[i - 1, i, (i + 1) % size]]
    return (i + 0.5 * (before - after) / (before - 2 * at + after)) / (size * BANDWIDTH_HZ / SUBCARRIERS)


def report(way, place):
    print(f"{way}: {1e3 * np.linalg.norm(place - HIDDEN):.6f} mm away")


# %% What is measured: H of the hidden transmitter
greatx.print_errors_plainly()
measured = solve(HIDDEN).cfr(parameters={PLACE: HIDDEN})[:, 0, 0, 0, 0]
place, step = START, np.ones(3)
report("start", place)

# %% First stage: delays. The first path of a link is its line of sight; its delay has an exact derivative.
arrivals = np.array([first_arrival(h) for h in measured])
while np.linalg.norm(step) > 1e-4:
    paths = solve(place)
    direct = paths.offsets[:-1]
    slopes = paths.jacobian([PLACE], of="delay").values[direct]
    step = np.linalg.lstsq(slopes * C, (arrivals - paths.delay[direct]) * C, rcond=None)[0]
    place = place + step
report(f"delays (a quarter of the wavelength is {C / CARRIER_HZ / 4e-3:.0f} mm)", place)

# %% Second stage: all of H, by Gauss-Newton on a fixed set of paths. Where paths were born or have died
# meanwhile, H jumps, so the paths are solved again at the new place until none has.
warnings.simplefilter("ignore")  # paths that are gone are counted below
paths, changed = solve(place), True
while changed:
    step = np.ones(3)
    while np.linalg.norm(step) > 1e-9:
        rest = measured - paths.cfr(parameters={PLACE: place})[:, 0, 0, 0, 0]
        slopes = paths.jacobian([PLACE], parameters={PLACE: place}).values[:, 0, 0, 0, 0].reshape(-1, 3)
        parts = [np.concatenate([a.real, a.imag]) for a in (slopes, rest.ravel())]
        step = np.linalg.lstsq(*parts, rcond=None)[0]
        place = place + step * min(1.0, 0.01 / np.linalg.norm(step))  # at most 10 mm
    before, paths = paths, solve(place)
    changes = paths.changes_since(before)
    changed = changes.born.any() or changes.died.any()
    report(f"H, {changes.born.sum()} paths born, {changes.died.sum()} died", place)
assert np.linalg.norm(place - HIDDEN) < 1e-3
