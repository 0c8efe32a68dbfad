# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a simulation in memory, tick by tick, without files. A base station keeps the best beam of the
previous tick, and the example measures the loss of gain.

    PYTHONPATH=build/release/python python3 python/examples/stream.py [SCENARIO]
"""
import sys

import numpy as np

import greatx

# %% Load a scenario with a base station, a car with a camera, and a channel
greatx.print_errors_plainly()
sim = greatx.Simulation(sys.argv[1] if len(sys.argv) > 1 else "canyon", ticks=20)
print(sim)
channel = next(iter(sim.channels), None)
if channel is None:
    sys.exit(f"{sim.name}: expected a scenario with a channel, found none")

# %% Step through the ticks, whose records are those that `greatx generate` would write
beam, loss_db, run = None, [], sim.run()
print({name: sensor["kind"] for name, sensor in run.sensors.items()})
for tick in run:
    if channel not in tick:
        continue
    record = tick[channel]
    h = record.cfr[0, :, 0, :, 0]  # receiver 0, transmitter 0: [rx_ant, tx_ant, subcarrier]
    covariance = np.einsum("atk,auk->tu", h.conj(), h) / h.shape[-1]  # mean over subcarriers
    values, vectors = np.linalg.eigh(covariance)
    best = vectors[:, -1]
    if beam is not None and values[-1] > 0:
        kept = np.real(beam.conj() @ covariance @ beam)
        loss_db.append(10 * np.log10(values[-1] / max(kept, 1e-12 * values[-1])))
    beam = best
    seen = {name: r["depth"].shape for name, r in tick.items() if "depth" in r}
    print(
        f"  {tick.time_s:5.2f} s: {record.path_count[0, 0]} paths, "
        f"gain {10 * np.log10(values[-1] + 1e-30):6.1f} dB, {seen}"
    )

# %% Print the loss of the previous tick's beam
if loss_db:
    print(
        f"a beam that is a tick old loses {np.mean(loss_db):.2f} dB on average, "
        f"{np.max(loss_db):.2f} dB at worst"
    )
print({name: count for name, count in run.summary()["counters"].items() if count})
