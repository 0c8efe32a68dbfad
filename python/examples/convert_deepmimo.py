# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A data set as a DeepMIMO scenario, and back into a channel: by NumPy, and by DeepMIMO itself if it is there.

    greatx generate room -o out/room
    python3 python/examples/convert_deepmimo.py out/room

Writes deepmimo_scenarios/<name>_greatx, where `deepmimo.load("<name>_greatx")` looks for it.
"""
import pathlib
import sys

import numpy as np

import greatx
from greatx.convert import write_deepmimo

# %% Every tick becomes one more user: fits channels whose transmitter stands still
ds = greatx.load(sys.argv[1])
sequence = ds.sequences[0]
csi = next(s for s in sequence.sensors.values() if s.kind == "csi")
name = f"{ds.run['scenario']}_greatx".lower()
out = pathlib.Path("deepmimo_scenarios", name)
print(out, write_deepmimo(ds, out, channel=csi.name, sequence=sequence.number, layout="users"))

# %% The matrices: [user, path], NaN where there is no path, the strongest first
matrix = {key: np.load(out / f"{key}_t000_tx000_r001.npz")[key] for key in ("power", "phase", "delay", "inter", "aoa_el")}
for key, value in matrix.items():
    print(f"  {key:6} {value.shape} {value.dtype}: user 0: {value[0, :4]}")

# %% H(f) between upright isotropic antennas, as DeepMIMO sums it: subcarrier 0 is the carrier
amplitude = np.nan_to_num(10 ** (matrix["power"] / 20) * np.exp(1j * np.radians(matrix["phase"])))
f = np.arange(csi.subcarriers // 2) * csi.subcarrier_spacing_hz
h = np.einsum("up,upf->uf", amplitude, np.exp(-2j * np.pi * f * np.nan_to_num(matrix["delay"])[..., None]))
print(f"H {h.shape}, mean gain {10 * np.log10(np.mean(np.abs(h) ** 2)):.1f} dB")

# %% The same by DeepMIMO
try:
    import deepmimo
except ImportError:
    print("no DeepMIMO here: pip install DeepMIMO, then deepmimo.load(%r, max_paths=%d)" % (name, matrix["power"].shape[1]))
else:
    dataset = deepmimo.load(name, max_paths=matrix["power"].shape[1])
    one = {"shape": np.array([1, 1])}
    theirs = dataset.compute_channels(deepmimo.ChannelParameters(
        num_paths=matrix["power"].shape[1], bs_antenna=one, ue_antenna=one,
        ofdm={"subcarriers": csi.subcarriers, "bandwidth": csi.subcarriers * csi.subcarrier_spacing_hz,
              "selected_subcarriers": np.arange(len(f))}))[:, 0, 0] * np.sqrt(csi.subcarriers)
    print(f"DeepMIMO's channel differs by at most {np.abs(theirs - h).max() / np.abs(h).max():.1e} of the largest")
