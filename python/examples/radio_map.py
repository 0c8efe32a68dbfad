# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes a coverage map of two base stations, and finds the place of the weakest coverage.

    PYTHONPATH=build/release/python python3 python/examples/radio_map.py

Writes radio_map.png if matplotlib is installed.
"""
import numpy as np

import greatx

# %% Place two base stations in a generated street
greatx.print_errors_plainly()
sim = greatx.Simulation(
    {"greatx": 1, "name": "street", "ticks": 1, "scene": {"generate": {"kind": "canyon", "size_m": 120}}}
)
for name, position, target in (("south", [6.3, -40, 8], [0, 0, 1.5]), ("north", [-6.3, 40, 8], [0, 0, 1.5])):
    sim.place_transmitter(
        name, position, look_at=target, array=greatx.Array(pattern="tr38901", polarization="v")
    )
sim.add_channel("coverage", carrier_hz=3.5e9, bandwidth_hz=20e6, subcarriers=64, max_depth=2)

# %% Compute the map: each cell has the paths of a receiver at its centre, 1.5 m above the ground
area = {"min_m": [-15, -60], "max_m": [15, 60], "power_dbm": 30, "noise_figure_db": 7}
coverage = sim.radio_map(3.0, progress=lambda cells: print(f"  {cells} cells"), **area)
print(coverage.facts["height"], coverage.rss.shape, coverage.unit("rss"))
free = coverage.placement == 0
for tx, name in enumerate(coverage.transmitters):
    share = np.mean(coverage.best_server[free] == tx)
    print(
        f"  {name}: serves {100 * share:.0f} % of the free cells, "
        f"median {np.median(coverage.rss[tx][free]):.1f} dBm"
    )

# %% Check that a cell has exactly the gain of a receiver at its centre
row, column = np.argwhere(free)[len(np.argwhere(free)) // 2]
point = [coverage.x[column], coverage.y[row], coverage.z[row, column]]
gain = sim.paths(receivers=[point]).statistics().path_gain[0]
assert (gain == coverage.path_gain[:, row, column]).all()

# %% Find the cell in which the stronger of the two stations is weakest: there a third one helps most
best = np.where(free, coverage.rss.max(axis=0), np.inf)
row, column = np.unravel_index(np.argmin(best), best.shape)
print(f"weakest: {best[row, column]:.1f} dBm at x {coverage.x[column]:.0f}, y {coverage.y[row]:.0f} m")
try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    print("no matplotlib: no picture")
else:
    plt.imshow(coverage.rss.max(axis=0), origin="lower", extent=coverage.extent)
    plt.plot(*coverage.transmitter_position[:, :2].T, "r^")
    plt.xlabel("x, m")
    plt.ylabel("y, m")
    plt.colorbar(label="dBm")
    plt.savefig("radio_map.png", dpi=120)
    print("radio_map.png")
