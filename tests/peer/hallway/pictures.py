# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Draws a prediction beside the measurement. The pictures hold measured data, so they stay in the output."""

import matplotlib.pyplot as plt
import numpy as np

from hallway import measured as m


def draw(folder, name, world, found, cells, score):
    figure, axes = plt.subplots(2, 2, figsize=(12, 8), constrained_layout=True)
    along = world.cells[cells, 1]
    for array, axis in enumerate(axes[0]):
        axis.plot(along, world.power_db[array, cells], "k.", ms=4, label="measured")
        axis.plot(along, found.power_db[array] + score.constant_db, "r.", ms=4, label=name)
        axis.set(xlabel="y, m", ylabel="power, dB", title=f"array {array + 1}")
        axis.legend()
    spreads = world.delay_spread_ns
    axes[1, 0].plot(spreads.value, spreads.cdf, "k", label="measured")
    values = np.sort(np.ravel(found.delay_spread_ns))
    axes[1, 0].plot(values, (np.arange(len(values)) + 0.5) / len(values), "r", label=name)
    axes[1, 0].set(xlabel="RMS delay spread, ns", ylabel="CDF", xlim=(0, 200))
    axes[1, 0].legend()
    for number, (delay, height) in enumerate(world.responses()):
        level = 20 * np.log10(np.maximum(height, 1e-12) / height.max())
        axes[1, 1].plot(delay, level, lw=0.8, label=f"measured {number + 1}")
    power = np.mean(np.abs(found.responses) ** 2, axis=(0, 1))
    axes[1, 1].plot(
        1e9 / m.BANDWIDTH_HZ * m.TAPS, 10 * np.log10(power / power.max()), "k", lw=2, label=f"{name}, mean"
    )
    axes[1, 1].set(xlabel="delay, ns", ylabel="dB", xlim=(-100, 800), ylim=(-60, 3))
    axes[1, 1].legend(fontsize=7)
    figure.suptitle(f"{name}: {score}")
    figure.savefig(folder / f"{name}.png", dpi=90)
    plt.close(figure)
