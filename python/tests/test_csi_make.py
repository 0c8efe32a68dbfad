# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests how greatx makes channel sets, against closed forms and against itself."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

from greatx.errors import Error

# PYTHONPATH names the folder of the compiled module, which has no tasks.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from tasks.common.config import load_config  # noqa: E402
from tasks.csi_feedback import make, sets  # noqa: E402
from tasks.csi_feedback.domain import FOLDER, Domain, counts  # noqa: E402

C = 299792458.0
#: A street in which waves neither bounce nor pass walls, and are plane.
STREET = [
    "generate={kind: canyon, seed: 9, size_m: 120}",
    "effects={reflection: off, gas: off, foliage: off, wave_curvature: off, beam_squint: off}",
    "sites=[[0, -40, 12, 30]]",
    "low_m=[-4, -10, 1.5]",
    "high_m=[4, 50, 1.5]",
]


def domain(*changes):
    return load_config(Domain, FOLDER, "city", [*STREET, *changes])


def quietly(*arguments):
    return make.make(*arguments, report=lambda text: None)


class Make(unittest.TestCase):
    def test_a_line_of_sight_is_the_closed_form(self):
        street = domain()
        made = quietly(street, 20, 1)
        k = np.arange(street.subcarriers) - street.subcarriers // 2
        frequency = street.carrier_hz + k * street.bandwidth_hz / street.subcarriers
        *site, yaw = street.sites[0]
        axis = np.array(
            [-np.sin(np.radians(yaw)), np.cos(np.radians(yaw)), 0]
        )  # of the ports: +y of the mount
        place = (np.arange(32) - 15.5) * 0.5
        for x, position in zip(made.channels, made.position_m):
            away = position - site
            distance = np.linalg.norm(away)
            turns = -frequency * distance / C + (place * (away @ axis) / distance)[:, None]
            response = C / (4 * np.pi * street.carrier_hz * distance) * np.exp(2j * np.pi * turns)
            expected, _ = make.angular_delay(response[None], 32)
            self.assertLess(np.linalg.norm(x - expected[0]) / np.linalg.norm(x), 1e-5)
            delay = np.square(np.abs(x)).sum(0).argmax()
            self.assertLessEqual(abs(delay - distance / C * street.bandwidth_hz), 0.5 + 1e-6)

    def test_users_are_counted_and_follow_from_the_seed(self):
        street = domain("low_m=[-60, -60, 1.5]", "high_m=[60, 60, 1.5]")
        first, again, other = (quietly(street, 12, seed) for seed in (3, 3, 4))
        np.testing.assert_array_equal(first.channels, again.channels)
        self.assertFalse(np.array_equal(first.position_m, other.position_m))
        users = first.facts["users"]
        self.assertEqual(users["drawn"], 12 + users["without_path"] + users["too_late"])
        self.assertGreater(users["without_path"], 0)
        self.assertEqual(users["too_late"], 0)
        self.assertIn("line_of_sight", first.facts["effects"])
        self.assertNotIn("reflection", first.facts["effects"])
        self.assertEqual(first.facts["scene"]["generate"], {"kind": "canyon", "seed": 9, "size_m": 120.0})

    def test_a_batch_is_no_part_of_the_result(self):
        street = domain()
        small, large = quietly(street, 5, 1), quietly(street, 300, 1)
        np.testing.assert_allclose(small.channels, large.channels[:5], rtol=1e-6, atol=1e-12)

    def test_power_that_arrives_too_late_is_left_out(self):
        # Bins of 2.5 ns: 32 of them end after 24 m.
        street = domain("bandwidth_hz=400e6", "sites=[[0, -20, 5, 0]]", "low_m=[0, -10, 1.5]")
        made = quietly(street, 8, 1)
        self.assertGreater(made.facts["users"]["too_late"], 0)
        self.assertLess(np.linalg.norm(made.position_m - [0, -20, 5], axis=1).max(), 25)

    def test_the_sites_share_the_users(self):
        self.assertEqual(counts(10, 4), [3, 3, 2, 2])
        made = quietly(domain("sites=[[0, -40, 12, 30], [0, 40, 12, 0]]"), 5, 1)
        self.assertEqual(made.facts["users"]["of_site"], [3, 2])

    def test_faults(self):
        with self.assertRaisesRegex(Error, "expected at least one for each"):
            quietly(domain(), 0, 1)
        with self.assertRaisesRegex(Error, "expected a scene"):
            quietly(domain("generate=null"), 1, 1)
        with self.assertRaisesRegex(Error, "expected more than 1 %"), mock.patch.object(make, "BATCH", 16):
            quietly(domain("low_m=[0, 0, -9]", "high_m=[1, 1, -8]"), 1, 1)
        with self.assertRaisesRegex(Error, "delays: expected 1 to 1024"):
            domain("delays=2000")
        with self.assertRaisesRegex(Error, "high_m: expected nothing below"):
            domain("high_m=[-9, 0, 0]")

    def test_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "set"
            words = [sys.executable, make.__file__, "city", "-o", out, "--users", "8"]
            words += [part for text in STREET for part in ("--set", text)]
            done = subprocess.run(words, capture_output=True, text=True, env=os.environ)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("8 users of", done.stdout)
            self.assertEqual(len(sets.load(out)), 8)
            done = subprocess.run(words, capture_output=True, text=True, env=os.environ)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)


if __name__ == "__main__":
    unittest.main()
