# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests greatx.campaign on a campaign that the program makes."""

import functools
import os
import pathlib
import pickle
import subprocess
import tempfile
import unittest

import numpy as np

import greatx

BASE = """
greatx: 1
name: base
ticks: 3
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [1, -20, 6]}
    sensors: [{name: a, type: antenna}]
  - name: uav
    trajectory: {type: bezier, box: {min_m: [-3, -15, 3], max_m: [3, 15, 8]}}
    sensors:
      - {name: a, type: antenna}
      - {name: cam, type: camera, rate_hz: 10, width: 24, height: 16, fov_deg: 90, outputs: [rgb]}
channels:
  - {name: csi, tx: bs/a, rx: [uav/a], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}
"""
CAMPAIGN = """
greatx_campaign: 1
name: small
base: base.yaml
sequences: 4
axes:
  light:
    day: {}
    dusk: {environment: {sun: {elevation_deg: 3}}}
split: {train: 0.5, validation: 0.25, test: 0.25}
"""


#: goes away with the process
TEMPORARY = tempfile.TemporaryDirectory()


@functools.lru_cache(maxsize=None)
def made() -> pathlib.Path:
    folder = pathlib.Path(TEMPORARY.name)
    (folder / "base.yaml").write_text(BASE)
    (folder / "small.yaml").write_text(CAMPAIGN)
    for command in ("run", "merge"):
        subprocess.run(
            [
                os.environ["GREATX_PROGRAM"],
                "campaign",
                command,
                folder / "small.yaml",
                "-o",
                folder / "out",
                "-q",
            ],
            check=True,
        )
    return folder / "out"


class Campaigns(unittest.TestCase):
    def setUp(self):
        self.campaign = greatx.campaign(made())

    def test_cells_are_data_sets(self):
        self.assertEqual(self.campaign.cells, ["day", "dusk"])
        self.assertEqual(len(self.campaign["day"].sequences), 4)
        # The same trajectory by day and at dusk.
        first, second = (self.campaign[cell].sequences[2].poses.position[:] for cell in ("day", "dusk"))
        np.testing.assert_array_equal(first, second)
        with self.assertRaisesRegex(KeyError, "day, dusk"):
            self.campaign["night"]

    def test_splits_hold_each_trajectory_once(self):
        parts = [self.campaign.sequences("day", split) for split in ("train", "validation", "test")]
        self.assertEqual(sorted(sum(parts, [])), [0, 1, 2, 3])
        self.assertEqual(parts[0], self.campaign.sequences("dusk", "train"))
        with self.assertRaises(ValueError):
            self.campaign.sequences("day", "exam")

    def test_samples_go_through_all_cells(self):
        train = self.campaign.sequences("day", "train")
        samples = self.campaign.samples(["csi/cfr", "uav/cam/rgb"], split="train")
        self.assertEqual(len(samples), 2 * len(train) * 3)
        self.assertEqual({item["cell"] for item in samples}, {"day", "dusk"})
        self.assertTrue({item["sequence"] for item in samples} <= set(train))
        last = samples[-1]
        self.assertEqual((last["cell"], last["sequence"], last["tick"]), ("dusk", train[-1], 2))
        expected = self.campaign["dusk"].sequences[train[-1]]["csi"].cfr[2]
        np.testing.assert_array_equal(last["csi/cfr"], expected)
        again = pickle.loads(pickle.dumps(samples))
        np.testing.assert_array_equal(again[0]["uav/cam/rgb"], samples[0]["uav/cam/rgb"])
        with self.assertRaises(IndexError):
            samples[len(samples)]

    def test_a_query_selects_records(self):
        rows = self.campaign.query(
            "SELECT cell, sequence, tick, data || '/' || file FROM records WHERE kind = ? AND split = ?",
            ("camera", "train"),
        )
        self.assertEqual(len(rows), 2 * len(self.campaign.sequences("day", "train")) * 3)
        for _, _, _, file in rows:
            self.assertTrue((made() / file).is_file())
        x, gain = self.campaign.query(
            "SELECT r.x, l.path_gain_db FROM records r JOIN links l USING (record) "
            "WHERE r.cell = 'day' AND r.sequence = 1 AND r.tick = 2"
        )[0]
        sequence = self.campaign["day"].sequences[1]
        self.assertAlmostEqual(x, float(sequence.poses.position[2][1][0]), 12)
        self.assertAlmostEqual(gain, 10 * np.log10(float(sequence["csi"].path_gain[2][0, 0])), 9)

    def test_a_faulty_folder_is_an_error_by_name(self):
        with self.assertRaisesRegex(greatx.DatasetError, "splits.csv"):
            greatx.campaign(made() / "data")
        copy = pathlib.Path(TEMPORARY.name) / "faulty"
        copy.mkdir()
        (copy / "splits.csv").write_text("cell,sequence,split\nday,0,exam\n")
        with self.assertRaisesRegex(greatx.DatasetError, "splits.csv:2"):
            greatx.campaign(copy)


if __name__ == "__main__":
    unittest.main()
