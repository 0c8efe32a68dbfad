# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Which beam is the best one for the car, from the camera and the LiDAR beside the panel.

DATA is a merged campaign such as `street`, or a data set. OUT gets results.md, results.json, pictures, the
rankings of all methods (rankings.npz), and the trainings.
"""
from __future__ import annotations

import pathlib
import time
from typing import Dict, List, NamedTuple

import numpy as np
import torch

from tasks.common.command import Context, parser, start
from tasks.common.files import write_whole
from tasks.common.inputs import tensor
from tasks.common.training import Fit
from tasks.street import beams, geometry, inputs, learning
from tasks.street.drives import Drives, open_drives

from . import baselines, measures, outcome
from .settings import Settings

FOLDER = pathlib.Path(__file__).resolve().parent


class Problem(NamedTuple):
    """All that methods are given, and the truth."""

    drives: Drives
    beams: beams.Beams
    power: np.ndarray  #: [n, beam]
    best: np.ndarray  #: int64 [n]
    line_of_sight: np.ndarray  #: bool [n]
    arrays: Dict[str, np.ndarray]  #: inputs by modality, [n, ...]
    split: Dict[str, np.ndarray]  #: items of each part; those of the test have a past of the longest delay


def run() -> None:
    options = parser(__doc__, "folder of a campaign or a data set").parse_args()
    context = start(options, Settings, FOLDER)
    began, cpu = time.perf_counter(), time.process_time()
    problem = prepare(options.data, context.config, context.out)
    scores = score_baselines(problem, context.config)
    fits: Dict[str, List[Fit]] = {}
    for names in context.config.networks:
        title = " + ".join(names)
        scores[title], fits[title] = score_network(problem, names, context)
    ranks = {name: np.stack([measures.ranking(s) for s in of_seeds]) for name, of_seeds in scores.items()}
    path = context.out / "rankings.npz"
    write_whole(path, lambda part: np.savez_compressed(part, items=problem.split["test"], **ranks))
    notes = _notes(problem, context, time.perf_counter() - began, time.process_time() - cpu)
    outcome.report(context, problem, ranks, fits, notes)


def prepare(data: pathlib.Path, config: Settings, out: pathlib.Path) -> Problem:
    """Reads the labels, and makes the inputs that are not there yet."""
    sensors = config.sensors
    drives = open_drives(data, [sensors.camera, sensors.lidar, sensors.channel], config.shares)
    book = beams.codebook_of(drives.sequences[0][sensors.channel], config.oversampling)
    power = beams.powers_of(drives, sensors.channel, book)
    sight = drives.gather(sensors.channel, "line_of_sight")[:, 0, 0] > 0
    makers = {
        "camera": inputs.camera(sensors.camera, config.inputs.camera_px),
        "lidar": inputs.lidar(sensors.lidar, config.inputs.lidar_cells),
    }
    settings = {"camera_px": config.inputs.camera_px, "lidar_cells": config.inputs.lidar_cells}
    arrays = inputs.cached(out / "inputs", drives, makers, settings)
    served = power.max(-1) > 0  # without any path no beam is the best one
    split = {name: items[served[items]] for name, items in drives.split().items()}
    split["test"] = split["test"][drives.order[split["test"]] >= max(config.delays)]
    return Problem(drives, book, power, power.argmax(-1), sight, arrays, split)


def score_baselines(problem: Problem, config: Settings) -> Dict[str, List[np.ndarray]]:
    """Returns the scores of the beams, [test item, beam], of each baseline: a list of one array."""
    train, test, power = problem.split["train"], problem.split["test"], problem.power
    direction = geometry.ends(problem.drives, config.sensors.channel).direction()[test]
    out = {"most frequent beam": baselines.most_frequent(power, train, test)}
    for delay in config.delays:
        out[f"last sweep, {delay} ticks ago"] = baselines.last_sweep(power, problem.drives, test, delay)
    pictures = _coarse(problem.arrays["camera"])
    out["similar pictures"] = baselines.similar_pictures(pictures, power, train, test, config.neighbours)
    out["true position"] = beams.free_space(direction, problem.beams)
    return {name: [score] for name, score in out.items()}


def _coarse(pictures: np.ndarray, rows: int = 16) -> np.ndarray:
    """Returns the means of pictures [n, 3, h, w] over squares, so that some `rows` rows are left."""
    side = max(1, pictures.shape[2] // rows)
    h, w = pictures.shape[2] // side, pictures.shape[3] // side
    out = np.empty((len(pictures), 3, h, w), np.float32)
    for i in range(0, len(pictures), 512):
        part = pictures[i : i + 512, :, : h * side, : w * side].astype(np.float32)
        out[i : i + 512] = part.reshape(-1, 3, h, side, w, side).mean((3, 5))
    return out


def mirrored(batch: Dict[str, torch.Tensor], book: beams.Beams, which: np.ndarray) -> Dict[str, torch.Tensor]:
    """Returns a batch of which some items, bool [n], are seen in a mirror: the cameras, the LiDAR and the
    panel look along one axis, so that right and left change places."""
    chosen = torch.from_numpy(which)
    out = {}
    for name, value in batch.items():
        other = torch.from_numpy(book.mirrored(value.numpy())) if name == "label" else value.flip(-1)
        out[name] = torch.where(chosen.reshape(-1, *[1] * (value.dim() - 1)), other, value)
    return out


def score_network(problem: Problem, names: List[str], context: Context):
    """Trains a network for each seed, and returns its scores on the test items, and the trainings."""

    def gather(items: np.ndarray) -> Dict[str, torch.Tensor]:
        return {name: tensor(problem.arrays[name], items) for name in names}

    def change(batch: Dict[str, torch.Tensor], generator: np.random.Generator) -> Dict[str, torch.Tensor]:
        return mirrored(batch, problem.beams, generator.random(len(batch["label"])) < 0.5)

    classes = len(problem.beams.cosine)
    scores, fits = [], []
    for seed in context.seeds:
        of_mirror = change if context.config.mirror else None
        done = learning.train(context, names, seed, gather, problem.best, classes, problem.split, of_mirror)
        scores.append(learning.predict(done.model, gather, problem.split["test"], context.device))
        fits.append(done)
    return scores, fits


def _notes(problem: Problem, context: Context, seconds: float, cpu: float) -> List[str]:
    split = problem.split
    best = np.bincount(
        problem.best[np.concatenate(list(split.values()))], minlength=len(problem.beams.cosine)
    )
    return [
        *learning.notes(context, problem.drives.drive, split, seconds, cpu),
        f"A test item has {max(context.config.delays)} ticks before it in its drive.  ",
        f"{len(best)} beams, of which {np.count_nonzero(best)} are the best one somewhere, and the most "
        f"frequent one in {100 * best.max() / best.sum():.1f} % of the items; line of sight in "
        f"{100 * problem.line_of_sight[split['test']].mean():.0f} % of the test items.  ",
    ]
