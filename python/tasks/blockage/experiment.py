# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a vehicle is about to block the line of sight, from the event camera and the radar at the panel.

DATA is a merged campaign such as `street`, or a data set. OUT gets results.md, results.json, pictures, the
probabilities of all methods (probabilities.npz), and the trainings.
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

from . import baselines, labels, outcome
from .settings import Settings

FOLDER = pathlib.Path(__file__).resolve().parent
FLOOR_DB = -160.0  #: gains below it are taken for it: no receiver measures them


class Problem(NamedTuple):
    """All that methods are given, and the truth."""

    drives: Drives
    line_of_sight: np.ndarray  #: bool [n]
    gain_db: np.ndarray  #: [n]: path gain
    first: np.ndarray  #: int64 [n]: ticks to the first blockage; 0: none, -1: unknown (labels.first_blockage)
    arrays: Dict[str, np.ndarray]  #: inputs of a tick by modality, [n, ...]
    past: int  #: ticks that a prediction sees
    most: int  #: the longest horizon
    split: Dict[str, np.ndarray]  #: items of each part with a past and a known future
    asked: np.ndarray  #: all items of the test with a past and line of sight, also without a known future

    def gather(self, names: List[str], items: np.ndarray) -> Dict[str, torch.Tensor]:
        """Returns the inputs of the last `past` ticks, the oldest first, as channels."""
        out = {}
        for name in names:
            ticks = [tensor(self.arrays[name], items - back) for back in range(self.past)[::-1]]
            out[name] = torch.cat(ticks, 1)
        return out


def run() -> None:
    options = parser(__doc__, "folder of a campaign or a data set").parse_args()
    context = start(options, Settings, FOLDER)
    began, cpu = time.perf_counter(), time.process_time()
    problem = prepare(options.data, context.config, context.out)
    probability = score_baselines(problem, context.config)
    fits: Dict[str, List[Fit]] = {}
    for names in context.config.networks:
        title = " + ".join(names)
        probability[title], fits[title] = score_network(problem, names, context)
    path = context.out / "probabilities.npz"
    write_whole(path, lambda part: np.savez_compressed(part, items=_scored(problem), **probability))
    notes = _notes(problem, context, time.perf_counter() - began, time.process_time() - cpu)
    outcome.report(context, problem, probability, _scored(problem), fits, notes)


def prepare(data: pathlib.Path, config: Settings, out: pathlib.Path) -> Problem:
    """Reads the labels, and makes the inputs that are not there yet."""
    sensors, most = config.sensors, max(config.horizons)
    drives = open_drives(data, [sensors.events, sensors.radar, sensors.channel], config.shares)
    labels.check_steps(drives.tick, drives.drive)
    sight = drives.gather(sensors.channel, "line_of_sight")[:, 0, 0] > 0
    gain = drives.gather(sensors.channel, "path_gain")[:, 0, 0]
    gain_db = _gain_db(gain)
    first = np.concatenate(
        [labels.first_blockage(sight[drives.drive == d], most) for d in range(len(drives.sequences))]
    )
    makers = {
        "events": inputs.events(sensors.events, config.inputs.events_px),
        "radar": inputs.radar(sensors.radar, config.inputs.radar_cells, config.inputs.radar_span_db),
    }
    settings = {"inputs": [list(config.inputs.events_px), list(config.inputs.radar_cells)]}
    settings["span_db"] = config.inputs.radar_span_db
    arrays = inputs.cached(out / "inputs", drives, makers, settings)
    arrays["power"] = gain_db[:, None].astype(np.float32)
    arrays["csi"] = _beams_db(drives, sensors.channel, config.inputs.csi_beams)
    seen = drives.order >= config.past - 1
    split = {name: items[(seen & (first >= 0))[items]] for name, items in drives.split().items()}
    test = drives.split()["test"]
    asked = test[(seen & sight)[test]]
    return Problem(drives, sight, gain_db, first, arrays, config.past, most, split, asked)


def _beams_db(drives: Drives, channel: str, count: int) -> np.ndarray:
    """Returns the gains of `count` evenly spaced beams of the panel's codebook, dB, float32 [n, count]."""
    book = beams.codebook_of(drives.sequences[0][channel], 1)
    chosen = np.linspace(0, len(book.cosine), min(count, len(book.cosine)), endpoint=False).astype(int)
    few = book._replace(weights=book.weights[chosen], cosine=book.cosine[chosen])
    return _gain_db(beams.powers_of(drives, channel, few)).astype(np.float32)


def _gain_db(gain: np.ndarray) -> np.ndarray:
    return np.maximum(10 * np.log10(np.maximum(gain, 1e-30)), FLOOR_DB)


def _scored(problem: Problem) -> np.ndarray:
    """Returns the items that methods are asked for: those of the validation, which sets thresholds, and those
    of the test."""
    return np.concatenate([problem.split["validation"], problem.asked])


def score_baselines(problem: Problem, config: Settings) -> Dict[str, np.ndarray]:
    """Returns the probabilities [1, item, step] of each baseline."""
    items, drives = _scored(problem), problem.drives
    rate = drives.sequences[0].dataset.tick_rate_hz
    step_s = float(labels.check_steps(drives.tick, drives.drive) / rate)
    link = geometry.ends(drives, config.sensors.channel)
    receiver = geometry.receiver_node(drives, config.sensors.channel)
    others = [body for body in geometry.bodies(drives) if body.node != receiver]
    return {
        "base rate": baselines.base_rate(problem.first, problem.split["train"], items, problem.most)[None],
        "true motion, straight on": baselines.straight_on(link, others, items, problem.most, step_s)[None],
    }


def score_network(problem: Problem, names: List[str], context: Context):
    """Trains a network for each seed. Its classes are the ticks up to the first blockage, and none. Returns
    its probabilities [seed, item, step], and the trainings."""

    def gather(items: np.ndarray) -> Dict[str, torch.Tensor]:
        return problem.gather(names, items)

    def change(batch: Dict[str, torch.Tensor], generator: np.random.Generator) -> Dict[str, torch.Tensor]:
        return mirrored(batch, generator.random(len(batch["label"])) < 0.5, problem.past)

    probability, fits = [], []
    for seed in context.seeds:
        of_mirror = change if context.config.mirror else None
        done = learning.train(
            context, names, seed, gather, problem.first, problem.most + 1, problem.split, of_mirror
        )
        logits = learning.predict(done.model, gather, _scored(problem), context.device)
        probability.append(within(logits))
        fits.append(done)
    return np.stack(probability), fits


def mirrored(batch: Dict[str, torch.Tensor], which: np.ndarray, past: int) -> Dict[str, torch.Tensor]:
    """Returns a batch of which some items, bool [n], are seen in a mirror: the event camera, the radar and
    the panel look along one axis, so that right and left change places. Powers, range-velocity maps and
    labels stay what they are."""
    chosen = torch.from_numpy(which)
    out = {}
    for name, value in batch.items():
        other = value
        if name == "events":
            other = value.flip(-1)
        elif name == "radar":
            azimuth = (torch.arange(value.shape[1]) % 2 == 0).reshape(1, -1, 1, 1)
            other = torch.where(azimuth, value.flip(-1), value)
        elif name == "csi":
            beams = value.reshape(len(value), past, -1)
            other = beams[:, :, -torch.arange(beams.shape[2]) % beams.shape[2]].reshape(value.shape)
        out[name] = torch.where(chosen.reshape(-1, *[1] * (value.dim() - 1)), other, value)
    return out


def within(logits: np.ndarray) -> np.ndarray:
    """Returns the probability of a blockage within 1, 2, ... ticks [n, step] from the logits of the classes
    none, 1, 2, ... [n, step + 1]."""
    share = np.exp(logits.astype(np.float64) - logits.max(1, keepdims=True))
    return np.cumsum(share[:, 1:], 1) / share.sum(1, keepdims=True)


def _notes(problem: Problem, context: Context, seconds: float, cpu: float) -> List[str]:
    test = problem.first[problem.split["test"]]
    rates = ", ".join(
        f"{100 * np.mean((test > 0) & (test <= k)):.1f} % within {k}" for k in context.config.horizons
    )
    return [
        *learning.notes(context, problem.drives.drive, problem.split, seconds, cpu),
        f"An item is a tick with line of sight, {problem.past - 1} ticks before it and {problem.most} after "
        f"it in its drive. Blocked of the test items: {rates} ticks.  ",
    ]
