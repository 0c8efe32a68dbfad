# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Places antennas in a generated street, and computes the paths and the channel between them.

    PYTHONPATH=build/release/python python3 python/examples/paths.py [SCENE.glb RADIO_MATERIALS.yaml]
"""
import sys

import numpy as np

import greatx

# %% Load the scene: a generated one, or a glTF file with the radio properties of its materials
greatx.print_errors_plainly()
if len(sys.argv) > 2:
    sim = greatx.Simulation.from_scene(sys.argv[1], radio_materials=sys.argv[2])
else:
    sim = greatx.Simulation(
        {"greatx": 1, "name": "street", "ticks": 1, "scene": {"generate": {"kind": "canyon", "size_m": 120}}}
    )
print(sim.scene["triangles"], "triangles within", sim.scene["bounds_m"])

# %% Place a base station with 4 x 8 cross-polarized elements at 28 GHz, and two phones
panel = greatx.Array(rows=4, columns=8, pattern="tr38901", polarization="slant", row_spacing_wl=2)
sim.place_transmitter("bs", [6.3, -21.7, 9.4], array=panel, look_at=[0, 10, 1.5])
sim.place_receivers([[-2, 10, 1.5], [3, 35, 1.5]], array=greatx.Array(polarization="vh"))
sim.add_channel("mmwave", carrier_hz=28e9, bandwidth_hz=400e6, subcarriers=256, max_depth=3)

# %% Compute all paths: flat arrays over all links, and views of one link
paths = sim.paths()
print(paths)
link = paths.link(rx=0)
for i in np.argsort(-np.abs(link["transfer"]).max(axis=(1, 2)))[:5]:
    kinds = "".join("-RTDS"[k] for k in link["interaction"][i] if k) or "line of sight"
    zenith, azimuth = np.degrees(link["departure"][i])
    print(
        f"  {link['delay'][i] * 1e9:8.2f} ns  leaves at zenith {zenith:5.1f}, "
        f"azimuth {azimuth:6.1f} deg  {kinds}"
    )

# %% Compute channel quantities from the paths: every array is [rx, ..., tx, ...]
h = paths.cfr()  # complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier]
wide = paths.cfr(bandwidth_hz=800e6, subcarriers=64)
los, rest = (np.linalg.norm(paths.cfr(select=part)) for part in ("line_of_sight", "others"))
print(
    f"H {h.shape} {h.dtype}, at twice the bandwidth {wide.shape}; "
    f"|line of sight| / |others| = {los / max(rest, 1e-30):.2f}"
)
a, tau = paths.cir()
taps = paths.taps(100e6)
print(
    f"impulse response {a.shape}, taps {taps.taps.shape}, of the power {taps.power_outside.max():.1e} outside"
)
stats = paths.statistics()
for rx, name in enumerate(paths.receivers):
    print(
        f"  {name}: {stats.path_count[rx, 0]} paths, "
        f"path loss {-10 * np.log10(stats.path_gain[rx, 0]):.1f} dB, "
        f"delay spread {stats.delay_spread[rx, 0] * 1e9:.1f} ns, "
        f"K {10 * np.log10(stats.k_factor[rx, 0]):.1f} dB"
    )
print(f"received of 1 W: {10 * np.log10(paths.received(1.0).mean_power_w[:, 0] * 1e3)} dBm")

# %% Solve receivers along a line as points: the search from the base station is kept
line = np.stack([np.full(40, 0.5), np.linspace(-40, 40, 40), np.full(40, 1.5)], axis=1)
moving = sim.paths(receivers=line)
print(moving, "gain", np.round(10 * np.log10(moving.statistics().path_gain[::8, 0] + 1e-30), 1), "dB")

# %% Share the memory with torch
try:
    import torch
except ImportError:
    print("no torch")
else:
    print(torch.from_dlpack(h).abs().square().mean())
