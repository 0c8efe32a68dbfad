# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Prints coverage, path loss, spreads and K factor of street receivers beside those of 3GPP TR 38.901.

Receivers are drawn over a square, 1.5 m high, and those inside a solid are left out. For each set of effects
the script runs `greatx paths` and computes from its paths, all of them and isotropic antennas at both ends:

- coverage: the share of receivers whose path gain is above a threshold (default -140 dB),
- path loss: the fit A + 10 n lg(d/m) by least squares over covered receivers, and the deviation from it, dB,
- the mean of lg of the rms delay spread, and of the azimuth spreads of departure and arrival in degrees
  (circular standard deviation, TR 38.901, annex A), with the standard deviation over receivers,
- K: the power of the line of sight and of everything within 10 ns of it (the reflection on the ground, which
  no measurement of 100 MHz resolves) against all other power, dB, over receivers with a line of sight.

Delay spreads below 0.1 ns, of receivers with one path, are left out of their means.

The same for UMi street canyon and UMa: TR 38.901 V17, tables 7.4.1-1 and 7.5-6, at the carrier.

Usage: street_statistics.py GREATX SCENARIO --assets FOLDER --mast X Y Z [--transmitter-node NAME]
"""

import argparse
import json
import math
import random
import re
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path


def lines_of(effects, extra, text):
    """Returns the scenario's text with other effects and other members of its channel."""
    text = re.sub(r"^effects:.*\n", "", text, flags=re.M)
    text = re.sub(r"max_depth: *\d+", f"max_depth: 3{extra}", text, count=1)
    return text + f"\neffects: {{{effects}}}\n"


def with_mast(text, mast):
    position = "position_m: [" + ", ".join(f"{x:g}" for x in mast) + "]"
    return re.sub(r"position_m: \[[^\]]*\]", position, text, count=1)


def run(greatx, scenario, assets, receivers):
    """Returns the JSON records, processor seconds, and the numbers of the points inside solids."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [greatx, "paths", str(scenario), "--receivers", str(receivers), "--json-lines"]
    if assets:
        command += ["--assets", assets]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    inside = {int(n) for n in re.findall(r"point (\d+) lies inside", done.stderr)}
    records = [json.loads(line) for line in done.stdout.splitlines()]
    return records, used, inside


def circular_spread_deg(angles, powers):
    total = sum(powers)
    c = sum(p * math.cos(a) for a, p in zip(angles, powers)) / total
    s = sum(p * math.sin(a) for a, p in zip(angles, powers)) / total
    return math.degrees(math.sqrt(-2.0 * math.log(min(1.0, math.hypot(c, s)))))


KINDS = ["line of sight", "reflection", "walls passed", "one edge", "two edges", "scattering"]


def kind_of(path):
    types = [i["type"] for i in path["interactions"]]
    if "scattering" in types:
        return "scattering"
    if "diffraction" in types:
        return "two edges" if types.count("diffraction") > 1 else "one edge"
    if "transmission" in types:
        return "walls passed"
    return "reflection" if types else "line of sight"


class Link:
    """Statistics of one receiver's paths."""

    def __init__(self, record):
        paths = [p for p in record["paths"] if p["gain_db"] is not None]
        powers = [10.0 ** (p["gain_db"] / 10.0) for p in paths]
        self.count = len(paths)
        self.power = sum(powers)
        if not paths:
            return
        delays = [p["delay_s"] for p in paths]
        mean = sum(p * t for p, t in zip(powers, delays)) / self.power
        self.delay_spread = math.sqrt(
            max(0.0, sum(p * (t - mean) ** 2 for p, t in zip(powers, delays)) / self.power)
        )
        self.departure = circular_spread_deg([p["departure"]["azimuth_rad"] for p in paths], powers)
        self.arrival = circular_spread_deg([p["arrival"]["azimuth_rad"] for p in paths], powers)
        self.sight = any(not p["interactions"] for p in paths)
        first = min(delays)
        self.direct = sum(w for t, w in zip(delays, powers) if t - first <= 10e-9)
        self.shares = dict.fromkeys(KINDS, 0.0)
        for path, power in zip(paths, powers):
            self.shares[kind_of(path)] += power / self.power


def mean_and_deviation(values):
    if len(values) < 2:
        return "–"
    return f"{statistics.mean(values):.2f} ± {statistics.stdev(values):.2f}"


def fit(distances, losses):
    """Returns A, n and the deviation of the fit, dB."""
    x = [10.0 * math.log10(d) for d in distances]
    mx, my = statistics.mean(x), statistics.mean(losses)
    slope = sum((a - mx) * (b - my) for a, b in zip(x, losses)) / sum((a - mx) ** 2 for a in x)
    offset = my - slope * mx
    rest = [b - offset - slope * a for a, b in zip(x, losses)]
    return offset, slope, math.sqrt(sum(r * r for r in rest) / max(1, len(rest) - 2))


def row(name, links, distances, threshold_db, seconds):
    covered = [
        i for i, link in enumerate(links) if link.count and 10.0 * math.log10(link.power) >= threshold_db
    ]
    cells = [name, f"{100.0 * len(covered) / len(links):.0f} %"]
    for sight in (True, False):
        some = [i for i in covered if links[i].sight == sight]
        if len(some) > 4:
            a, n, deviation = fit(
                [distances[i] for i in some], [-10.0 * math.log10(links[i].power) for i in some]
            )
            cells.append(f"{a:.0f} + {10 * n:.0f} lg d, {deviation:.1f}")
        else:
            cells.append("–")
        positive = [links[i] for i in some if links[i].delay_spread > 1e-10]
        cells.append(mean_and_deviation([math.log10(link.delay_spread) for link in positive]))
        for spread in ("departure", "arrival"):
            cells.append(
                mean_and_deviation(
                    [math.log10(getattr(link, spread)) for link in positive if getattr(link, spread) > 1e-6]
                )
            )
    k = [
        10.0 * math.log10(links[i].direct / (links[i].power - links[i].direct))
        for i in covered
        if links[i].sight and links[i].power > links[i].direct
    ]
    cells.append(mean_and_deviation(k))
    cells.append(seconds)
    return "| " + " | ".join(cells) + " |"


def of_3gpp(name, ghz):
    """Returns the row of TR 38.901 for a receiver 1.5 m high."""
    lg = math.log10
    if name == "UMi":
        f = max(2.0, ghz)
        los, nlos = f"{32.4 + 20 * lg(ghz):.0f} + 21 lg d, 4.0", f"{22.4 + 21.3 * lg(ghz):.0f} + 35 lg d, 7.8"
        ds = (-0.24 * lg(1 + f) - 7.14, 0.38), (-0.24 * lg(1 + f) - 6.83, 0.16 * lg(1 + f) + 0.28)
        asd = (-0.05 * lg(1 + f) + 1.21, 0.41), (-0.23 * lg(1 + f) + 1.53, 0.11 * lg(1 + f) + 0.33)
        asa = (-0.08 * lg(1 + f) + 1.73, 0.014 * lg(1 + f) + 0.28), (
            -0.08 * lg(1 + f) + 1.81,
            0.05 * lg(1 + f) + 0.3,
        )
        k = (9.0, 5.0)
    else:
        f = max(6.0, ghz)
        los, nlos = f"{28 + 20 * lg(ghz):.0f} + 22 lg d, 4.0", f"{13.54 + 20 * lg(ghz):.0f} + 39 lg d, 6.0"
        ds = (-6.955 - 0.0963 * lg(f), 0.66), (-6.28 - 0.204 * lg(f), 0.39)
        asd = (1.06 + 0.1114 * lg(f), 0.28), (1.5 - 0.1144 * lg(f), 0.28)
        asa = (1.81, 0.20), (2.08 - 0.27 * lg(f), 0.11)
        k = (9.0, 3.5)
    cells = [f"3GPP {name}", ""]
    for i in range(2):
        cells += [(los, nlos)[i]] + [f"{m:.2f} ± {s:.2f}" for m, s in (ds[i], asd[i], asa[i])]
    return "| " + " | ".join(cells + [f"{k[0]:.1f} ± {k[1]:.1f}", ""]) + " |"


SETTINGS = [
    ("line of sight and reflection", "diffraction: off, scattering: off, transmission: off", ""),
    (
        "and walls passed",
        "diffraction: off, scattering: off, transmission: on",
        "",
    ),
    (
        "reflection, one edge",
        "diffraction: on, corner_diffraction: off, scattering: off, transmission: off",
        ", max_reflections_beside_diffraction: 1",
    ),
    (
        "and ends of edges",
        "diffraction: on, scattering: off, transmission: off",
        ", max_reflections_beside_diffraction: 1",
    ),
    (
        "and two edges",
        "diffraction: on, scattering: off, transmission: off",
        ", max_reflections_beside_diffraction: 1, max_diffractions: 2",
    ),
    ("reflection, scattering", "diffraction: off, scattering: on, transmission: off", ""),
    (
        "reflection, one edge, scattering, walls",
        "diffraction: on, scattering: on, transmission: on",
        ", max_reflections_beside_diffraction: 1",
    ),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("greatx")
    parser.add_argument("scenario", type=Path)
    parser.add_argument("--assets", default="")
    parser.add_argument("--mast", type=float, nargs=3, required=True)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--half-width", type=float, default=150.0)
    parser.add_argument("--threshold-db", type=float, default=-140.0)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--carrier-ghz", type=float, default=3.5)
    parser.add_argument("--only", default="", help="settings whose name contains this")
    options = parser.parse_args()
    text = with_mast(options.scenario.read_text(), options.mast)
    draw = random.Random(options.seed)
    half = options.half_width
    points = [(draw.uniform(-half, half), draw.uniform(-half, half), 1.5) for _ in range(3 * options.count)]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)

        def write_points(some):
            (place / "rx.csv").write_text("".join(f"{x:.3f},{y:.3f},{z:.3f}\n" for x, y, z in some))

        def measure(setting):
            name, effects, extra = setting
            (place / "s.yaml").write_text(lines_of(effects, extra, text))
            return run(options.greatx, place / "s.yaml", options.assets, place / "rx.csv")

        write_points(points)
        inside = measure(SETTINGS[0])[2]
        points = [p for i, p in enumerate(points) if i not in inside][: options.count]
        write_points(points)
        distances = [math.dist(p, options.mast) for p in points]
        print(
            "| effects | coverage | LOS: loss, dB | lg DS/s | lg ASD/° | lg ASA/° "
            "| NLOS: loss, dB | lg DS/s | lg ASD/° | lg ASA/° | K, dB | core-ms a receiver |"
        )
        print("|" + "---|" * 12)
        for setting in SETTINGS:
            if options.only not in setting[0]:
                continue
            records, used, _ = measure(setting)
            links = [Link(r) for r in records if r.get("kind") == "receiver"]
            print(
                row(setting[0], links, distances, options.threshold_db, f"{1e3 * used / len(links):.0f}"),
                flush=True,
            )
            last = links
        for name in ("UMi", "UMa"):
            print(of_3gpp(name, options.carrier_ghz))
        print("\nMean share of the power in the last row, %:\n\n| receivers | " + " | ".join(KINDS) + " |")
        print("|" + "---|" * (len(KINDS) + 1))
        for name, sight in (("in sight", True), ("not in sight", False)):
            some = [link for link in last if link.count and link.sight == sight]
            means = [100.0 * statistics.mean(link.shares[kind] for link in some) for kind in KINDS]
            print(f"| {name}, {len(some)} | " + " | ".join(f"{mean:.1f}" for mean in means) + " |")


if __name__ == "__main__":
    main()
