# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the examples on data sets with those of their optional packages that are installed."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import support

# A stand-in with the part of DeepMIMO 4's interface that the example uses, by DeepMIMO's definition of the
# channel.
DEEPMIMO = """
import glob, types
import numpy as np

ChannelParameters = types.SimpleNamespace


class Dataset:
    def __init__(self, folder, tx):
        self.matrix = {key: np.load(f"{folder}/{key}_t000_tx{tx:03}_r001.npz")[key] \
for key in ("power", "phase", "delay")}

    def compute_channels(self, parameters):
        ofdm, m = parameters.ofdm, {key: np.nan_to_num(value.astype(float)) \
for key, value in self.matrix.items()}
        spacing = ofdm["bandwidth"] / ofdm["subcarriers"]
        a = 10 ** (m["power"] / 20) * np.exp(1j * np.radians(m["phase"])) \
* (self.matrix["power"] == self.matrix["power"])
        a = a * (m["delay"] < 1 / spacing) / np.sqrt(ofdm["subcarriers"])
        turn = np.exp(-2j * np.pi * spacing * ofdm["selected_subcarriers"] * m["delay"][..., None])
        return (a[..., None] * turn).sum(1)[:, None, None]


class MacroDataset:
    def __init__(self, datasets):
        self.datasets = datasets

    def compute_channels(self, parameters):
        return [dataset.compute_channels(parameters) for dataset in self.datasets]


def load(name, max_paths):
    folder = f"deepmimo_scenarios/{name}"
    pairs = [Dataset(folder, tx) for tx in range(len(glob.glob(folder + "/power_*")))]
    return pairs[0] if len(pairs) == 1 else MacroDataset(pairs)
"""

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


class Examples(unittest.TestCase):
    def run_example(self, name, *arguments, code=0, beside=""):
        path = os.pathsep.join([str(EXAMPLES.parent), beside] if beside else [str(EXAMPLES.parent)])
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, EXAMPLES / name, *arguments],
                cwd=folder,
                text=True,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env={**os.environ, "PYTHONPATH": path},
            )
        self.assertEqual(done.returncode, code, done.stdout)
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

    def test_convert_deepmimo_beside_it(self):
        """DeepMIMO returns one data set for one transmitter, and a list of data sets for several."""
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "deepmimo.py").write_text(DEEPMIMO)
            for data in (support.street(), support.space()):
                out = self.run_example("convert_deepmimo.py", data, beside=folder)
                difference = re.search(r"DeepMIMO's channel differs by at most (\S+) of the largest", out)
                self.assertLess(float(difference[1]), 1e-5)

    def test_truth(self):
        out = self.run_example("truth.py", support.truth())
        self.assertIn("van/front, tick 1: flow up to ", out)
        self.assertIn("visibility", out)

    def test_data_sets_without_what_an_example_shows(self):
        for name, data, word in (
            ("truth.py", support.street(), "expected a sensor of kind 'camera' with records of rgb, flow"),
            ("events.py", support.street(), "expected a sensor of kind 'event_camera'"),
            ("load_dataset.py", support.truth(), "expected a sensor of kind 'csi'"),
            ("convert_deepmimo.py", support.truth(), "expected a sensor of kind 'csi'"),
        ):
            out = self.run_example(name, data, code=1)
            self.assertIn(word, out)
            self.assertIn("; the scenario needs a ", out)
            self.assertNotIn("Traceback", out)

    def test_no_argument_prints_the_usage(self):
        for name in ("convert_deepmimo.py", "events.py", "load_dataset.py", "truth.py"):
            self.assertIn(f"python3 python/examples/{name} out/", self.run_example(name, code=1))

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
