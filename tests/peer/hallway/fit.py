# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Calibrates the hallway's materials by `greatx calibrate` on the cells of one half of a checkerboard, and
scores them on the other half.
"""

import csv
import subprocess
import time

import numpy as np

from hallway import measured as m
from hallway import predict, report, steps

#: side of a field of the checkerboard, m
BLOCK_M = 4.0
#: positions in a cell whose powers the fit compares with that of the cell
PLACES = 2
#: subcarriers over the band at which the fit computes H; paths up to 0.3 us do not wrap
SUBCARRIERS = 16

#: what may change: materials, property, layer, bounds, what is known beforehand, and its relative deviation.
#: The panes at the ends keep their thickness: powers hardly tell it.
SIDES = ["east", "west", "side_rooms"]
PARAMETERS = [
    (SIDES, "thickness", 0, (0.006, 0.03), 0.0125, 0.2),
    (SIDES, "thickness", 1, (0.03, 0.2), 0.075, 0.3),
    (SIDES, "permittivity", 0, (1.5, 5.0), 2.73, 0.2),
    (["floor"], "thickness", 0, (0.02, 0.06), 0.038, 0.15),
    (["floor"], "thickness", 1, (0.05, 0.5), 0.2, 0.4),
    (["ceiling"], "permittivity", 0, (1.1, 3.0), 1.48, 0.1),
    (["ceiling"], "thickness", 1, (0.1, 0.6), 0.3, 0.3),
]


def layer(permittivity, conductivity, thickness_m):
    return {
        "relative_permittivity": permittivity,
        "conductivity": conductivity,
        "thickness_m": thickness_m,
    }


BOARD, GLASS = layer(2.73, 0.027, 0.0125), layer(6.31, 0.019, 0.004)
CONCRETE = layer(5.24, 0.121, 0.2)
#: where the fit begins: the step "raised". The media are those of ITU-R P.2040 at the carrier.
START = {
    "walls": {"layers": [BOARD, steps.air(0.075), BOARD]},
    "north": {"layers": [GLASS]},
    "south": {"layers": [GLASS]},
    "floor": {"layers": [layer(2.58, 0.057, 0.038), steps.air(0.2), CONCRETE]},
    "ceiling": {"layers": [layer(1.48, 0.0042, 0.02), steps.air(0.3), CONCRETE]},
}


def antenna(name, pattern, rows=1, columns=1):
    fields = f"pattern: {pattern}, polarization: v, rows: {rows}, columns: {columns}"
    return f"{{name: {name}, type: antenna, {fields}}}"


def write_scenario(world, hall, sidecar, folder):
    nodes = ""
    for number, place in enumerate(world.arrays, 1):
        yaw = np.degrees(np.arctan2(place.along[1], place.along[0]))
        nodes += (
            f"  - name: array{number}\n"
            f"    trajectory: {{type: static, position_m: {place.center.tolist()}, "
            f"rotation_deg: [{yaw:g}, 0, 0]}}\n"
            f"    sensors: [{antenna('panel', 'tr38901', 4, 8)}]\n"
        )
    nodes += (
        f"  - name: robot\n    trajectory: {{type: static, position_m: [1, 5, {m.ROBOT_HEIGHT_M}]}}\n"
        f"    sensors: [{antenna('dipole', 'short_dipole')}]\n"
    )
    path = folder / "hallway.yaml"
    path.write_text(
        f"greatx: 1\nname: hallway\nticks: 1\ntick_rate_hz: 10\n"
        f"scene: {{file: {hall.glb.resolve()}, radio_materials: {sidecar.resolve()}}}\n"
        f"effects: {{diffraction: off, scattering: off}}\nnodes:\n{nodes}"
        f"channels:\n  - {{name: csi, tx: [array1/panel, array2/panel], rx: [robot/dipole], rate_hz: 10, "
        f"carrier_hz: {m.CARRIER_HZ:g}, bandwidth_hz: {m.BANDWIDTH_HZ:g}, subcarriers: {m.SUBCARRIERS}, "
        f"max_depth: 5, max_transmissions: 3}}\n"
    )
    return path


def write_table(path, column, points, values):
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["x_m", "y_m", "z_m", column])
        rows.writerows([*(f"{p:.17g}" for p in point), f"{v:.17g}"] for point, v in zip(points, values))


def write_fit(world, cells, scenario, folder):
    """Writes the description of the fit."""
    points = predict.places_in_cells(world.cells[cells], PLACES).reshape(-1, 3)
    band = f"subcarriers: {SUBCARRIERS}, subcarrier_spacing_hz: {m.BANDWIDTH_HZ / SUBCARRIERS:g}"
    search = "seed: 1\nstarts: 1\niterations: 40"
    lines = [f"greatx_fit: 1\nscenario: {scenario.resolve()}\nchannel: csi\n{search}\nmeasurements:\n"]
    for number in range(len(world.arrays)):
        write_table(
            folder / f"power{number + 1}.csv",
            "power_db",
            points,
            np.repeat(world.power_db[number, cells], PLACES),
        )
        to = f"transmitter: array{number + 1}/panel, receiver: robot/dipole"
        lines.append(
            f"  - {{name: power{number + 1}, file: power{number + 1}.csv, quantity: power_db, {to}, "
            f"average: coherent, {band}}}\n"
        )
    lines.append("unknown:\n  scale_db: {bounds: [-20, 20], each: all}\nparameters:\n")
    for materials, name, number, (low, high), mean, deviation in PARAMETERS:
        lines.append(
            f"  - {{material: [{', '.join(materials)}], property: {name}, layer: {number}, "
            f"bounds: [{low}, {high}], prior: {{mean: {mean}, sigma: {deviation}}}, log: true}}\n"
        )
    lines.append("loss: {kind: huber, scale: 1.345}\nsplit: {held_out: 0}\n")
    path = folder / "fit.yaml"
    path.write_text("".join(lines))
    return path


def fit(options, world, hall_of, cells):
    step = steps.Step("start", "", START, 5, 3)
    hall = hall_of(step)
    side = world.blocks(BLOCK_M)[cells]
    parts = cells[side == 0], cells[side == 1]
    print(f"fit: {len(parts[0])} cells, held out: {len(parts[1])}, fields of {BLOCK_M:g} m", flush=True)
    start = hall.write_materials("start", START)
    judge(options, world, hall, step, "start", start, parts)
    folder = options.output / "fit"
    folder.mkdir(parents=True, exist_ok=True)
    scenario = write_scenario(world, hall, start, folder)
    description = write_fit(world, parts[0], scenario, folder)
    program, begin = options.build.resolve() / "greatx", time.perf_counter()
    subprocess.run([program, "calibrate", "-q", description, "-o", folder / "result"], check=True)
    print(f"fitted in {time.perf_counter() - begin:.0f} s", flush=True)
    judge(options, world, hall, step, "fitted", folder / "result/materials.yaml", parts)


def judge(options, world, hall, step, name, sidecar, parts):
    """Scores materials on the cells that a fit sees and, with their constant, on those that it does not."""
    sim = report.simulation_of(world, hall, step, sidecar)
    score = None
    for half, part in zip(("seen", "held_out"), parts):
        words = f"{name}, cells that are {half}"
        score, _ = report.judge(options, world, sim, f"{name}_{half}", words, part, score)
