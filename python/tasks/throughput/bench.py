# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs all measurements, and writes their tables and their picture."""
from __future__ import annotations

import os
import pathlib
import sys
from typing import Any, Dict, List

import numpy as np

from tasks.common import command, plots, report

from . import generated, loaders, loops, streams
from .settings import Config, modalities

FOLDER = pathlib.Path(__file__).resolve().parent


def run() -> None:
    """Measures how fast items reach a network: from data sets of each kind of storage with each number of
    workers, and straight from the engine; and how long a training waits for them.

    The data sets are made first (docs/learning.md). Nothing else should run on the machine: the tables give
    the load beside each figure, and the processor time of an item, which depends on it little.
    """
    options = command.parser(run.__doc__ or "", None).parse_args()
    context = command.start(options, Config, FOLDER)
    config: Config = context.config
    wanted = modalities(config.inputs)
    results: Dict[str, Any] = {
        "machine": {**command.machine(context.device), "cores": os.cpu_count()},
        "storage": {},
        "loader": [],
    }
    datasets = {s: generated.generate(context.out, config.data, s) for s in config.data.storage}
    for storage, dataset in datasets.items():
        progress(f"storage {storage}: where the time goes")
        results["storage"][storage] = {
            "parts": loaders.parts(dataset, wanted),
            "whole_ms": loaders.whole(dataset, wanted, config.loader.batch),
        }
        for workers in config.loader.workers:
            progress(f"storage {storage}: {workers} workers")
            measured = loaders.speed(dataset, wanted, config.loader, workers)
            results["loader"].append(
                {"way": "greatx.batches", "storage": storage, "workers": workers, **measured}
            )
    first = config.data.storage[0]
    for workers in config.loader.workers:
        progress(f"torch's own collation: {workers} workers")
        measured = loaders.speed_of_torch(datasets[first], wanted, config.loader, workers)
        results["loader"].append({"way": "DataLoader", "storage": first, "workers": workers, **measured})
    progress("stream")
    results["stream"] = streams.speed(wanted, config.data, config.stream)
    progress("training")
    results["training"] = loops.training(
        datasets[first], wanted, config.loader, config.training, context.device
    )
    picture(context.out / "parts.png", results)
    report.write(
        context.out,
        f"Throughput ({context.preset})",
        results,
        tables(results),
        [context.out / "parts.png"],
        notes(results, config),
    )


def progress(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def notes(results: Dict[str, Any], config: Config) -> List[str]:
    machine = results["machine"]
    return [
        f"{machine['device']}, {machine['cores']} cores, torch {machine['torch']}, numpy {np.__version__}, "
        f"Python {machine['python']}, greatx {machine['greatx']}.",
        f"Batches of {config.loader.batch}, data sets of {config.data.sequences * config.data.ticks} items.",
    ]


def tables(results: Dict[str, Any]) -> List[report.Table]:
    return [
        loader_table(results["loader"]),
        parts_table(results["storage"]),
        stream_table(results["stream"]),
        training_table(results["training"]),
    ]


def loader_table(rows: List[Dict[str, Any]]) -> report.Table:
    return report.Table(
        "Loader: median of epochs (least to most)",
        [
            "by",
            "storage",
            "workers",
            "items/s",
            "processor time, ms an item",
            "items/s of two free cores",
            "load",
        ],
        [
            [
                row["way"],
                row["storage"],
                row["workers"],
                row["items_per_s"].text(),
                row["cpu_ms"].text(2),
                f"{2e3 / row['cpu_ms'].median:.0f}",
                f"{row['load']:.1f}",
            ]
            for row in rows
        ],
    )


def parts_table(storages: Dict[str, Any]) -> report.Table:
    rows = []
    for storage, found in storages.items():
        for name, part in found["parts"].items():
            rows.append(
                [storage, name, f"{part['bytes'] / 1e3:.1f}", f"{part['read']:.2f}", f"{part['make']:.2f}"]
            )
        total = {key: sum(part[key] for part in found["parts"].values()) for key in ("bytes", "read", "make")}
        rows.append(
            [storage, "all", f"{total['bytes'] / 1e3:.1f}", f"{total['read']:.2f}", f"{total['make']:.2f}"]
        )
        rows.append([storage, "a whole item in a batch", "", "", f"{found['whole_ms']:.2f}"])
    return report.Table(
        "Where the time of an item goes (one process, random order)",
        ["storage", "modality", "kB on disk", "read and decode, ms", "make the input, ms"],
        rows,
    )


def stream_table(stream: Dict[str, Any]) -> report.Table:
    return report.Table(
        "Straight from the engine",
        [
            "items",
            "items/s",
            "processor time, ms an item",
            "first item, s",
            "resume with a full buffer, s",
            "load",
        ],
        [
            [
                stream["items"],
                f"{stream['items_per_s']:.2f}",
                f"{stream['cpu_ms']:.0f}",
                f"{stream['first_item_s']:.1f}",
                f"{stream['resume_s']:.1f}, {'the same item' if stream['resume_same'] else 'ANOTHER ITEM'}",
                f"{stream['load']:.1f}",
            ]
        ],
    )


def training_table(training: Dict[str, Any]) -> report.Table:
    return report.Table(
        "A training loop, per item",
        [
            "parameters",
            "multiply-adds",
            "waits, ms",
            "network, ms",
            "share of waiting",
            "processor time of the network, ms",
            "of the loader, ms",
            "load",
        ],
        [
            [
                f"{training['parameters'] / 1e6:.2f} M",
                f"{training['macs'] / 1e6:.0f} M",
                f"{training['wait_ms']:.2f}",
                f"{training['network_ms']:.1f}",
                f"{100 * training['wait_share']:.1f} %",
                f"{training['network_cpu_ms']:.1f}",
                f"{training['loader_cpu_ms']:.2f}",
                f"{training['load']:.1f}",
            ]
        ],
    )


def picture(path: pathlib.Path, results: Dict[str, Any]) -> None:
    """Draws where the processor time of an item goes, by storage."""
    storages = results["storage"]
    names = list(next(iter(storages.values()))["parts"])
    with plots.figure(path) as axes:
        left = np.zeros(len(storages))
        for what, alpha in (("read", 1.0), ("make", 0.5)):
            for i, name in enumerate(names):
                values = np.array([found["parts"][name][what] for found in storages.values()])
                label = f"{name}: {'read and decode' if what == 'read' else 'make the input'}"
                axes.barh(list(storages), values, left=left, color=f"C{i}", alpha=alpha, label=label)
                left += values
        axes.invert_yaxis()
        axes.set(xlabel="processor time of an item, ms", ylabel="storage", title="Where the time goes")
        axes.legend(fontsize=7, ncol=2, loc="upper center", bbox_to_anchor=(0.5, -0.18))
