# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Round a corner: a crossing of two streets beside ITU-R P.1411, a knife edge beside ITU-R P.526, and the
corner of a building beside what was measured at 28 GHz."""
import tempfile
import time

import numpy as np

import picture
import published
import scenes

F_HZ = 2e9  # both models of P.1411 hold: 4.1.3.1 to 2 GHz, 4.1.3.2 from 2 GHz
MAIN_M, SIDE_M = 20.0, 16.0  # widths of the streets
X1_M = 80.0  # from the station to the middle of the crossing
STATION = np.array([-X1_M, 2.0, 4.0])
ROOF_M, BLOCK_M = 24.0, 256.0


def crossing_parts(scattering):
    """Four blocks of houses around a crossing at the origin. The main street runs along x."""
    walls = {**scenes.CONCRETE, "scattering_coefficient": scattering}
    parts = [("ground", scenes.ASPHALT, scenes.ground(1024))]
    for sx in (-1, 1):
        for sy in (-1, 1):
            near = np.array([sx * SIDE_M / 2, sy * MAIN_M / 2])
            far = near + [sx * BLOCK_M, sy * BLOCK_M]
            low, high = np.minimum(near, far), np.maximum(near, far)
            parts.append(("houses", walls, scenes.block([*low, 0], [*high, ROOF_M])))
    return parts


def walk():
    """Returns receivers along the main street and round the corner, and their way from the crossing, m."""
    main = np.arange(-60.0, 0.0, 1.0)
    side = np.arange(0.0, 150.5, 1.0)
    way = np.concatenate([main, side])
    points = np.zeros((len(way), 3))
    points[: len(main), 0] = main
    points[len(main) :, 1] = side
    points += [-1.0, -1.0, 1.5]
    return points, way


# name, scattering coefficient of the houses, effects, fields of the channel. The last one is slow.
SETTINGS = [
    ("reflections, depth 3", 0.0, {}, {"max_depth": 3}),
    ("reflections, depth 8", 0.0, {}, {"max_depth": 8}),
    (
        "with one edge, depth 3",
        0.0,
        {"diffraction": "on"},
        {"max_depth": 3, "max_reflections_beside_diffraction": 2},
    ),
    (
        "with one edge, depth 6",
        0.0,
        {"diffraction": "on"},
        {"max_depth": 6, "max_reflections_beside_diffraction": 3},
    ),
    (
        "one edge or scattering, depth 5",
        0.4,
        {"diffraction": "on", "scattering": "on"},
        {
            "max_depth": 5,
            "max_reflections_beside_diffraction": 2,
            "max_reflections_before_scattering": 2,
            "max_reflections_after": 2,
        },
    ),
]


def crossing(say, figures, quick):
    """Walks round the corner with several sets of effects."""
    points, way = walk()
    side = way > MAIN_M / 2 + 1  # behind the corner, as in P.1411
    behind = way[side]
    shf = published.p1411_corner_shf(F_HZ, X1_M, behind, MAIN_M, STATION[2], 1.5)
    uhf = published.p1411_corner_uhf(F_HZ, X1_M, behind, MAIN_M, SIDE_M)
    panel = picture.Panel(
        f"Round the corner, {F_HZ / 1e9:g} GHz",
        "way from the crossing (negative: in the main street), m",
        "loss, dB",
        (-60, 150),
        (60, 150),
        down=True,
        legend="bl",
    )
    panel.line(behind, shf, "P.1411-12, 4.1.3.2", picture.BLACK, 1.8, "6 3")
    panel.line(behind, uhf, "P.1411-12, 4.1.3.1", picture.GREY, 1.8, "2 2")
    say(f"{len(behind)} receivers in the side street, {behind[0]:g} to {behind[-1]:g} m from the crossing")
    say(f"{'':<34}{'dark':>6}{'bend, dB':>10}{'dB/decade':>11}{'- 4.1.3.1, dB':>16}{'- 4.1.3.2, dB':>16}")
    in_sight = np.full(len(way) - len(behind), published.p1411_street(F_HZ, STATION[2], 1.5, X1_M)[0])
    for name, loss in (("P.1411-12, 4.1.3.1", uhf), ("P.1411-12, 4.1.3.2", shf)):
        row = corner_figures(way, np.concatenate([in_sight, loss]), side, uhf, shf)
        say(f"{name:<34}{'':>6}{row['bend']:>10.1f}{row['slope']:>11.1f}")
    colors = (picture.SKY, picture.BLUE, picture.ORANGE, picture.RED, picture.GREEN)
    for (name, scattering, effects, channel), color in zip(SETTINGS[: -1 if quick else None], colors):
        started = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            world = scenes.World(folder, crossing_parts(scattering), **effects)
            paths = world.paths(F_HZ, STATION, points, **channel)
        took = time.perf_counter() - started
        loss = -scenes.decibel(scenes.power(paths))
        panel.line(way, loss, name, color, 5 if color == picture.SKY else 1.5)
        row = figures[name] = corner_figures(way, loss, side, uhf, shf)
        gaps = "".join(f"{mean:>9.1f} ± {deviation:>4.1f}" for mean, deviation in (row["uhf"], row["shf"]))
        say(
            f"{name:<34}{row['dark']:>4.0f} %{number(row['bend']):>10}{number(row['slope']):>11}{gaps}"
            f"  {took:.1f} s"
        )
    return panel


def number(value):
    return f"{value:.1f}" if np.isfinite(value) else "-"


def corner_figures(way, loss, side, uhf, shf):
    """Returns the share of dark receivers in the side street in %; the bend (mean loss 25 to 35 m behind the
    corner's line minus that in sight over the last 20 m before the crossing, dB); the decay further on, in dB
    a decade of x1 + x2, where nine of ten receivers are lit; and mean and deviation of the differences from
    both models, over lit receivers at least 20 m from the crossing."""
    lit = np.isfinite(loss)
    start = MAIN_M / 2
    at = (way >= start + 25) & (way <= start + 35)
    before = (way >= -20) & (way < 0)
    far = side & (way > start + 30)
    enough = np.mean(lit[far]) >= 0.9
    use = lit[side] & (way[side] >= 20)
    gaps = [loss[side][use] - model[use] for model in (uhf, shf)]
    slope = np.polyfit(np.log10(X1_M + way[far & lit]), loss[far & lit], 1)[0] if enough else np.nan
    return {
        "dark": 100 * float(np.mean(~lit[side])),
        "bend": float(np.mean(loss[at]) - np.mean(loss[before])) if lit[at].all() else np.nan,
        "slope": float(slope),
        "uhf": (float(np.mean(gaps[0])), float(np.std(gaps[0]))),
        "shf": (float(np.mean(gaps[1])), float(np.std(gaps[1]))),
    }


def knife(say, figures):
    """Raises a receiver behind the edge of a conducting screen."""
    f_hz, near, far = 10e9, 100.0, 100.0
    v = np.linspace(-0.75, 4, 96)
    wavelength = published.C / f_hz
    # v = h sqrt(2 (d1 + d2)/(lambda d1 d2)) with the height h of the edge over the line between the ends. The
    # receiver moves, and h = -z/2.
    z = -2 * v / np.sqrt(2 * (near + far) / (wavelength * near * far))
    screen = scenes.rectangle([0, -8192, -8192], np.array([0, 16384, 0]), np.array([0, 0, 8192]))
    with tempfile.TemporaryDirectory() as folder:
        world = scenes.World(
            folder,
            [("screen", {"conductor": "copper"}, screen)],
            diffraction="on",
            free_edges="on",
            corner_diffraction="off",
        )
        paths = world.paths(
            f_hz, [-near, 0, 0], np.stack([np.full_like(z, far), 0 * z, z], axis=1), max_depth=1
        )
    keep = paths["delay"] * published.C < 1.5 * (near + far)  # the other edges of the screen are 8 km away
    paths["transfer"][~keep] = 0
    space = np.hypot(near + far, z)
    fields = [np.abs(scenes.field(paths, c)) * space * 4 * np.pi / wavelength for c in ((0, 0), (1, 1))]
    loss = -20 * np.log10((fields[0] + fields[1]) / 2)
    exact, formula = published.knife_edge_exact(v), published.knife_edge(v)
    figures["knife"] = (float(np.max(np.abs(loss - exact))), float(np.max(np.abs(loss - formula))))
    say(
        f"knife edge, {f_hz / 1e9:g} GHz, v = -0.75 to 4: at most {figures['knife'][0]:.3f} dB from "
        f"Fresnel's integral, {figures['knife'][1]:.3f} dB from P.526"
    )
    panel = picture.Panel("Knife edge", "v", "loss, dB", (-0.75, 4), (0, 26), down=True, legend="tr")
    panel.line(v, exact, "Fresnel's integral", picture.GREY, 4)
    panel.line(v, formula, "P.526-15, eq. 31", picture.ORANGE, 1.6, "6 3")
    panel.line(v, loss, "greatx", picture.BLUE, 1.4)
    return panel


CORNER_MEDIA = ["concrete", "brick", "glass", "metal"]


def building(say, figures):
    """Walks behind the right-angled corner of a house at 28 GHz, on a circle around its edge."""
    f_hz, near, far = 28e9, 20.0, 20.0
    bend = np.linspace(0.5, 40, 80)
    # The faces of the wedge are y = 0 (x < 0) and x = 0 (y < 0); the source stands 30 degrees off the first.
    source = near * np.array([-np.cos(np.radians(30)), np.sin(np.radians(30)), 0])
    toward = np.radians(-30 - bend)
    receivers = far * np.stack([np.cos(toward), np.sin(toward), 0 * toward], axis=1)
    losses = {}
    for medium in CORNER_MEDIA:
        with tempfile.TemporaryDirectory() as folder:
            house = scenes.block([-256, -256, -128], [0, 0, 128])
            world = scenes.World(
                folder,
                [("house", {"itu": medium}, house)],
                diffraction="on",
                corner_diffraction="off",
            )
            paths = world.paths(f_hz, source, receivers, max_depth=1)
        paths["transfer"][paths["delay"] * published.C > 1.2 * (near + far)] = 0
        alone = published.C / f_hz / (4 * np.pi) / np.linalg.norm(receivers - source, axis=1)
        for pol, component in (("V", (0, 0)), ("H", (1, 1))):
            losses[medium, pol] = -20 * np.log10(np.abs(scenes.field(paths, component)) / alone)
    return bend, losses


def corner_of_a_house(say, figures):
    bend, losses = building(say, figures)
    panel = picture.Panel(
        "Corner of a house, 28 GHz",
        "angle behind the shadow boundary, °",
        "loss, dB",
        (0, 40),
        (0, 55),
        down=True,
    )
    colors = dict(zip(CORNER_MEDIA, (picture.BLACK, picture.RED, picture.SKY, picture.ORANGE)))
    for (medium, pol), loss in losses.items():
        panel.line(bend, loss, f"{medium}, {pol}", colors[medium], 1.5, "" if pol == "V" else "5 3")
    use = (bend >= 5) & (bend <= 30)
    table = {key: loss[use] for key, loss in losses.items()}
    walls = [key for key in table if key[0] != "metal"]
    fits = {key: np.polyfit(bend[use], table[key], 1) for key in walls}
    rest = [np.std(table[key] - np.polyval(fits[key], bend[use])) for key in walls]
    apart = lambda keys: float(np.max(np.ptp([table[key] for key in keys], axis=0)))
    row = figures["corner"] = {
        "slope": (float(min(f[0] for f in fits.values())), float(max(f[0] for f in fits.values()))),
        "rest": float(max(rest)),
        "materials": max(apart([key for key in walls if key[1] == pol]) for pol in "VH"),
        "polarizations": max(apart([(medium, "V"), (medium, "H")]) for medium in CORNER_MEDIA[:3]),
        "metal": apart([("metal", "V"), ("metal", "H")]),
    }
    say("corner of a house at 28 GHz, 5 to 30 degrees behind the shadow boundary:")
    say(
        f"  slope {row['slope'][0]:.2f} to {row['slope'][1]:.2f} dB a degree, "
        f"{row['rest']:.2f} dB rms off a line"
    )
    say(
        f"  concrete, brick and glass are at most {row['materials']:.1f} dB apart, the two polarizations "
        f"{row['polarizations']:.1f} dB (metal: {row['metal']:.1f} dB)"
    )
    return panel


def run_corner(say, draw, quick=False):
    """Prints the figures of the crossing; returns them by name. `quick` leaves the slowest setting out."""
    figures = {}
    draw("corner.svg", picture.svg([crossing(say, figures, quick)], width=760, height=440))
    return figures


def run_edge(say, draw):
    """Prints the figures of single edges; returns them by name."""
    figures = {}
    panels = [knife(say, figures), corner_of_a_house(say, figures)]
    draw("edge.svg", picture.svg(panels, columns=2, width=470, height=360))
    return figures
