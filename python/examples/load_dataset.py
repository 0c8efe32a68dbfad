# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a data set: the CSI tensor, the line of sight, paths, other sensors at a tick, the delay profile.

    greatx generate canyon -o out/canyon
    python3 python/examples/load_dataset.py out/canyon

Writes delay_profile.png if matplotlib is installed.
"""
import sys

import numpy as np

import greatx

# %% Open the data set, which reads only dataset.json and the index
greatx.print_errors_plainly()
if len(sys.argv) != 2:
    sys.exit(__doc__)
ds = greatx.load(sys.argv[1])
sequence = ds.sequences[0]
print(ds)
csi = sequence.first("csi", ["cfr", "delay"])

# %% Map the channel over time: complex64 [record, rx, rx_ant, tx, tx_ant, time, subcarrier]
h = csi.cfr
print(
    f"{csi.name}: H {h.shape} {h.dtype} at {csi.carrier_hz / 1e9:g} GHz, "
    f"spacing {csi.subcarrier_spacing_hz / 1e3:g} kHz"
)

# %% Compare the gain with and without a line of sight, for receiver 0 and transmitter 0
los = np.reshape(csi.line_of_sight, (len(csi), -1))[:, 0] == 1
gain_db = 10 * np.log10(np.maximum(np.mean(np.abs(h[:, 0, :, 0]) ** 2, axis=(1, 2, 3, 4)), 1e-30))
for name, which in (("line of sight", los), ("none", ~los)):
    if which.any():
        print(f"{name:>13}: {which.sum():4} of {len(csi)} ticks, mean gain {gain_db[which].mean():.1f} dB")

# %% Print the strongest paths of a tick, whose arrays are views of the files
record = csi.record(len(csi) // 2)
paths = record.paths(rx=0, tx=0)
for i in np.argsort(-np.abs(paths["transfer"][:, 0, 0]))[:5]:
    kinds = "".join("-RTDS"[k] for k in paths["interaction"][i] if k) or "line of sight"
    print(
        f"  {paths['delay'][i] * 1e9:8.2f} ns  {paths['doppler'][i]:8.2f} Hz  {kinds:15} "
        f"id {paths['id'][i]:016x}"
    )

# %% Print the records of all sensors at the same tick
tick = sequence.at(record.tick)
for name, other in tick.items():
    shapes = {a: np.shape(other[a]) for a in list(other.sensor.arrays)[:4]}
    print(f"  tick {tick.tick}, {tick.time_s:g} s, {name}: {shapes}")

# %% Compute the power over delay and time of the first ports; delays wrap at 1 / subcarrier spacing
window = np.hanning(h.shape[-1])
profile_db = 20 * np.log10(np.abs(np.fft.ifft(h[:, 0, 0, 0, 0, 0] * window, axis=-1)) + 1e-12)
print(f"delay profile {profile_db.shape}, strongest bin at record 0: {profile_db[0].argmax()}")
try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    print("no matplotlib: no picture")
else:
    step_ns = 1e9 / (csi.subcarrier_spacing_hz * h.shape[-1])
    plt.imshow(
        profile_db.T,
        origin="lower",
        aspect="auto",
        vmin=profile_db.max() - 50,
        extent=(csi.times_s[0], csi.times_s[-1] + 1e-9, 0, step_ns * h.shape[-1]),
    )
    plt.xlabel("time, s")
    plt.ylabel("delay, ns")
    plt.colorbar(label="dB")
    plt.savefig("delay_profile.png", dpi=120)
    print("delay_profile.png")
