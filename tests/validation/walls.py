# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Walls at normal incidence: greatx beside 3GPP's penetration losses and beside measured samples."""
import tempfile

import numpy as np

import model
import picture
import published
import scenes

GAP = {"relative_permittivity": 1.0, "conductivity": 0.0}
PANE = {"itu": "glass"}
# A film of 10 ohms a square, as a layer of a micrometre.
FILM = {"relative_permittivity": 1.0, "conductivity": 1e5, "thickness_m": 1e-6}
DOUBLE = [{**PANE, "thickness_m": 0.006}, {**GAP, "thickness_m": 0.016}, {**PANE, "thickness_m": 0.006}]
COATED = [DOUBLE[0], FILM, DOUBLE[1], DOUBLE[2]]
# kind of Table 7.4.3-1, name, radio material
WALLS = [
    ("glass", "double glazing 6/16/6 mm", {"layers": DOUBLE}),
    ("irr_glass", "the same with a film of 10 Ω", {"layers": COATED}),
    ("concrete", "concrete, 0.25 m", {"itu": "concrete", "thickness_m": 0.25}),
    ("wood", "wood, 0.05 m", {"itu": "wood", "thickness_m": 0.05}),
]
BANDS_GHZ = [(1, 2), (2, 4), (4, 8), (8, 16), (16, 32), (32, 64), (64, 100)]


def losses(materials, frequencies_hz):
    """Returns the loss in dB of each wall at each frequency, [wall, frequency], at normal incidence. Each
    wall is a sheet of 100 m x 100 m between a transmitter and a receiver of its own. The frequencies are
    evenly spaced: they are the subcarriers of one channel with dispersion."""
    parts, tx, rx = [], [], []
    for i, material in enumerate(materials):
        y = 256.0 * i
        sheet = scenes.rectangle([0, y - 50, -50], np.array([0, 100, 0]), np.array([0, 0, 100]))
        parts.append((f"wall{i}", material, sheet))
        tx.append([-10, y, 0.0])
        rx.append([10, y, 0.0])
    count = len(frequencies_hz)
    middle = frequencies_hz[count // 2]
    spacing = frequencies_hz[1] - frequencies_hz[0] if count > 1 else 1e3
    with tempfile.TemporaryDirectory() as folder:
        world = scenes.World(folder, parts, transmission="on", reflection="off", dispersion="on")
        # A wall counts as opaque by its loss at the lowest carrier, so there is one at 1 GHz.
        world.channel(1e9, tx)
        grid = {"subcarriers": count, "subcarrier_spacing_hz": spacing, "max_depth": 1}
        paths = world.paths(middle, tx, rx, **grid)
        h = np.abs(paths.cfr().astype(complex))[:, 0, :, 0, 0]  # [rx, tx, frequency]
    unobstructed = published.C / middle / (4 * np.pi) / 20.0
    return -20 * np.log10(h[np.arange(len(rx)), np.arange(len(rx))] / unobstructed)


def referee(material, f_hz):
    """Returns the loss in dB of a wall by the chain matrices of tests/peer/model.py."""
    layers = []
    for layer in material.get("layers", [material]):
        if "itu" in layer:
            eta = model.permittivity(layer["itu"], f_hz)
        else:
            eta = layer["relative_permittivity"] - 1j * layer["conductivity"] / (
                2 * np.pi * f_hz * model.EPSILON_0
            )
        layers.append((eta, layer["thickness_m"]))
    return -20 * np.log10(abs(model.passed(layers, 1.0, published.C / f_hz)[0]))


def mean_loss(loss):
    """Returns the loss of the mean power, dB."""
    return -10 * np.log10(np.mean(10 ** (-loss / 10)))


def band_means(ghz, ours, theirs):
    """Returns the difference of the mean powers that pass in each band, dB."""
    rows = []
    for low, high in BANDS_GHZ:
        inside = (ghz >= low) & (ghz <= high)
        rows.append(mean_loss(ours[inside]) - mean_loss(theirs[inside]))
    return rows


def samples(say, figures):
    """Prints measured samples beside greatx and returns their differences by medium."""
    by_frequency = {}
    for row in published.MEASURED_WALLS:
        by_frequency.setdefault(row[3], []).append(row)
    computed = {}
    for ghz, rows in by_frequency.items():
        found = losses([{"itu": r[1], "thickness_m": r[2]} for r in rows], [ghz * 1e9])[:, 0]
        computed.update(zip(rows, found))
    say("sample, thickness, frequency                 measured, dB   greatx, dB  difference")
    differences = {}
    for row in published.MEASURED_WALLS:
        source, medium, thickness, ghz, least, most = row
        ours = computed[row]
        shown = f"{least:.1f}" if least == most else f"{least:.1f} to {most:.1f}"
        gap = round(ours - np.clip(ours, least, most), 1) + 0.0  # no -0.0
        differences.setdefault(medium, []).append(gap)
        say(
            f"{medium:<13} {1e3 * thickness:6.1f} mm {ghz:5.2f} GHz  {source:<13} {shown:>12}"
            f" {ours:>12.1f} {gap:>11.1f}"
        )
    figures["samples"] = differences
    return computed


def run(say, draw):
    """Prints the figures; returns them by name."""
    figures = {"bands": {}}
    ghz = 1.2 + 0.4 * np.arange(247)
    found = losses([material for _, _, material in WALLS], 1e9 * ghz)
    worst = max(
        abs(found[i, k] - referee(material, 1e9 * ghz[k]))
        for i, (_, _, material) in enumerate(WALLS)
        for k in range(0, len(ghz), 7)
        if found[i, k] < 300
    )
    figures["referee"] = float(worst)
    say(f"largest difference from the chain matrices: {worst:.1e} dB")
    say("mean power that passes, greatx - TR 38.901, dB, by band in GHz")
    say(f"{'':<34}" + "".join(f"{low}-{high}".rjust(8) for low, high in BANDS_GHZ))
    panels = []
    for (kind, name, _), loss in zip(WALLS, found):
        table = published.penetration(kind, 1e9 * ghz)
        figures["bands"][kind] = band_means(ghz, loss, table)
        say(f"{name:<34}" + "".join(f"{value:8.1f}" for value in figures["bands"][kind]))
        top = {"glass": 40, "irr_glass": 70, "concrete": 420, "wood": 40}[kind]
        panel = picture.Panel(name, "frequency, GHz", "loss, dB", (1, 100), (0, top), log_x=True, legend="tl")
        panel.line(ghz, table, f"TR 38.901, {kind.replace('_', ' ')}", picture.ORANGE, 2, "6 3")
        panel.line(ghz, loss, "greatx, ITU-R P.2040-4", picture.BLUE)
        panels.append(panel)
    say("")
    computed = samples(say, figures)
    draw("walls.svg", picture.svg(panels, columns=2, width=470, height=300))
    draw("walls_measured.svg", picture.svg([measured_panel(computed)], width=560, height=400))
    return figures


def measured_panel(computed):
    panel = picture.Panel(
        "Samples: measured and computed", "measured loss, dB", "greatx, dB", (0, 36), (0, 36), legend="tl"
    )
    colors = {
        "plasterboard": picture.PURPLE,
        "glass": picture.SKY,
        "wood": picture.ORANGE,
        "brick": picture.RED,
        "concrete": picture.BLACK,
    }
    panel.line([0, 36], [0, 36], "equal", picture.GREY, 1, "4 3")
    for medium, color in colors.items():
        rows = [(row, loss) for row, loss in computed.items() if row[1] == medium]
        for row, loss in rows:
            if row[4] != row[5]:
                panel.line([row[4], row[5]], [loss, loss], "", color, 2.5)
        panel.dots([(r[4] + r[5]) / 2 for r, _ in rows], [l for _, l in rows], medium, color, 4)
    return panel
