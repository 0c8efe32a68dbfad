# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Two rays over a plane: the closed form, the breakpoint, ITU-R P.1411's bounds, and a measured campaign."""
import tempfile

import numpy as np

import model
import picture
import published
import scenes

F_HZ = 1.9e9
USER_M = 1.7
STREET, SOIL = "asphalt_concrete", "medium_dry_ground"


def closed_form(f_hz, medium, h1, h2, d, vertical):
    """Returns H of the direct ray and the ray over the ground, complex [d], for isotropic antennas (P.2040-4,
    2.2.1: the reflection of a half-space)."""
    wavelength = published.C / f_hz
    direct, mirrored = np.hypot(d, h1 - h2), np.hypot(d, h1 + h2)
    cosine = (h1 + h2) / mirrored
    eta = model.permittivity(medium, f_hz)
    normal = np.sqrt(eta - 1 + cosine**2)
    te = (cosine - normal) / (cosine + normal)
    tm = (eta * cosine - normal) / (eta * cosine + normal)
    rays = [(1, direct), (tm, mirrored)] if vertical else [(-1, direct), (-te, mirrored)]
    return sum(r * np.exp(-2j * np.pi * (l / wavelength % 1)) / l for r, l in rays) * wavelength / (4 * np.pi)


def two_slopes(f_hz, loss, d, bend):
    """Returns the exponents before and behind `bend` and the deviation of the least-squares fit of two lines
    that meet there, of which the first begins with the loss of free space at 1 m (Feuerstein's model)."""
    base = 10 * np.log10(np.stack([np.minimum(d, bend), np.maximum(d / bend, 1)], axis=1))
    excess = loss - published.free_space(f_hz, 1.0)
    (near, far), *_ = np.linalg.lstsq(base, excess, rcond=None)
    return near, far, float(np.std(excess - base @ [near, far]))


def last_maximum(ratio, d):
    """Returns the distance of the last local maximum of |H| relative to free space."""
    inner = (ratio[1:-1] > ratio[:-2]) & (ratio[1:-1] >= ratio[2:])
    return d[1:-1][inner][-1]


def curves(h1, f_hz=F_HZ, points=1500):
    """Returns distances on the ground and greatx's H: {(medium, vertical): complex [d]}."""
    d = np.geomspace(10, 10 * published.breakpoint(f_hz, h1, USER_M), points)
    receivers = np.stack([d, np.zeros_like(d), np.full_like(d, USER_M)], axis=1)
    result = {}
    for medium in (STREET, SOIL):
        with tempfile.TemporaryDirectory() as folder:
            world = scenes.World(folder, [("ground", {"itu": medium}, scenes.ground(8192))])
            paths = world.paths(f_hz, [0, 0, h1], receivers, max_depth=1)
        for vertical in (True, False):
            result[medium, vertical] = scenes.field(paths, (0, 0) if vertical else (1, 1))
    return d, result


def picture_of(h1, d, fields):
    few = np.geomspace(10, d[-1], 41)
    median, low, high = published.p1411_street(F_HZ, h1, USER_M, few)
    panel = picture.Panel(
        f"{F_HZ / 1e9:g} GHz, {h1:g} m and {USER_M:g} m over a plane",
        "distance, m",
        "loss, dB",
        (10, d[-1]),
        (50, 150),
        log_x=True,
        down=True,
        legend="bl",
    )
    panel.band(few, low, high, "ITU-R P.1411-12, 4.1.2: bounds", picture.SKY)
    panel.line(few, median, "P.1411-12: median", picture.SKY, 1.6, "6 3")
    for (medium, vertical), color in (
        ((STREET, True), picture.BLUE),
        ((STREET, False), picture.RED),
    ):
        label = f"greatx, {'vertical' if vertical else 'horizontal'}"
        panel.line(d[::3], -20 * np.log10(np.abs(fields[medium, vertical][::3])), label, color, 1.2)
    panel.line(
        few, published.free_space(F_HZ, np.hypot(few, h1 - USER_M)), "free space", picture.GREY, 1.0, "2 2"
    )
    panel.upright(published.breakpoint(F_HZ, h1, USER_M), "4 h1 h2/λ")
    return panel


def run(say, draw):
    """Prints the figures; returns them by name."""
    figures = {"error": 0.0}
    panels = []
    rows = []
    for h1, measured in published.FEUERSTEIN.items():
        d, fields = curves(h1)
        direct = published.C / F_HZ / (4 * np.pi) / np.hypot(d, h1 - USER_M)
        for (medium, vertical), h in fields.items():
            error = np.abs(h - closed_form(F_HZ, medium, h1, USER_M, d, vertical)) / direct
            figures["error"] = max(figures["error"], float(error.max()))
        h = fields[STREET, True]
        loss = -20 * np.log10(np.abs(h))
        clearance = published.fresnel_clearance(F_HZ, h1, USER_M)
        near, far, deviation = two_slopes(F_HZ, loss, np.hypot(d, h1 - USER_M), clearance)
        _, low, _ = published.p1411_street(F_HZ, h1, USER_M, d)
        rows.append(
            {
                "h1": h1,
                "breakpoint": published.breakpoint(F_HZ, h1, USER_M),
                "clearance": clearance,
                "maximum": last_maximum(np.abs(h) / direct, d),
                "exponents": (near, far),
                "deviation": deviation,
                "measured": measured[:2],
                "measured_deviation": measured[2],
                "least": float(np.min(loss - low)),
            }
        )
        panels.append(picture_of(h1, d, fields))
    figures["rows"] = rows
    say(f"largest error against the closed form: {figures['error']:.1e} of the direct ray")
    lines = [
        ("base station, m", "h1", ".1f"),
        ("4 h1 h2/lambda, m", "breakpoint", ".1f"),
        ("Fresnel clearance, m", "clearance", ".1f"),
        ("last maximum of |H|, m", "maximum", ".0f"),
        ("exponents, greatx", "exponents", ".2f"),
        ("exponents, measured", "measured", ".2f"),
        ("deviation, greatx, dB", "deviation", ".2f"),
        ("deviation, measured, dB", "measured_deviation", ".2f"),
        ("least loss - P.1411's lower bound, dB", "least", ".2f"),
    ]
    for label, key, form in lines:
        cells = [", ".join(format(v, form) for v in np.atleast_1d(row[key])) for row in rows]
        say(f"{label:<40}" + "".join(f"{cell:>14}" for cell in cells))
    draw("two_ray.svg", picture.svg(panels[:1] + panels[2:], columns=2, width=470, height=380))
    return figures
