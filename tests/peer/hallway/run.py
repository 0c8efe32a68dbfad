# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the steps of the hallway and writes their figures and pictures."""

import dataclasses
import json
import os

import numpy as np

from hallway import measured, model, pictures, predict, steps

#: subcarriers over the band: paths up to 2.5 us long do not wrap, and those of 8 interactions take 1.5 us
SUBCARRIERS = 128


def chosen(names):
    known = {step.name: step for step in steps.STEPS}
    wanted = list(known) if names is None else names.split(",")
    unknown = [name for name in wanted if name not in known]
    if unknown:
        raise SystemExit(f"--steps: expected some of {', '.join(known)}, found {', '.join(unknown)}")
    return [known[name] for name in wanted]


def simulation_of(world, hall, step, materials=None):
    sidecar = hall.write_materials(step.name, step.materials) if materials is None else materials
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


def run(options):
    world = measured.Measured(options.folder)
    options.output.mkdir(parents=True, exist_ok=True)
    program = options.build.resolve() / "greatx"
    halls = {}

    def hall_of(step):
        if step.floor_m not in halls:
            folder = options.output / f"model_{step.floor_m:g}"
            halls[step.floor_m] = model.Hall(world, folder, program, step.floor_m)
        return halls[step.floor_m]

    cells = np.arange(0, len(world.cells), options.every)
    print(
        f"{len(cells)} of {len(world.cells)} cells, {options.places} positions in each, 2 arrays of 32 "
        "elements.\nErrors of the power of a cell: median, mean, three quarters. Delay spread: quartiles "
        f"(measured: {', '.join(f'{q:.1f}' for q in world.delay_spread_ns.quantile([0.25, 0.5, 0.75]))} ns)."
    )
    for step in [] if options.fit and options.steps is None else chosen(options.steps):
        sim = simulation_of(world, hall_of(step), step)
        found = predict.predict(
            world, sim, world.cells[cells], places=options.places, subcarriers=SUBCARRIERS
        )
        score = predict.score(world, found, cells)
        print(f"{step.name:21} {score}  {found.paths:5.0f} paths {found.wall_s:6.1f} s", flush=True)
        np.savez_compressed(options.output / f"{step.name}.npz", **dataclasses.asdict(found))
        record(options, step.name, step.words, score, found)
        pictures.draw(options.output, step.name, world, found, cells, score)
    if options.fit:
        from hallway import fit  # it uses this module

        fit.fit(options, world, hall_of, cells)
    return 0
