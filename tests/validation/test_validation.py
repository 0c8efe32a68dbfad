# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the quick sections of validation.py, holds their figures against closed forms, and requires that
docs/validation.md shows what they print."""
import math
import pathlib
import re
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import validation  # it also finds tests/peer

import numpy as np

import published

PAGE = HERE.parents[1] / "docs/validation.md"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")
TIME = re.compile(r"  +\d+\.\d s$")  # the last column; another machine has other times


def blocks(text):
    """Returns the lines that the page shows for each section: {section: [line, ...]}."""
    found = {}
    for body in re.findall(r"^```\n(.*?)^```$", text, re.DOTALL | re.MULTILINE):
        command, *lines = body.splitlines()
        section = re.fullmatch(r"python3 tests/validation/validation\.py --section (\w+)", command)
        if section:
            found[section[1]] = [line for line in lines if line.strip()]
    return found


def as_number(text):
    """Returns (value, one and a half units of its last digit)."""
    mantissa, _, exponent = text.partition("e")
    digits = len(mantissa.partition(".")[2])
    return float(text), 1.5 * 10.0 ** (int(exponent or 0) - digits)


def agree(shown, printed):
    """Tells whether a line of the page is the printed one: the same words, and numbers that differ by at most
    one and a half units of the last digit. Errors (1.1e-07) may be smaller or up to twice as large."""
    shown, printed = TIME.sub("", shown), TIME.sub("", printed)
    if NUMBER.sub("#", shown).split() != NUMBER.sub("#", printed).split():
        return False
    for a, b in zip(NUMBER.findall(shown), NUMBER.findall(printed)):
        (x, unit), (y, _) = as_number(a), as_number(b)
        if "e-" in a:
            if y > 2 * x:
                return False
        elif abs(x - y) > unit + 1e-12:
            return False
    return True


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shown = blocks(PAGE.read_text(encoding="utf-8"))

    def run_section(self, name, **more):
        """Runs a section, requires each line that it prints to be on the page, and returns its figures."""
        lines = []
        pictures = []
        figures = validation.SECTIONS[name](
            lines.append, lambda file, text: pictures.append((file, text)), **more
        )
        lines = [line for line in lines if line.strip()]
        # The last line of a block has the time of the section, the one before it may be a slow row.
        shown = self.shown[name][: len(lines)]
        self.assertEqual(len(self.shown[name]) - len(lines), 2 if more else 1, f"docs/validation.md: {name}")
        for candidate, line in zip(shown, lines):
            self.assertTrue(agree(candidate, line), f"docs/validation.md, {name}:\n{candidate}\n{line}")
        for file, text in pictures:
            self.assertIn(f"images/validation_{file}", PAGE.read_text(encoding="utf-8"))
            self.assertNotRegex(text, r"\b(nan|inf)\b", file)
        return figures

    def test_shows_every_section(self):
        self.assertEqual(set(self.shown), set(validation.SECTIONS))

    def test_two_ray(self):
        figures = self.run_section("two_ray")
        # The transfers are complex64: two terms of 6e-8, and the path's length in fp64.
        self.assertLess(figures["error"], 3e-7)
        self.assertEqual([row["h1"] for row in figures["rows"]], sorted(published.FEUERSTEIN))
        for row in figures["rows"]:
            self.assertAlmostEqual(row["breakpoint"], 4 * row["h1"] * 1.7 * 1.9e9 / 299792458, places=6)
            # Far beyond the breakpoint the field of two opposite rays is pi/2 times that of P.1411's line.
            self.assertGreater(row["least"], -20 * math.log10(math.pi / 2))
            self.assertLess(row["least"], -3.7)
            # The ground's reflection is not quite -1, so the last maximum is a little further out.
            self.assertLess(abs(row["maximum"] / row["clearance"] - 1), 0.05)
            self.assertTrue(1.8 < row["exponents"][0] < 2 < row["exponents"][1] < 4)

    def test_street(self):
        for figures in self.run_section("street").values():
            self.assertLess(figures["error"], 1e-6)  # 20 terms of 6e-8 at most
            self.assertEqual(figures["wrong"], 0)
            self.assertEqual(figures["count"], 20)

    def test_corner(self):
        figures = self.run_section("corner", quick=True)
        self.assertGreater(figures["reflections, depth 3"]["dark"], 50)
        self.assertGreater(figures["reflections, depth 8"]["dark"], 25)
        for depth in (3, 6):
            self.assertEqual(figures[f"with one edge, depth {depth}"]["dark"], 0)

    def test_edge(self):
        figures = self.run_section("edge")
        # A conductor's image wave is about sin(delta/2) of the shadow's, delta = 0.07 rad at v = 4, and the
        # mean over both polarizations takes it off.
        self.assertLess(figures["knife"][0], 0.01)
        self.assertLess(figures["knife"][1], 0.15)
        self.assertLess(figures["corner"]["materials"], 1)

    def test_walls(self):
        figures = self.run_section("walls")
        self.assertLess(figures["referee"], 2e-6)  # complex64: 8.7 dB times 6e-8, and its square root
        self.assertEqual(sum(map(len, figures["samples"].values())), len(published.MEASURED_WALLS))


class Comparison(unittest.TestCase):
    """A comparison that cannot fail would prove nothing."""

    def test_sees_another_figure(self):
        line = "exponents, greatx   1.24, 3.25   1.1e-07"
        self.assertTrue(agree(line, "exponents, greatx  1.25, 3.24  2.0e-07"))
        self.assertTrue(agree("row  0.7   4.4 s", "row  0.8   9.9 s"))
        self.assertFalse(agree(line, line.replace("1.24", "1.26")))
        self.assertFalse(agree(line, line.replace("1.1e-07", "2.3e-07")))
        self.assertFalse(agree(line, line.replace("greatx", "others")))
        self.assertFalse(agree(line, line + " 7"))


class Published(unittest.TestCase):
    """Checks the published models at figures that were computed by hand from their documents."""

    def test_models(self):
        # TR 38.901, Table 7.4.1-1: 32.4 + 42 + 20 lg 3.5 at 100 m; the NLOS row at 100 m.
        self.assertAlmostEqual(float(published.umi_loss("LOS", 3.5e9, 100)), 85.2814, places=3)
        self.assertAlmostEqual(float(published.umi_loss("NLOS", 3.5e9, 100)), 104.5887, places=3)
        # Beyond the breakpoint of 4 * 9 * 0.5 * f/c = 210 m the two branches meet within 0.1 dB.
        bend = math.hypot(4 * 9 * 0.5 * 3.5e9 / 299792458, 8.5)
        branches = [float(published.umi_loss("LOS", 3.5e9, bend * (1 + e))) for e in (-1e-9, 1e-9)]
        self.assertLess(abs(branches[1] - branches[0]), 0.1)
        self.assertAlmostEqual(published.p1411_site_general("LOS", 1e9, 100), 29.2 + 42.4, places=9)
        self.assertAlmostEqual(published.p1411_site_general("NLOS", 1e9, 100), 10.2 + 80, places=9)
        # At the breakpoint P.1411's lower bound is free space - 6.02 dB.
        bend = published.breakpoint(2e9, 4, 1.5)
        median, low, high = published.p1411_street(2e9, 4, 1.5, bend)
        self.assertAlmostEqual(float(published.free_space(2e9, bend) - low), 20 * math.log10(2), places=6)
        self.assertAlmostEqual(float(median - low), 6, places=9)
        self.assertAlmostEqual(float(high - low), 20, places=9)
        # 4.1.3.2: 20 dB at 30 m behind the corner's line, 60 dB a decade beyond.
        loss = published.p1411_corner_shf(2e9, 80, np.array([41.0, 80 + 2 * 40.0]), 20, 4, 1.5)
        start = float(published.p1411_street(2e9, 4, 1.5, 80)[0])
        self.assertAlmostEqual(float(loss[0]) - start, 20 + 60 * math.log10(121 / 120), places=6)
        self.assertAlmostEqual(float(loss[1]) - start, 20 + 60 * math.log10(240 / 120), places=6)

    def test_knife_edge(self):
        self.assertAlmostEqual(float(published.knife_edge_exact(0.0)), 6.0206, places=4)
        self.assertAlmostEqual(float(published.knife_edge_exact(1.0)), 13.8641, places=4)
        v = np.linspace(-0.75, 4, 50)
        self.assertLess(np.max(np.abs(published.knife_edge(v) - published.knife_edge_exact(v))), 0.15)

    def test_fresnel_clearance(self):
        d = published.fresnel_clearance(1.9e9, 8.5, 1.7)
        longer = math.hypot(d, 10.2) - math.hypot(d, 6.8)
        self.assertAlmostEqual(longer, 299792458 / 1.9e9 / 2, places=9)


if __name__ == "__main__":
    unittest.main()
