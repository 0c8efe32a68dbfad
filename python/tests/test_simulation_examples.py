# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the examples that compute, with those of their optional packages that are installed."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


class SimulationExamples(unittest.TestCase):
    def run_example(self, name, *words):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, EXAMPLES / name],
                cwd=folder,
                text=True,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=os.environ,
            )
        self.assertEqual(done.returncode, 0, done.stdout)
        for word in words:
            self.assertRegex(done.stdout, word)

    def test_paths(self):
        self.run_example(
            "paths.py",
            "line of sight",
            r"H \(2, 2, 1, 64, 1, 256\) complex64",
            "40 receivers",
            "no torch|tensor",
        )

    def test_radio_map(self):
        self.run_example("radio_map.py", "south/array: serves", "weakest: -", "radio_map.png|no matplotlib")

    def test_precoding(self):
        self.run_example(
            "precoding.py", "64 ports", r"zero-forcing .* together \d+", "precoding.png|no matplotlib"
        )

    def test_calibrate_materials(self):
        self.run_example(
            "calibrate_materials.py", r"Gauss-Newton, \d steps: misfit .*e-1", "torch.optim.LBFGS|no torch"
        )

    def test_localise(self):
        self.run_example(
            "localise.py", r"start: 5918\.\d+ mm away", r"H, 0 paths born, 0 died: 0\.00000\d mm"
        )

    def test_stream(self):
        self.run_example("stream.py", r"1\.90 s: ", "a beam that is a tick old loses")


if __name__ == "__main__":
    unittest.main()
