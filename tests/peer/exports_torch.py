# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a campaign by torch's DataLoader, with workers by fork and by spawn, in order and shuffled, and the
shards of `greatx.convert webdataset` by wids, which needs torch.

    python3 tests/peer/exports_torch.py

It makes a campaign of its own, whose third cell lacks a sensor, prints counts and items per second, and exits
with 1 if an item is missing, comes twice or has other values than the data set.
"""

import collections
import json
import subprocess
import sys
import time

from environment import Worst
from exports_setup import main

PACKAGES = ("torch==2.15.0", "numpy", "webdataset==0.2.111")
BASE = """
greatx: 1
name: base
ticks: 6
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [1, -20, 6]}
    sensors: [{name: a, type: antenna}]
  - name: uav
    trajectory: {type: bezier, box: {min_m: [-3, -15, 3], max_m: [3, 15, 8]}}
    sensors:
      - {name: a, type: antenna}
      - {name: cam, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, outputs: [rgb, depth]}
channels:
  - {name: csi, tx: bs/a, rx: [uav/a], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 64, max_depth: 2}
"""
CAMPAIGN = """
greatx_campaign: 1
name: small
base: base.yaml
sequences: 8
axes:
  light:
    day: {}
    dusk: {environment: {sun: {elevation_deg: 3}}}
    without: {"nodes[uav].sensors": [{name: a, type: antenna}]}
split: {train: 0.5, validation: 0.25, test: 0.25}
"""


def keys(batches):
    for batch in batches:
        for cell, sequence, tick in zip(batch["cell"], batch["sequence"], batch["tick"]):
            yield cell, int(sequence), int(tick)


def check_wids(data, out, worst):
    import numpy as np
    import wids
    from greatx.convert.webdataset import write_webdataset

    write_webdataset(data, out, shard_mb=0.5)
    ticks = [tick for sequence in data.sequences for tick in sequence]
    index = wids.ShardListDataset(
        str(out / "index.json"), transformations=[], cache_dir=str(out / "cache"), keep=True
    )
    worst.add("wids: samples", abs(len(index) - len(ticks)), 0)
    for i in np.random.default_rng(1).permutation(len(ticks)):
        sample = index[int(i)]
        worst.add("wids: ticks", abs(json.loads(sample[".json"].read())["tick"] - ticks[i].tick), 0)
        found = np.load(sample[".poses.position.npy"])
        worst.differs("wids: .npy", found, ticks[i]["poses"].position)


def check(folder, data_sets, program):
    import greatx
    import numpy as np
    import torch

    (folder / "base.yaml").write_text(BASE)
    (folder / "small.yaml").write_text(CAMPAIGN)
    for command in ("run", "merge"):
        subprocess.run(
            [program, "campaign", command, folder / "small.yaml", "-o", folder / "out", "-q"], check=True
        )
    worst = Worst()
    campaign = greatx.load(folder / "out")
    names = ["csi/cfr", "uav/cam/rgb", "csi/paths/delay"]
    options = {"split": "train", "missing": "none", "pad": True}
    wanted = collections.Counter(
        (i["cell"], i["sequence"], i["tick"]) for i in campaign.samples(names, **options)
    )
    rates = {}
    for method in ("fork", "spawn"):
        for persistent in (False, True):
            loading = {
                "batch_size": 4,
                "num_workers": 3,
                "multiprocessing_context": method,
                "persistent_workers": persistent,
            }
            ordered = torch.utils.data.DataLoader(campaign.torch(names, **options), shuffle=True, **loading)
            shuffled = campaign.torch_shuffled(names, seed=3, buffer=16, **options)
            stream = torch.utils.data.DataLoader(shuffled, **loading)
            orders = []
            for epoch in range(3):
                shuffled.set_epoch(epoch)
                begin = time.perf_counter()
                orders.append(tuple(keys(stream)))
                rates[f"{method}{', persistent' * persistent}, epoch {epoch}"] = len(orders[-1]) / (
                    time.perf_counter() - begin
                )
                for found in (orders[-1], tuple(keys(ordered))):
                    worst.add(
                        "items of an epoch that are missing or twice",
                        sum((wanted - collections.Counter(found)).values())
                        + abs(len(found) - sum(wanted.values())),
                        0,
                    )
            worst.add("epochs of one order", 3 - len(set(orders)), 0)
            shuffled.set_epoch(0)
            worst.add(
                "an epoch that is repeated in another order", float(tuple(keys(stream)) != orders[0]), 0
            )
    for batch in torch.utils.data.DataLoader(campaign.torch(names, **options), batch_size=5):
        for i, cell in enumerate(batch["cell"]):
            sequence = campaign[cell].sequences[int(batch["sequence"][i])]
            tick = sequence.at(int(batch["tick"][i]))
            worst.differs("channels", batch["csi/cfr"][i].numpy(), tick["csi"].cfr)
            there = bool(batch["uav/cam/rgb_present"][i])
            worst.add("masks", float(there != ("uav/cam" in tick)), 0)
            picture = tick["uav/cam"].rgb if there else np.zeros((48, 64, 3), np.uint8)
            worst.differs("pictures", batch["uav/cam/rgb"][i].numpy(), picture)
    for name, path in data_sets.items():
        check_wids(greatx.load(path), folder / f"{name}_webdataset", worst)
    print(f"torch {torch.__version__}: {sum(wanted.values())} items; items/s:")
    print({key: round(value) for key, value in rates.items()})
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.exit(main(__file__, check, "exports_torch", PACKAGES))
