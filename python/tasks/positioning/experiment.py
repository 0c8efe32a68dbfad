# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Positioning of a drone from camera, depth, CSI, LiDAR, radar and events.

For each seed: a teacher with all modalities, a student with CSI alone, and the same student with the
teacher's knowledge; beside them k nearest neighbours of the CSI and the mean position. DATA is a campaign
(greatx campaign run and merge) or a data set. Modalities that it lacks are left out. The same command goes on
after an interruption.
"""
from __future__ import annotations

import argparse
import pathlib
import time
from typing import Any, Dict, List

import numpy as np
import torch

import greatx
from tasks.common.command import Context, machine, parser, start
from tasks.common.progress import duration

from . import cost, results
from .cache import Cached, cached
from .distillation import Frame
from .floors import mean_errors, neighbour_errors
from .records import Records, find
from .settings import STUDENT, Config
from .training import Data, asked, positions_m, subset_errors_m, train_student, train_teacher

FOLDER = pathlib.Path(__file__).resolve().parent


def run() -> None:
    """Runs the command."""
    options = arguments().parse_args()
    context = start(options, Config, FOLDER)
    opened = greatx.load(options.data)
    records = find(opened, context.config.modalities)
    for name in records.absent:
        print(f"{options.data}: has no {name}, which is left out of this run", flush=True)
    if options.measure is not None:
        return cost.measure(context, records, opened, options.measure)
    folder = options.cache or context.out / "cache"
    inputs = cached(folder, opened, records, context.config.inputs)
    print(
        f"inputs: {len(records)} records, {inputs.bytes / 1e6:.0f} MB in {folder}, made in "
        f"{duration(inputs.seconds)}",
        flush=True,
    )
    data = gather(context, records, inputs)
    results.report(context, records, data, inputs, experiment(context, data))


def arguments() -> argparse.ArgumentParser:
    out = parser(__doc__, "a campaign or a data set")
    out.add_argument(
        "--cache", type=pathlib.Path, help="folder of the networks' inputs (OUT/cache), which runs may share"
    )
    out.add_argument(
        "--measure",
        type=int,
        metavar="STEPS",
        help="trains for so many steps on random inputs, says what the whole run would take, and ends",
    )
    return out


def gather(context: Context, records: Records, inputs: Cached) -> Data:
    """Splits the records, and standardises positions by those of the training part."""
    parts = records.split(context.config.split)
    position = torch.from_numpy(records.position_m)
    return Data(
        arrays=inputs.arrays,
        present=torch.from_numpy(records.present),
        position_m=position,
        parts=parts,
        frame=Frame.of(position[parts["train"]]),
        config=context.config,
        device=context.device,
        tensorboard=context.tensorboard,
    )


def subsets(modalities: List[str]) -> Dict[str, List[str]]:
    """Returns the subsets that are tested, by title: all, each alone, all but one."""
    out = {"all": list(modalities)}
    if len(modalities) > 1:
        out.update({f"{name} alone": [name] for name in modalities})
    if len(modalities) > 2:
        out.update({f"all but {name}": [m for m in modalities if m != name] for name in modalities})
    return out


def experiment(context: Context, data: Data) -> Dict[str, Any]:
    """Trains and tests everything, and returns errors on the test part [seeds, records], m, the positions of
    the first seed [records, 3], m, and the times.
    """
    out: Dict[str, Any] = {"floors": floors(data), "weights": []}
    out.update({name: {} for name in ("subsets", "students", "fits", "positions")})
    test = data.parts["test"]
    for seed in context.seeds:
        folder = context.out / f"seed_{seed}"
        teacher = train_teacher(folder / "teacher", data, seed)
        errors, weights = subset_errors_m(teacher.model, data, test, subsets(data.modalities))
        for title, values in errors.items():
            out["subsets"].setdefault(title, []).append(values)
        out["weights"].append(weights)
        began = time.process_time()
        targets = asked(teacher.model, data, data.parts["train"])
        asking = time.process_time() - began
        fits = {
            "teacher": teacher,
            "student alone": train_student(folder / "student_alone", data, seed, None),
            "student distilled": train_student(folder / "student_distilled", data, seed, targets),
        }
        for name in ("student alone", "student distilled"):
            positions = positions_m(fits[name].model, data, test)
            errors = np.linalg.norm(positions - data.position_m[test].numpy(), axis=1)
            out["students"].setdefault(name, []).append(errors)
            out["positions"].setdefault(name, positions)
        if "teacher" not in out["positions"]:
            out["positions"]["teacher"] = positions_m(teacher.model, data, test)
        for name, fitted in fits.items():
            more = asking if name == "student distilled" else 0.0
            out["fits"].setdefault(name, []).append(
                {"epochs": fitted.epochs, "seconds": fitted.seconds, "cpu_seconds": fitted.cpu_seconds + more}
            )
    out["machine"] = machine(context.device)
    return out


def floors(data: Data) -> Dict[str, Any]:
    """Returns the errors [test records] of what does not learn, m, and the number of neighbours."""
    parts = [data.parts[name] for name in ("train", "validation", "test")]
    positions = tuple(data.position_m[rows].numpy() for rows in parts)
    began = time.process_time()
    # The level of the map in dB, which no phase changes.
    level = tuple(
        np.asarray(data.arrays[STUDENT][rows, 2]).reshape(len(rows), -1).astype(np.float32) for rows in parts
    )
    errors, k = neighbour_errors(level, positions, data.config.most_neighbours)
    return {
        "mean position": mean_errors(positions[0], positions[2]),
        "nearest neighbours": errors,
        "k": k,
        "cpu_seconds": time.process_time() - began,
    }
