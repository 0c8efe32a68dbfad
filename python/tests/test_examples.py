# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The examples on data sets run, with whatever of their optional packages is there."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import support

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


class Examples(unittest.TestCase):
    def run_example(self, name, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, EXAMPLES / name, *arguments], cwd=folder, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, env={**os.environ, "PYTHONPATH": str(EXAMPLES.parent)})
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def test_load_dataset(self):
        for folder in (support.street(), support.space()):
            out = self.run_example("load_dataset.py", folder)
            self.assertIn("line of sight: ", out)
            self.assertIn("delay profile", out)

    def test_train_torch(self):
        out = self.run_example("train_torch.py", support.street())
        self.assertRegex(out, "epoch  40|pip install torch")

    def test_convert_deepmimo(self):
        self.assertIn("mean gain", self.run_example("convert_deepmimo.py", support.street()))

    def test_truth(self):
        out = self.run_example("truth.py", support.truth())
        self.assertIn("van/front, tick 1: flow up to ", out)
        self.assertIn("visibility", out)

    def test_events(self):
        out = self.run_example("events.py", support.events())
        self.assertIn("million a second", out)
        self.assertIn("events.ppm", out)

    def test_each_fits_on_two_screens(self):
        for path in EXAMPLES.glob("*.py"):
            self.assertLess(len(path.read_text().splitlines()), 80, path)
            self.assertIn("# %%", path.read_text())


if __name__ == "__main__":
    unittest.main()
