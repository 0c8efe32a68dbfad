# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Compares radio maps: 300 x 300 cells of 1 m, depth 3, one transmitter, isotropic and vertical at both
ends."""
import json
import shutil
import subprocess

import numpy as np

CENTER, SIZE, HEIGHT = (60.0, -80.0), 300.0, 1.5


def greatx_map(table):
    """Returns (process figures, gain in dB [rows, columns]) of `greatx map`, or None if there is no such
    command."""
    from sionna_table import process

    commands = subprocess.run([table.program, "--help"], capture_output=True, text=True).stdout
    if not any(line.split()[:1] == ["map"] for line in commands.splitlines()):
        return None
    folder = table.options.work / "map"
    shutil.rmtree(folder, ignore_errors=True)
    low, high = ([c + side * SIZE / 2 for c in CENTER] for side in (-1, 1))
    words = [
        table.program,
        "map",
        table.greatx.scenario(table.case, table.receivers[:1]),
        "--assets",
        table.greatx.scenes,
        "-o",
        folder,
        "--plane",
        HEIGHT,
        "--min",
        *low,
        "--max",
        *high,
        "--cell",
        1,
        "--no-pictures",
        "--quantities",
        "path_gain",
        "--inside",
        "--json",
    ]
    output, wall, cpu, peak = process(words)
    with np.errstate(divide="ignore"):
        gain = 10 * np.log10(np.load(folder / "path_gain.npy").reshape(int(SIZE), int(SIZE)))
    return {"wall_s": wall, "cpu_s": cpu, "peak_mib": peak, "json": json.loads(output)}, gain


def rows(table):
    ours = greatx_map(table)
    cells = int(SIZE)
    table.say(f"Radio map, {cells} x {cells} cells of 1 m at {HEIGHT} m, etoile, depth 3, opaque walls:")
    table.say()
    table.say(
        "| | whole process | in a warm process | CPU | cells with power "
        "| beside greatx: median, 95 % of abs(dB) |"
    )
    table.say("|---|---|---|---|---|---|---|")
    if ours:
        lit = int(np.isfinite(ours[1]).sum())
        table.say(
            f"| greatx map (each cell's centre, exact paths) | {ours[0]['wall_s']:.1f} s | – "
            f"| {ours[0]['cpu_s']:.0f} s | "
            f"{lit} | – |"
        )
    else:
        table.say("| greatx map | not built | | | | | |")
    for samples in (1e6, 1e7) if table.options.quick else (1e6, 1e7, 1e8):
        file = table.options.work / "sionna_map.npy"
        got = table.sionna(
            "map",
            table.receivers[:1],
            center=[*CENTER, HEIGHT],
            size=[SIZE, SIZE],
            cell=1.0,
            samples=samples,
            file=str(file),
        )
        beside = "–"
        if ours:
            theirs = np.load(file).reshape(cells, cells)
            both = (theirs > 0) & np.isfinite(ours[1])
            difference = np.abs(10 * np.log10(theirs[both]) - ours[1][both])
            only = int(((theirs > 0) & ~np.isfinite(ours[1])).sum()), int(
                (~(theirs > 0) & np.isfinite(ours[1])).sum()
            )
            beside = (
                f"{np.median(difference):.2f}, {np.percentile(difference, 95):.1f}; "
                f"power in {only[0]} cells that have none "
                f"here, none in {only[1]} that have"
            )
        table.say(
            f"| Sionna RT, {samples:.0e} rays (mean over a cell) | {got['wall_s']:.1f} s "
            f"| {got['steady_ms'] / 1e3:.2f} s | "
            f"{got['cpu_s']:.0f} s | {got['lit']} | {beside} |"
        )
        table.results.setdefault("map", {})[f"{samples:.0e}"] = got
    table.results.setdefault("map", {})["greatx"] = ours[0] if ours else None
    table.say()
