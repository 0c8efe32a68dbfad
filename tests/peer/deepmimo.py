# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that DeepMIMO's own loader reads the files of `greatx.convert deepmimo` and computes greatx's
channel from them.

    python3 tests/peer/deepmimo.py [PROGRAM]

The first run makes an environment with DeepMIMO 4.0.5 below build/peer/. The script runs a scenario of its
own with PROGRAM (build/release/greatx), converts it both ways and loads it with `deepmimo.load`. It then
compares with the data set: positions, delays, angles, interactions, the time convention, and the channel that
DeepMIMO computes between single isotropic antennas. It prints the largest difference of each kind beside its
bound, and exits with 1 if one exceeds its bound.
"""

import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile

from environment import ROOT, Worst, run_inside

PACKAGES = ("DeepMIMO==4.0.5",)
SCENARIO = """
greatx: 1
name: peer
ticks: 3
tick_rate_hz: 20
scene: {generate: {kind: canyon, seed: 9, size_m: 120}}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [6.3, -21.7, 9.4], rotation_deg: [90, 0, 0]}
    sensors: [{name: antenna, type: antenna}]
  - name: near
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2.4, -30, 1.6]}, \
{t_s: 1, position_m: [2.4, -20, 1.6]}]}
    sensors: [{name: antenna, type: antenna}]
  - name: far
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2.4, 30, 1.6]}, \
{t_s: 1, position_m: [-2.4, 45, 1.6]}]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/antenna, rx: [near/antenna, far/antenna], rate_hz: 20, carrier_hz: 28e9, \
bandwidth_hz: 400e6,
     subcarriers: 512, time_samples: 2, time_spacing_s: 1e-4, max_depth: 3}
"""


def check_link(theirs, user, record, rx, worst):
    """Compares one receiver of a deepmimo.Dataset with one receiver of a record."""
    import numpy as np
    from greatx.links import antenna_pose, receivers, transmitters

    meta = record.sensor.metadata
    ours = record.paths(rx, 0)
    strongest = np.argsort(-np.abs(ours["amplitude"][:, 0, 0]), kind="stable")
    ours = {key: value[strongest] for key, value in ours.items()}
    n = len(strongest)
    worst.add("number of paths", abs(int(theirs.num_paths[user]) - n), 0)
    want = 20 * np.log10(np.abs(ours["amplitude"][:, 0, 0]))
    worst.add("power of a path, dB", np.abs(theirs.power[user, :n] - want), 1e-4)
    turn = np.exp(1j * np.radians(theirs.phase[user, :n].astype(float)))
    worst.add("phase of a path, rad", np.abs(np.angle(turn / ours["amplitude"][:, 0, 0])), 1e-5)
    worst.add("delay, relative", np.abs(theirs.delay[user, :n] / ours["delay"] - 1), 1e-7)
    for name, want in (("aoa", ours["arrival"]), ("aod", ours["departure"])):
        for what, column in (("el", 0), ("az", 1)):
            worst.add(
                "angles, degrees",
                np.abs(theirs[f"{name}_{what}"][user, :n] - np.degrees(want[:, column])),
                2e-5,
            )
    letters = np.array(["", "R", "T", "D", "S"])
    expected = ["".join(letters[row]) for row in ours["interaction"]]
    worst.add(
        "interactions, as deepmimo names them",
        sum(a != b for a, b in zip(theirs.inter_str[user, :n], expected)),
        0,
    )
    depth = theirs.inter_pos.shape[2]
    places, wanted = theirs.inter_pos[user, :n], ours["vertex"][:, :depth]
    worst.add(
        "places of interactions, NaN where there is none", np.sum(np.isnan(places) != np.isnan(wanted)), 0
    )
    worst.add("places of interactions, m", np.nan_to_num(np.abs(places - wanted)), 1e-5)
    worst.add("line of sight", abs(int(theirs.los[user]) - int(np.ravel(record["line_of_sight"])[rx])), 0)
    worst.add(
        "ends, m", np.abs(theirs.rx_pos[user] - antenna_pose(record, receivers(record.sensor)[rx])[0]), 1e-5
    )
    worst.add(
        "ends, m",
        np.abs(np.ravel(theirs.tx_pos) - antenna_pose(record, transmitters(record.sensor)[0])[0]),
        1e-5,
    )

    # DeepMIMO's grid begins at the carrier: its subcarrier k is greatx's k + N/2.
    half = meta["subcarriers"] // 2
    h = theirs.channel[user, 0, 0].T * np.sqrt(meta["subcarriers"])
    want = record["cfr"][rx, 0, 0, 0, :, half:]
    worst.add(
        "H(f, t) of single antennas, relative to its mean power",
        np.abs(h - want) / np.sqrt(np.mean(np.abs(want) ** 2)),
        1e-4,
    )
    conjugate = np.abs(np.conj(h) - want) / np.sqrt(np.mean(np.abs(want) ** 2))
    worst.add("(the other time convention would not do: 0 if so)", float(conjugate.max() < 0.1), 0)
    worst.add(
        "(nor would H at rest: 0 if so)",
        float(np.abs(want[1] - want[0]).max() < 1e-3 * np.abs(want).max()),
        0,
    )


def compute(theirs, folder, meta):
    """Computes DeepMIMO's channel of single antennas: [user, 1, 1, subcarrier, time]."""
    import deepmimo as dm
    import numpy as np

    one = {"shape": np.array([1, 1])}
    doppler = np.load(pathlib.Path("deepmimo_scenarios", folder, "doppler_t000_tx000_r001.npz"))["doppler"]
    theirs.set_doppler(np.nan_to_num(doppler[:, : theirs.max_paths]))
    theirs.compute_channels(
        dm.ChannelParameters(
            num_paths=1000,
            doppler=True,
            bs_antenna=one,
            ue_antenna=one,
            ofdm={
                "subcarriers": meta["subcarriers"],
                "bandwidth": meta["subcarriers"] * meta["subcarrier_spacing_hz"],
                "selected_subcarriers": np.arange(meta["subcarriers"] // 2),
            },
        ),
        times=np.arange(meta["time_samples"]) * meta["time_spacing_s"],
    )


def check(program):
    import deepmimo as dm
    import numpy as np
    import greatx
    from greatx.convert import write_deepmimo

    worst = Worst()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pathlib.Path("peer.yaml").write_text(SCENARIO)
        subprocess.run([program, "generate", "peer.yaml", "-o", "data", "-q"], check=True)
        channel = greatx.load("data")["csi"]
        for layout in ("snapshots", "users"):
            write_deepmimo(channel.sequence.dataset, f"deepmimo_scenarios/peer_{layout}", layout=layout)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            dynamic = dm.load("peer_snapshots", max_paths=1000)
            users = dm.load("peer_users", max_paths=1000)
            for i, each in enumerate(dynamic.datasets):
                compute(each, f"peer_snapshots/snapshot_{i:06d}", channel.metadata)
            compute(users, "peer_users", channel.metadata)
        worst.add("snapshots", abs(dynamic.n_scenes - len(channel)), 0)
        worst.add("carrier, Hz", abs(users.rt_params.frequency - channel.carrier_hz), 0)
        for i, record in enumerate(channel):
            for rx in range(2):
                check_link(dynamic.datasets[i], rx, record, rx, worst)
                check_link(users, 2 * i + rx, record, rx, worst)
        print(f"DeepMIMO {dm.__version__}: {users.n_ue} users, {int(users.num_paths.sum())} paths")
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    if "--inside" in sys.argv:
        sys.path.pop(0)  # this folder holds this file, which would hide the package deepmimo
        sys.exit(check(sys.argv[2]))
    program = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release/greatx").resolve()
    sys.exit(run_inside("deepmimo", PACKAGES, [__file__, "--inside", program]))
