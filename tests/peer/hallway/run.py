# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the steps of the hallway, and its fit."""

import dataclasses

import numpy as np

from hallway import fit, measured, model, report, steps


def chosen(names):
    known = {step.name: step for step in steps.STEPS}
    wanted = list(known) if names is None else names.split(",")
    unknown = [name for name in wanted if name not in known]
    if unknown:
        raise SystemExit(f"--steps: expected some of {', '.join(known)}, found {', '.join(unknown)}")
    return [known[name] for name in wanted]


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
        hall = hall_of(step)
        sim = report.simulation_of(world, hall, step, hall.write_materials(step.name, step.materials))
        _, found = report.judge(options, world, sim, step.name, step.words, cells)
        np.savez_compressed(options.output / f"{step.name}.npz", **dataclasses.asdict(found))
    if options.fit:
        fit.fit(options, world, hall_of, cells)
    return 0
