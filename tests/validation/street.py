# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A street between two walls in closed form, and generated streets beside ITU-R P.1411 and 3GPP TR 38.901."""
import tempfile
import time

import numpy as np

import greatx

import model
import picture
import published
import scenes

WIDTH_M, HEIGHT_M, LENGTH_M = 20.0, 32.0, 1024.0
STATION = np.array([-6.0, 0.0, 10.0])


def canyon_parts():
    half, deep = WIDTH_M / 2, 8.0
    houses = [
        scenes.block([-half - deep, -LENGTH_M, 0], [-half, LENGTH_M, HEIGHT_M]),
        scenes.block([half, -LENGTH_M, 0], [half + deep, LENGTH_M, HEIGHT_M]),
    ]
    return [
        ("ground", scenes.ASPHALT, scenes.ground(2048)),
        *(("houses", scenes.CONCRETE, house) for house in houses),
    ]


def unfolded(source, target, walls, first_right, on_ground):
    """Returns the points of the path from source to target by `walls` reflections, alternately at both walls,
    and by at most one at the ground. The path is straight in the unfolded street."""
    flip = np.array([1 if first_right else -1, 1, 1])
    a, b = source * flip, target * flip
    s, t = a[0] + WIDTH_M / 2, b[0] + WIDTH_M / 2
    end = walls * WIDTH_M + (t if walls % 2 == 0 else WIDTH_M - t)
    down = -b[2] if on_ground else b[2]
    crossings = [(((i + 1) * WIDTH_M - s) / (end - s), False) for i in range(walls)]
    if on_ground:
        crossings.append((a[2] / (a[2] + b[2]), True))
    points, media = [a], []
    for share, ground in sorted(crossings):
        x = s + share * (end - s)
        turn = int(np.floor(x / WIDTH_M + (0 if ground else 0.5)))
        if ground:
            x = x - turn * WIDTH_M if turn % 2 == 0 else (turn + 1) * WIDTH_M - x
        else:
            x = WIDTH_M if turn % 2 else 0.0
        height = 0.0 if ground else abs(a[2] + share * (down - a[2]))
        points.append(np.array([x - WIDTH_M / 2, a[1] + share * (b[1] - a[1]), height]))
        media.append("asphalt_concrete" if ground else "concrete")
    return np.array([*points, b]) * flip, media


def closed_form(f_hz, receivers, depth):
    """Returns (H, number of paths) of each receiver: all sequences of at most `depth` reflections at two
    endless walls and the ground, by the independent fields of tests/peer/model.py."""
    wavelength = published.C / f_hz
    eta = {name: model.permittivity(name, f_hz) for name in ("asphalt_concrete", "concrete")}
    sequences = [
        (walls, right, ground)
        for ground in (False, True)
        for walls in range(depth + 1 - ground)
        for right in ((True, False) if walls else (True,))
    ]
    total = np.zeros(len(receivers), complex)
    for i, receiver in enumerate(receivers):
        for walls, right, ground in sequences:
            points, media = unfolded(STATION, receiver, walls, right, ground)
            layers = [[(1.0, [(eta[name], 0.0)])] for name in media]
            types = [model.REFLECTION] * len(media)
            matrix = model.transfer(points, types, layers, np.full((len(media), 3), np.nan), wavelength)
            length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
            total[i] += matrix[0, 0] * np.exp(-2j * np.pi * (length / wavelength % 1))
    return total * wavelength / (4 * np.pi), len(sequences)


def ideal(say, figures, depth=5):
    """Compares a street of two walls with its closed form, and its loss with P.1411 and TR 38.901."""
    y = np.geomspace(20, 500, 120)
    receivers = np.stack([np.full_like(y, 3.0), y, np.full_like(y, 1.5)], axis=1)
    space = np.linalg.norm(receivers - STATION, axis=1)
    say("two walls and a ground, 20 m wide; from 10 m to 1.5 m; at most 5 reflections")
    curves = {}
    for f_hz in (3.5e9, 28e9):
        with tempfile.TemporaryDirectory() as folder:
            world = scenes.World(folder, canyon_parts())
            paths = world.paths(f_hz, STATION, receivers, max_depth=depth)
        h = scenes.field(paths)
        exact, count = closed_form(f_hz, receivers, depth)
        direct = published.C / f_hz / (4 * np.pi) / space
        error = float(np.max(np.abs(h - exact) / direct))
        wrong = int(np.sum(np.bincount(paths["rx"], minlength=len(y)) != count))
        loss = -scenes.decibel(scenes.power(paths))
        slope, offset, deviation = scenes.line_fit(10 * np.log10(space), loss)
        itu = loss - published.p1411_site_general("LOS", f_hz, space)
        umi = loss - published.umi_loss("LOS", f_hz, space, STATION[2], 1.5)
        figures[f"ideal_{f_hz / 1e9:g}"] = {
            "error": error,
            "wrong": wrong,
            "count": count,
            "slope": slope,
            "itu": float(np.mean(itu)),
            "umi": float(np.mean(umi)),
        }
        say(
            f"{f_hz / 1e9:4g} GHz: {count} paths at each of {len(y)} receivers, another number at {wrong}; "
            f"largest error {error:.1e} of the direct ray"
        )
        say(
            f"          mean power {offset:.1f} + {10 * slope:.1f} lg d, {deviation:.1f} dB off it; "
            f"minus P.1411 {np.mean(itu):.1f} dB (sigma 5.06), minus UMi {np.mean(umi):.1f} dB (4.0)"
        )
        curves[f_hz] = (space, loss, np.abs(h))
    return curves


def run_street(say, draw):
    """Prints the figures of the ideal street; returns them by name."""
    figures = {}
    panels = []
    for f_hz, (space, loss, h) in ideal(say, figures).items():
        panel = picture.Panel(
            f"Street of two walls, {f_hz / 1e9:g} GHz",
            "distance, m",
            "loss, dB",
            (20, 500),
            (60, 140) if f_hz < 1e10 else (80, 160),
            log_x=True,
            down=True,
            legend="bl",
        )
        itu = published.p1411_site_general("LOS", f_hz, space)
        sigma = published.P1411_TABLE_4["LOS"]["sigma"]
        panel.band(space, itu - sigma, itu + sigma, "P.1411-12, 4.1.1: median ± σ", picture.SKY)
        panel.line(space, -20 * np.log10(h), "greatx, H at 120 places", picture.GREY, 0.8)
        panel.line(space, loss, "greatx, mean power", picture.BLUE, 2)
        umi = published.umi_loss("LOS", f_hz, space, STATION[2], 1.5)
        panel.line(space, umi, "TR 38.901, UMi in sight", picture.ORANGE, 1.8, "6 3")
        panel.line(space, published.free_space(f_hz, space), "free space", picture.BLACK, 1, "2 2")
        panels.append(panel)
    draw("street.svg", picture.svg(panels, columns=2, width=470, height=380))
    return figures


# name, scene, station, half-sides of the area around the origin in which receivers are drawn (m)
GENERATED = [
    ("canyon", {"kind": "canyon", "seed": 9, "size_m": 400}, [6.3, -21.7, 9.4], (30.0, 195.0)),
    ("city", {"kind": "city", "seed": 3, "size_m": 300}, [13.0, 13.0, 10.0], (145.0, 145.0)),
]
# One edge without reflections beside it, or one scattering. The section `effects` says what more brings.
EFFECTS = {"diffraction": "on", "corner_diffraction": "off", "scattering": "on", "transmission": "on"}
CHANNEL = {"max_depth": 3, "max_reflections_beside_diffraction": 0}
FLOOR_DB = 140.0  # receivers with more loss count as uncovered


def scene_of(scene, **options):
    return greatx.Simulation(
        {"greatx": 1, "name": "street", "ticks": 1, "scene": {"generate": scene}}, **options
    )


def places(scene, station, half_sides, count, seed=1):
    """Returns `count` places drawn over the free ground of a rectangle, 1.5 m high, [count, 3]."""
    sim = scene_of(scene)
    sim.place_transmitter("bs", station)
    sim.add_channel("where", receivers=[], max_depth=0)
    found = sim.radio_map(2.0, "where", min_m=[-v for v in half_sides], max_m=list(half_sides), height_m=1.5)
    rows, columns = np.nonzero(found.placement == 0)
    chosen = np.random.default_rng(seed).permutation(len(rows))[:count]
    rows, columns = rows[chosen], columns[chosen]
    return np.stack([found.x[columns], found.y[rows], found.z[rows, columns]], axis=1)


def drops(scene, station, points, f_hz, effects={}, channel={}):
    """Returns (distance in space, loss of the mean power in dB, in sight, lg of the delay spread). `effects`
    and `channel` replace items of EFFECTS and CHANNEL."""
    sim = scene_of(scene, effects={**EFFECTS, **effects})
    sim.place_transmitter("bs", station)
    sim.add_channel(
        "csi", receivers=[], carrier_hz=f_hz, bandwidth_hz=100e6, subcarriers=1, **{**CHANNEL, **channel}
    )
    paths = sim.paths("csi", receivers=points)
    statistics = paths.statistics()
    sight = np.zeros(len(points), bool)
    sight[paths["rx"][(paths["interaction"] == 0).all(axis=1)]] = True
    spread = np.maximum(statistics.delay_spread[:, 0], 1e-30)
    loss = -scenes.decibel(statistics.path_gain[:, 0])
    return np.linalg.norm(points - station, axis=1), loss, sight, np.log10(spread)


def summary(f_hz, distance, loss, spread, sight, height):
    """Returns the figures of the receivers in sight or not: count, share that is covered (%), and of the
    covered ones mean and deviation of the loss minus each model's, and of lg(delay spread)."""
    covered = loss < FLOOR_DB
    gaps = [
        loss[covered] - model_of[covered]
        for model_of in (
            published.p1411_site_general(sight, f_hz, distance),
            published.umi_loss(sight, f_hz, distance, height, 1.5),
        )
    ]
    spread = spread[covered & (spread > -10)]
    return {
        "count": len(loss),
        "covered": 100 * float(np.mean(covered)),
        "itu": (float(np.mean(gaps[0])), float(np.std(gaps[0]))),
        "umi": (float(np.mean(gaps[1])), float(np.std(gaps[1]))),
        "spread": (float(np.mean(spread)), float(np.std(spread))),
    }


def run_city(say, draw, count=200):
    """Prints the figures of generated streets; returns them by name."""
    figures, panels = {}, []
    say("loss of the mean power minus the model's, dB, and lg of the delay spread in s; mean ± deviation")
    say(
        f"{'':<24}{'number':>7}{'covered':>9}{'- P.1411':>15}{'- UMi':>15}{'lg DS':>16}" f"{'UMi: lg DS':>16}"
    )
    for name, scene, station, half_sides in GENERATED:
        points = places(scene, station, half_sides, count)
        for f_hz in (3.5e9, 28e9):
            started = time.perf_counter()
            distance, loss, seen, spread = drops(scene, np.array(station), points, f_hz)
            took = time.perf_counter() - started
            for sight, nearest in (("LOS", 10), ("NLOS", 30)):
                use = (seen == (sight == "LOS")) & (distance >= nearest)
                row = summary(f_hz, distance[use], loss[use], spread[use], sight, station[2])
                figures[name, f_hz, sight] = row
                pairs = "".join(
                    f"{mean:>9.{digits}f} ± {deviation:.{digits}f}"
                    for (mean, deviation), digits in (
                        (row["itu"], 1),
                        (row["umi"], 1),
                        (row["spread"], 2),
                        (published.umi_delay_spread(sight, f_hz), 2),
                    )
                )
                say(
                    f"{name:<7} {f_hz / 1e9:>4g} GHz {sight:<6}"
                    f"{row['count']:>7}{row['covered']:>7.0f} %{pairs}"
                )
            say(f"{'':<7} paths of {len(points)} receivers  {took:.1f} s")
            panels.append(picture_of(name, f_hz, distance, loss, seen, station[2]))
    draw("city.svg", picture.svg(panels, columns=2, width=470, height=360))
    return figures


MORE = [
    ("one edge or scattering, as above", {}, {}),
    ("reflections beside the edge", {}, {"max_reflections_beside_diffraction": 1}),
    ("ends of edges", {"corner_diffraction": "on"}, {}),
    ("depth 4", {}, {"max_depth": 4}),
]


def run_effects(say, draw, count=20):
    """Prints what more effects bring to receivers out of sight, and what they cost; returns it by name."""
    figures = {}
    say(f"power that receivers out of sight gain, dB, of {count} receivers at 3.5 GHz")
    say(f"{'':<42}{'median':>8}{'90 %':>8}{'most':>8}{'lg DS':>8}")
    for name, scene, station, half_sides in GENERATED:
        points = places(scene, station, half_sides, count)
        first = None
        for label, effects, channel in MORE:
            started = time.perf_counter()
            _, loss, seen, spread = drops(scene, np.array(station), points, 3.5e9, effects, channel)
            took = time.perf_counter() - started
            first = loss if first is None else first
            dark = ~seen & np.isfinite(first)
            gain = (first - loss)[dark]
            row = (np.median(gain), np.percentile(gain, 90), np.max(gain), np.mean(spread[dark]))
            figures[name, label] = row
            cells = "".join(f"{value + 0.0:>8.2f}" for value in row)
            say(f"{name:<8}{label:<34}{cells}  {took:.1f} s")
    return figures


def picture_of(name, f_hz, distance, loss, seen, height):
    panel = picture.Panel(
        f"{name}, {f_hz / 1e9:g} GHz",
        "distance, m",
        "loss, dB",
        (10, 250),
        (60, 160) if f_hz < 1e10 else (80, 180),
        log_x=True,
        down=True,
        legend="bl",
    )
    x = np.geomspace(10, 250, 60)
    for sight, color in (("LOS", picture.BLUE), ("NLOS", picture.RED)):
        middle = published.p1411_site_general(sight, f_hz, x)
        sigma = published.P1411_TABLE_4[sight]["sigma"]
        panel.band(x, middle - sigma, middle + sigma, f"P.1411-12, {sight}: ± σ", color)
        panel.line(
            x, published.umi_loss(sight, f_hz, x, height, 1.5), f"TR 38.901 UMi, {sight}", color, 1.5, "6 3"
        )
        mask = (seen == (sight == "LOS")) & np.isfinite(loss)
        panel.dots(distance[mask], loss[mask], f"greatx, {sight}", color, 2)
    return panel
