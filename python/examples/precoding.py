# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Finds the best beam of every place in the embedded city, and serves four of them at once.

    PYTHONPATH=build/release/python python3 python/examples/precoding.py

Writes precoding.png if matplotlib is installed.
"""
import numpy as np

import greatx
from greatx import precoding

# %% Find the places of the default city's streets within 60 m of its base station that have a path
greatx.print_errors_plainly()
sim = greatx.Simulation()
area = {"min_m": [-50, -50], "max_m": [60, 60]}
coverage = sim.radio_map(5.0, "csi", **area)
served = (coverage.placement == 0) & (coverage.path_gain[0] > 0)
rows, columns = np.nonzero(served)
places = np.stack([coverage.x[columns], coverage.y[rows], coverage.z[rows, columns]], axis=1)
paths = sim.paths("csi", receivers=places)
h = precoding.matrices(paths.cfr(subcarriers=16))  # [time, subcarrier, rx, rx_ant, tx_ant]
print(f"{len(places)} places, {h.shape[-1]} ports of 4 x 8 cross-polarized elements")

# %% The best of 4 x 16 beams with four phases between the polarizations: a label of each place
codebook = precoding.cross_polarized(precoding.dft_panel(4, 8, oversampling=(1, 2)))
labels = precoding.best_beams(paths.cfr(subcarriers=16), codebook, k=3)
column_beam = labels.beam[:, 0] // 4 % 16
single = np.mean(np.abs(h[..., 0]) ** 2, axis=(0, 1, 3))
most = np.mean(np.sum(np.abs(h) ** 2, axis=(-2, -1)), axis=(0, 1))
print(
    f"{len(np.unique(labels.beam[:, 0]))} of {len(codebook)} beams are some place's best; "
    f"median gain over one port {10 * np.log10(np.median(labels.gain[:, 0] / single)):.1f} dB, "
    f"below maximum ratio by {10 * np.log10(np.median(most / labels.gain[:, 0])):.1f} dB"
)

# %% Serve four users at once, 1 W in all on a subcarrier grid of 100 MHz
spacing_hz, power_w = 100e6 / 16, 1.0 / 16
noise = precoding.noise_w(spacing_hz, noise_figure_db=7)
users = np.random.default_rng(1).choice(len(places), 4, replace=False)
streams, combiners = precoding.combined(h[:, :, users])
for name, w in (
    ("maximum ratio", precoding.maximum_ratio(streams)),
    ("zero-forcing", precoding.zero_forcing(streams)),
    ("regularized", precoding.regularized(streams, noise, power_w)),
    ("best beams", np.broadcast_to(codebook[labels.beam[users, 0]].T, (*h.shape[:2], h.shape[-1], 4))),
):
    ratio = precoding.sinr(h[:, :, users], precoding.scaled(w, power_w), noise, combiners)
    rate = precoding.spectral_efficiency(ratio).mean(axis=(0, 1))
    print(f"  {name:<14} {np.round(rate, 2)} bit/s/Hz, together {rate.sum():.2f}")

# %% One place alone: water-filling over its streams
capacity = precoding.capacity(h[:, :, users], power_w, noise).mean(axis=(0, 1))
print(f"  each alone     {np.round(capacity, 2)} bit/s/Hz")

# %% Draw the labels
picture = np.full(served.shape, np.nan)
picture[rows, columns] = precoding.beam_cosine(column_beam, 8, 2)
try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    print("no matplotlib: no picture")
else:
    plt.imshow(picture, origin="lower", extent=coverage.extent, cmap="twilight")
    plt.plot(*coverage.transmitter_position[0, :2], "r^")
    plt.plot(*places[users, :2].T, "k*")
    plt.colorbar(label="cosine of the best beam to the panel's columns")
    plt.savefig("precoding.png", dpi=120)
    print("precoding.png")
