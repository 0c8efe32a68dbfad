# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests greatx.campaign on a campaign that the program makes."""

import functools
import multiprocessing
import os
import pathlib
import pickle
import subprocess
import tempfile
import unittest

import numpy as np

import greatx
import support

BASE = """
greatx: 1
name: base
ticks: 3
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
environment: {clouds: 0}
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


def unlike() -> pathlib.Path:
    """Returns the folder of a campaign of unlike cells: two of `made`, one with other sensors, and one with a
    channel alone."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=TEMPORARY.name))
    (folder / "data").mkdir()
    data = made() / "data"
    cells = {
        "day": data / "day",
        "dusk": data / "dusk",
        "street": support.street(),
        "space": support.space(),
    }
    rows = ["cell,sequence,split"]
    for cell, place in cells.items():
        (folder / "data" / cell).symlink_to(place)
        count = len(greatx.load(place).sequences)
        rows += [f"{cell},{i},{'train' if i < 2 else 'test'}" for i in range(count)]
    (folder / "splits.csv").write_text("\n".join(rows) + "\n")
    return folder


def keys_read(samples, reader, readers, queue):
    """Runs in another process: sends what a reader of ShuffledSamples gets."""
    order = samples.order(reader, readers)
    items = [samples.samples[i] for i in order]
    queue.put([(item["cell"], item["sequence"], item["tick"]) for item in items])


class Loading(unittest.TestCase):
    def test_load_finds_out_what_a_folder_holds(self):
        opened = greatx.load(made())
        self.assertIsInstance(opened, greatx.Campaign)
        self.assertEqual(opened.opened, [])
        with self.assertRaisesRegex(greatx.DatasetError, "no dataset.json"):
            greatx.load(made() / "runs")
        raw = pathlib.Path(tempfile.mkdtemp(dir=TEMPORARY.name))
        (raw / "cells.json").write_text("{}")
        with self.assertRaisesRegex(greatx.DatasetError, "greatx campaign merge"):
            greatx.load(raw)

    def test_nothing_is_opened_before_its_use_and_few_stay_open(self):
        opened = greatx.Campaign(unlike(), most_open=1, most_files=2)
        samples = opened.samples("csi/cfr")
        shuffled = opened.shuffled("csi/cfr", split="train")
        self.assertEqual((opened.opened, len(opened.files)), ([], 0))
        for _ in range(2):
            self.assertEqual(len([item["csi/cfr"] for item in samples]), 12 + 12 + 4 + 6)
            self.assertEqual(opened.opened, ["space"])
            self.assertLessEqual(len(opened.files), 2)
        self.assertEqual(len(list(shuffled)), len(shuffled))
        # An index is read when its sequence is used.
        self.assertNotIn("index", vars(opened["day"].sequences[3]))
        self.assertEqual(len(opened["day"].sequences[3]), 3)

    def test_cells_that_lack_a_sensor(self):
        opened = greatx.load(unlike())
        names = ["csi/cfr", "uav/cam/rgb"]
        with self.assertRaisesRegex(
            greatx.DatasetError, "2 of 4 cells .* 'street' without uav/cam/rgb.*skip"
        ):
            len(opened.samples(names))
        with self.assertRaisesRegex(ValueError, "error, skip, none"):
            opened.samples(names, missing="zeros")
        skipped = opened.samples(names, missing="skip")
        self.assertEqual((skipped.cells, skipped.left_out), (["day", "dusk"], ["street", "space"]))
        self.assertNotIn("csi/cfr_present", skipped[0])
        filled = opened.samples([*names, "csi/paths/delay"], missing="none", pad=True)
        self.assertEqual((len(filled), filled.left_out), (12 + 12 + 4 + 6, []))
        for item in filled:
            has = item["cell"] in ("day", "dusk")
            self.assertEqual((item["csi/cfr_present"], item["uav/cam/rgb_present"]), (True, has))
            self.assertEqual(item["uav/cam/rgb"].shape, (16, 24, 3))
            self.assertEqual(bool(item["uav/cam/rgb"].any()), has)
            # Paths are padded to the longest record of all cells.
            self.assertEqual(len(item["csi/paths/delay"]), len(filled[0]["csi/paths/delay"]))
            record = opened[item["cell"]].sequences[item["sequence"]]["csi"].at(item["tick"])
            self.assertEqual(item["csi/paths/delay_count"], len(record["delay"]))
        without = opened.samples(["uav/cam/rgb", "car/lidar/points"], missing="none")
        self.assertEqual(len(without), 12 + 12 + 2)
        self.assertEqual(without[0]["car/lidar/points"].shape, (0, 4))
        with self.assertRaisesRegex(KeyError, "csi/nothing"):
            len(opened.samples("csi/nothing", missing="none"))

    def test_each_item_comes_once_an_epoch(self):
        opened = greatx.load(unlike())

        def keys(items):
            return [(item["cell"], item["sequence"], item["tick"]) for item in items]

        wanted = sorted(keys(opened.samples("csi/cfr", split="train")))
        orders = []
        for epoch in range(2):
            for buffer in (1, 3, 1000):
                shuffled = opened.shuffled("csi/cfr", split="train", seed=5, buffer=buffer)
                shuffled.set_epoch(epoch)
                first = keys(shuffled)
                self.assertEqual(sorted(first), wanted)
                self.assertEqual(first, keys(shuffled))  # the same order again
                orders.append(first)
        self.assertEqual(len({tuple(order) for order in orders}), 6)
        self.assertNotIn(wanted, orders)
        # With one place in the buffer, a sequence stays together, in the order of its ticks.
        for a, b in zip(orders[0], orders[0][1:]):
            self.assertTrue(a[:2] != b[:2] or a[2] < b[2])
        parts = [opened.shuffled("csi/cfr", split="train", seed=5, part=(i, 3)) for i in range(3)]
        self.assertEqual(sorted(sum((keys(part) for part in parts), [])), wanted)
        self.assertEqual(sum(len(part) for part in parts), len(wanted))
        for bad in ({"buffer": 0}, {"seed": -1}, {"part": (2, 2)}):
            with self.assertRaises(ValueError):
                opened.shuffled("csi/cfr", **bad)

    def test_workers_by_fork_and_by_spawn(self):
        opened = greatx.load(unlike())
        wanted = sorted(
            (item["cell"], item["sequence"], item["tick"])
            for item in opened.samples("csi/cfr", split="train")
        )
        shuffled = opened.shuffled("csi/cfr", split="train", seed=2)
        next(iter(shuffled))  # files are open when the workers begin
        for method in ("fork", "spawn"):
            context = multiprocessing.get_context(method)
            queue = context.Queue()
            workers = [
                context.Process(target=keys_read, args=(shuffled, reader, 3, queue)) for reader in range(3)
            ]
            for worker in workers:
                worker.start()
            found = [queue.get(timeout=60) for _ in workers]
            for worker in workers:
                worker.join()
            self.assertEqual(sorted(sum(found, [])), wanted)
            self.assertTrue(all(found))


if __name__ == "__main__":
    unittest.main()
