# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a data set as a DeepMIMO scenario, and computes its channel by NumPy and, if installed, by DeepMIMO.

    greatx generate room -o out/room
    python3 python/examples/convert_deepmimo.py out/room

Writes deepmimo_scenarios/<name>_greatx, where `deepmimo.load("<name>_greatx")` looks for it.
"""
import pathlib
import sys

import numpy as np

import greatx
from greatx.convert import write_deepmimo
from greatx.links import transmitters

KEYS = "power", "phase", "delay", "inter", "aoa_el"

# %% Write every tick as one more user, which requires that the transmitters do not move
greatx.print_errors_plainly()
if len(sys.argv) != 2:
    sys.exit(__doc__)
ds = greatx.load(sys.argv[1])
sequence = ds.sequences[0]
csi = sequence.first("csi", ["cfr", "delay"])
name = f"{ds.run['scenario']}_greatx".lower()
out = pathlib.Path("deepmimo_scenarios", name)
print(out, write_deepmimo(ds, out, channel=csi.name, sequence=sequence.number, layout="users"))

# %% Load the matrices of each transmitter: [user, path], strongest path first, NaN for missing paths
matrices = [
    {key: np.load(out / f"{key}_t000_tx{tx:03}_r001.npz")[key] for key in KEYS}
    for tx in range(len(transmitters(csi)))
]
for key, value in matrices[0].items():
    print(f"  {key:6} {value.shape} {value.dtype}: user 0: {value[0, :4]}")

# %% Sum the paths to H(f) between upright isotropic antennas like DeepMIMO: subcarrier 0 is the carrier, and
# paths whose delay exceeds a symbol are left out
f = np.arange(max(csi.subcarriers // 2, 1)) * csi.subcarrier_spacing_hz
channels = []
for matrix in matrices:
    amplitude = np.nan_to_num(10 ** (matrix["power"] / 20) * np.exp(1j * np.radians(matrix["phase"])))
    delay = np.nan_to_num(matrix["delay"])
    amplitude[delay * csi.subcarrier_spacing_hz >= 1] = 0
    channels.append(np.einsum("up,upf->uf", amplitude, np.exp(-2j * np.pi * f * delay[..., None])))
h = np.stack(channels)  # [transmitter, user, subcarrier]
print(f"H {h.shape}, mean gain {10 * np.log10(max(np.mean(np.abs(h) ** 2), 1e-30)):.1f} dB")

# %% Compute the same channel by DeepMIMO
try:
    import deepmimo
except ImportError:
    print(
        f"no DeepMIMO here: pip install DeepMIMO, then deepmimo.load({name!r}, "
        f"max_paths={matrices[0]['power'].shape[1]})"
    )
else:
    paths = matrices[0]["power"].shape[1]
    loaded = deepmimo.load(name, max_paths=paths)
    pairs = loaded.datasets if isinstance(loaded, deepmimo.MacroDataset) else [loaded]  # per transmitter
    one = {"shape": np.array([1, 1])}
    parameters = deepmimo.ChannelParameters(
        num_paths=paths,
        bs_antenna=one,
        ue_antenna=one,
        ofdm={
            "subcarriers": csi.subcarriers,
            "bandwidth": csi.subcarriers * csi.subcarrier_spacing_hz,
            "selected_subcarriers": np.arange(len(f)),
        },
    )
    theirs = np.stack([pair.compute_channels(parameters)[:, 0, 0] for pair in pairs]) * np.sqrt(
        csi.subcarriers
    )
    difference = np.abs(theirs - h).max() / max(np.abs(h).max(), 1e-30)
    print(f"DeepMIMO's channel differs by at most {difference:.1e} of the largest")
