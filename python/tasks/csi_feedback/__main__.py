# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""CSI feedback: CsiNet and CRNet on channels of one domain, tried on others.

    python3 python/tasks/csi_feedback out/csi -o out/csi_feedback --small

DATA is a folder of channel sets (make.py, make_sionna.py, impair.py). docs/learning.md explains the task."""
from __future__ import annotations

import pathlib
import sys
import time
from typing import Any, Dict, List

if __package__ in (None, ""):
    # Behind PYTHONPATH, which names the folder of the greatx that has the compiled module.
    sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))
    __package__ = "tasks.csi_feedback"

from greatx.errors import Error

from ..common import command, report
from ..common.models import macs, parameters
from . import dichasus, results
from .experiment import Config, Source, Split, existing, source_scores, split, target_scores
from .models import NETWORKS
from .sets import load

HERE = pathlib.Path(__file__).resolve().parent


def targets(options: Any, config: Config) -> "tuple[Dict[str, Split], List[str]]":
    """Returns the domains to try, and sentences about those that are not there."""
    there, missing = existing(options.data, config.targets)
    splits = {name: split(load(options.data / name), config) for name in there}
    notes = [f"{options.data / name} is not there, so this domain was not tried." for name in missing]
    if options.dichasus is not None:
        measured = dichasus.read_folder(options.dichasus, options.array, options.every)
        splits["measured"] = split(measured, config)
    return splits, notes


def network_sizes(config: Config) -> List[Dict[str, Any]]:
    """Returns the numbers of parameters and multiply-adds of the networks."""
    import torch

    picture = torch.zeros(1, 2, 32, 32)
    rows = []
    for name, make in NETWORKS.items():
        for size in config.sizes:
            net = make(size)
            rows.append(
                {"network": name, "size": size, "parameters": parameters(net), "macs": macs(net, picture)}
            )
    return rows


def run() -> None:
    parser = command.parser(__doc__, "folder of channel sets")
    parser.add_argument("--dichasus", type=pathlib.Path, metavar="DIR", help="try DICHASUS tfrecords, too")
    parser.add_argument("--array", type=int, default=0, help="number of the array in their spec.json (0)")
    parser.add_argument("--every", type=int, default=1, help="take every so many of their records (1)")
    options = parser.parse_args()
    if options.every < 1:
        raise Error(f"--every: expected 1 or more, found {options.every}")
    context = command.start(options, Config, HERE)
    config: Config = context.config
    began, cpu = time.perf_counter(), time.process_time()
    data = split(load(options.data / config.source), config)
    domains, notes = targets(options, config)
    source = Source(context, data)
    rows = results.source_results(source_scores(source), data, config)
    tables = [results.source_table(rows, f"{data.channels.name}: users in places that no training saw")]
    pictures = [context.out / "nmse.png"]
    results.draw_source(pictures[0], rows, f"{data.channels.name}, {len(data.test)} users")
    found: Dict[str, List[Dict[str, Any]]] = {}
    for name, domain in domains.items():
        found[name] = results.target_results(target_scores(source, name, domain), domain, config)
    if found:
        tables.append(results.target_table(found, config.transfer.size))
        if len(config.transfer.users) > 1:
            pictures.append(context.out / "transfer.png")
            results.draw_targets(pictures[1], found, config.transfer.users)
    notes.append(
        f"Size: {context.preset}; {len(data.train)} users for training, {len(data.test)} for the test; seeds "
        f"{', '.join(map(str, context.seeds))}; {(time.process_time() - cpu) / 60:.1f} minutes of CPU, "
        f"{(time.perf_counter() - began) / 60:.1f} minutes in all."
    )
    everything = {
        "machine": command.machine(context.device),
        "source": {"domain": results.describe(data), "methods": rows},
        "targets": {n: {"domain": results.describe(domains[n]), "methods": found[n]} for n in found},
        "networks": network_sizes(config),
        "seeds": context.seeds,
        "notes": notes,
    }
    report.write(context.out, "CSI feedback", everything, tables, pictures, notes)


if __name__ == "__main__":
    command.main(run)
