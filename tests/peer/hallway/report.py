# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs one setting, compares it with the measurement, and writes its figures and its picture."""

import dataclasses
import json
import os

from hallway import pictures, predict

#: subcarriers over the band: paths up to 2.5 us long do not wrap, and those of 8 interactions take 1.5 us
SUBCARRIERS = 128


def simulation_of(world, hall, step, sidecar):
    """`sidecar`: the file of the materials."""
    effects = {"diffraction": "off", "scattering": "off", **step.effects}
    return predict.simulation(
        world,
        hall.glb,
        sidecar,
        effects=effects,
        max_depth=step.max_depth,
        max_transmissions=step.walls_passed,
        **step.channel,
    )


def record(options, name, words, score, prediction):
    """Adds a row to OUT/steps.json, which later calls extend."""
    path = options.output / "steps.json"
    rows = json.loads(path.read_text()) if path.is_file() else {}
    rows[name] = {
        "words": words,
        **dataclasses.asdict(score),
        "paths_of_a_link": prediction.paths,
        "wall_s": prediction.wall_s,
    }
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(rows, indent=1) + "\n")
    os.replace(partial, path)


def judge(options, world, sim, name, words, cells, seen=None):
    """Predicts what was measured in the cells (indices), and prints, keeps and draws how far it is off.
    `seen`: the score of other cells, with whose constants these are judged. Returns the score and the
    prediction."""
    found = predict.predict(world, sim, world.cells[cells], places=options.places, subcarriers=SUBCARRIERS)
    score = predict.score(world, found, cells, seen)
    print(f"{name:21} {score}  {found.paths:5.0f} paths {found.wall_s:6.1f} s", flush=True)
    record(options, name, words, score, found)
    pictures.draw(options.output, name, world, found, cells, score)
    return score, found
