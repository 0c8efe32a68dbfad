# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests greatx.batches and greatx.modalities on data sets and on a campaign."""
import gc
import importlib.util
import pickle
import sys
import unittest
from unittest import mock

import numpy as np

import greatx
from greatx import inputs
from greatx.batch_reader import BatchReader, order_of, samples_of
from greatx.modalities import (
    Computed,
    CsiMap,
    Depth,
    EventVoxels,
    Picture,
    RadarMap,
    RangeImage,
    Source,
    Values,
)
import support
import test_campaign

HAS_TORCH = importlib.util.find_spec("torch") is not None

MODALITIES = {
    "rgb": Picture("car/front", 20),
    "depth": Depth("car/front", (12, 16), 80.0),
    "csi": CsiMap("csi", 16),
    "radar": RadarMap("car/radar"),
    "lidar": RangeImage("car/lidar", (8, 32)),
    "events": EventVoxels("car/dvs", 3, 16),
    "position": Values("poses/position"),
    "gain": Computed(("csi/path_gain",), np.log10),
}


def rig(*arguments):
    """Returns a data set of 3 sequences with 6 items each."""
    name = "rig_batches" + "".join(arguments).replace("--", "_")
    return greatx.load(support.made(name, support.RIG, "--sequences", "3", "--ticks", "12", *arguments))


class Readers(unittest.TestCase):
    """What needs no torch."""

    @classmethod
    def setUpClass(cls):
        cls.ds = rig()
        cls.reader = BatchReader(samples_of(cls.ds, MODALITIES), MODALITIES)

    def test_an_item_is_what_the_functions_make_of_its_records(self):
        out = self.reader.empty(1)
        self.assertIsNone(self.reader.read(np.array([8]), out))
        tick = self.ds.sequences[1].at(4)
        self.assertEqual([out[name][0] for name in ("sequence", "tick", "time_s")], [1, 4, tick.time_s])
        csi = self.ds.sequences[1]["csi"]
        h = inputs.link_cfr(tick["csi"].cfr)
        expected = {
            "rgb": inputs.picture(tick["car/front"].rgb, 20),
            "depth": inputs.depth_map(tick["car/front"].depth, (12, 16), 80.0),
            "csi": inputs.csi_map(h, 16, panel=inputs.panel_of(csi.metadata["transmitters"][0])),
            "radar": inputs.radar_map(tick["car/radar"].range_azimuth),
            "lidar": inputs.lidar_map(
                tick["car/lidar"].cloud["points"], self.ds.sensors["car/lidar"].metadata, (8, 32)
            ),
            "events": inputs.event_voxels(
                tick["car/dvs"].events(), 3, 16, (round(2e9 / 30), round(4e9 / 30))
            ),
            "position": tick["poses"].position,
            "gain": np.log10(tick["csi"].path_gain),
        }
        for name, value in expected.items():
            np.testing.assert_array_equal(out[name][0], value, name)
            self.assertTrue(np.any(value), name)
            self.assertEqual(self.reader.fields[name].dtype, value.dtype)

    def test_a_compressed_data_set_gives_the_same(self):
        packed = rig("--compression", "fast")
        other = BatchReader(samples_of(packed, MODALITIES), MODALITIES)
        numbers = np.array([17, 3, 3, 0])
        one, two = self.reader.empty(4), other.empty(4)
        self.reader.read(numbers, one)
        other.read(numbers, two)
        for name in one:
            np.testing.assert_array_equal(one[name], two[name], name)

    def test_a_range_image_has_a_row_for_each_channel(self):
        make = RangeImage("car/lidar").bind(Source.of(self.ds))
        item = self.ds.samples("car/lidar/points")[0]
        self.assertEqual(make(item, None).shape, (2, 8, 256))

    def test_spans_of_events_follow_the_clock(self):
        source = Source.of(self.ds)
        for name in ("car/dvs", "csi"):
            sensor = self.ds.sequences[0][name]
            facts = source[name]
            for before, (tick, time_ns) in zip(sensor.ticks, sensor.index[1:, :2]):
                self.assertEqual(facts.tick_before(int(tick)), before)
                self.assertEqual(facts.time_ns(int(tick)), time_ns)

    def test_values_have_types_that_torch_takes(self):
        make = Values("a").bind(Source({}, 1, ""))
        for given, wanted in (("u1", "u1"), ("u2", "i4"), ("u4", "i8"), ("u8", "i8"), ("c8", "c8")):
            value = make({"a": np.array([1, 2], given)}, None)
            self.assertEqual(value.dtype, np.dtype(wanted))
        self.assertEqual(make({"a": np.array([2**64 - 1], "u8")}, None)[0], -1)

    def test_an_order_is_a_permutation_of_its_own_for_each_epoch_and_seed(self):
        orders = [order_of(20, seed, epoch) for seed in (0, 1) for epoch in (0, 1)]
        for order in orders:
            self.assertEqual(sorted(order), list(range(20)))
        self.assertEqual(len({tuple(order) for order in orders}), 4)
        np.testing.assert_array_equal(order_of(20, 1, 1), orders[3])
        parts = [order_of(20, 1, 1, part=(i, 3)) for i in range(3)]
        self.assertEqual([len(part) for part in parts], [6, 6, 6])
        self.assertEqual(len(set(np.concatenate(parts))), 18)
        np.testing.assert_array_equal(order_of(4, 0, 0, shuffle=False), np.arange(4))

    def test_a_reader_is_picklable(self):
        again = pickle.loads(pickle.dumps(self.reader))
        one, two = again.empty(2), self.reader.empty(2)
        again.read(np.array([1, 2]), one)
        self.reader.read(np.array([1, 2]), two)
        np.testing.assert_array_equal(one["events"], two["events"])

    def test_what_is_not_there(self):
        with self.assertRaisesRegex(KeyError, "car/nothing"):
            samples_of(self.ds, {"rgb": Picture("car/nothing")})
        with self.assertRaisesRegex(greatx.Error, "'rgb': expected one of greatx.modalities"):
            samples_of(self.ds, {"rgb": "car/front/rgb"})
        with self.assertRaisesRegex(greatx.Error, "another name than 'tick'"):
            samples_of(self.ds, {"tick": Values("csi/cfr")})
        with self.assertRaisesRegex(greatx.Error, "split: expected `sequences`"):
            samples_of(self.ds, MODALITIES, split="train")
        with self.assertRaisesRegex(greatx.Error, "data: expected a greatx.Dataset"):
            samples_of("folder", MODALITIES)
        with self.assertRaisesRegex(greatx.Error, "expected one or more, found none"):
            samples_of(self.ds, {})

    def test_without_torch_it_says_so(self):
        sys.modules.pop("greatx.torch_batches", None)
        with mock.patch.dict(sys.modules, {"torch": None}):
            with self.assertRaisesRegex(ImportError, "pip install torch"):
                greatx.batches(self.ds, MODALITIES)


@unittest.skipUnless(HAS_TORCH, "torch is not installed")
class Batches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ds = rig()

    def loader(self, batch=4, **options):
        return greatx.batches(self.ds, MODALITIES, batch, **options)

    def copies(self, loader):
        return [{k: np.array(v) if k != "cell" else list(v) for k, v in batch.items()} for batch in loader]

    def assert_same(self, one, two):
        self.assertEqual(len(one), len(two))
        for a, b in zip(one, two):
            self.assertEqual(a.keys(), b.keys())
            for name in a:
                np.testing.assert_array_equal(a[name], b[name], name)

    def test_each_item_comes_once_an_epoch_in_an_order_of_the_seed(self):
        loader = self.loader(seed=5)
        self.assertEqual((len(loader), loader.items), (5, 18))
        epochs = [self.copies(loader) for _ in range(2)]
        for batches in epochs:
            self.assertEqual([len(b["tick"]) for b in batches], [4, 4, 4, 4, 2])
            self.assertEqual(sorted(np.concatenate([b["item"] for b in batches])), list(range(18)))
        self.assertNotEqual(epochs[0][0]["item"].tolist(), epochs[1][0]["item"].tolist())
        again = self.loader(seed=5)
        again.set_epoch(1)
        self.assert_same(epochs[1], self.copies(again))
        self.assertNotEqual(
            self.copies(self.loader(seed=6))[0]["item"].tolist(), epochs[0][0]["item"].tolist()
        )

    def test_workers_change_nothing(self):
        for context, workers in (("fork", 2), ("spawn", 1)):
            expected, loader = self.loader(seed=3), self.loader(seed=3, workers=workers, context=context)
            for _ in range(2):
                self.assert_same(self.copies(expected), self.copies(loader))

    def test_batches_that_are_kept_stay_as_they_are(self):
        for workers in (0, 2):
            loader = self.loader(seed=3, workers=workers)
            kept = [batch["csi"][1:] for batch in loader]  # views of the batches' tensors
            for batch, tensor in zip(self.copies(self.loader(seed=3)), kept):
                np.testing.assert_array_equal(batch["csi"][1:], tensor)

    def test_memory_is_used_again(self):
        for workers, most in ((0, 2), (1, 4)):
            loader = self.loader(workers=workers)
            for _ in range(3):
                for batch in loader:
                    del batch
            gc.collect()
            self.assertLessEqual(loader._pool.count, most)

    def test_an_epoch_that_is_left_early_does_no_harm(self):
        for workers in (0, 2):
            loader = self.loader(seed=3, workers=workers)
            for batch in loader:
                break
            self.assertEqual(loader.epoch, 1)
            loader.set_epoch(0)
            self.assert_same(self.copies(self.loader(seed=3)), self.copies(loader))

    def test_a_choice_of_items(self):
        self.assertEqual([b["sequence"].tolist() for b in self.loader(sequences=[2])], [[2] * 4, [2] * 2])
        loader = self.loader(items=[7, 2, 9], shuffle=False, batch=2)
        self.assertEqual([b["item"].tolist() for b in loader], [[7, 2], [9]])
        self.assertEqual(len(self.loader(drop_last=True)), 4)
        halves = [self.copies(self.loader(seed=1, part=(i, 2))) for i in range(2)]
        self.assertEqual(sorted(np.concatenate([b["item"] for h in halves for b in h])), list(range(18)))
        for options, message in (
            ({"batch": 0}, "batch: expected 1"),
            ({"items": [18]}, "items: expected numbers below 18"),
            ({"batch": 19, "drop_last": True}, "expected items for a batch"),
            ({"part": (2, 2)}, "part: expected"),
        ):
            with self.assertRaisesRegex(greatx.Error, message):
                list(self.loader(**options))

    def test_a_network_can_write_into_a_batch(self):
        batch = next(iter(self.loader()))
        batch["rgb"].mul_(0)
        self.assertFalse(batch["rgb"].any())

    def test_a_fault_in_a_worker_is_raised(self):
        loader = greatx.batches(self.ds, {"bad": Computed(("csi/path_gain",), faulty)}, 4, workers=1)
        faulty.after = 1
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            list(loader)


def faulty(value):
    """Works for the first item, by which the loader learns shapes."""
    faulty.after -= 1
    return value if faulty.after >= 0 else 1 / 0


faulty.after = 1


@unittest.skipUnless(HAS_TORCH, "torch is not installed")
class Campaigns(unittest.TestCase):
    def test_cells_and_splits(self):
        campaign = greatx.load(test_campaign.made())
        modalities = {"rgb": Picture("uav/cam", 8), "h": Values("csi/cfr")}
        loader = greatx.batches(campaign, modalities, 5, split="train", seed=2, workers=1)
        train = campaign.sequences("day", "train")
        seen = []
        for batch in loader:
            for i, cell in enumerate(batch["cell"]):
                sequence, tick = int(batch["sequence"][i]), int(batch["tick"][i])
                seen.append((cell, sequence, tick))
                expected = campaign[cell].sequences[sequence]["csi"].at(tick).cfr
                np.testing.assert_array_equal(batch["h"][i], expected)
        self.assertEqual(sorted(seen), [(c, s, t) for c in ("day", "dusk") for s in train for t in range(3)])
        with self.assertRaisesRegex(greatx.Error, "sequences: expected a split"):
            greatx.batches(campaign, modalities, sequences=[0])

    def test_missing_modalities_are_zeros(self):
        campaign = greatx.load(test_campaign.unlike())
        modalities = {"rgb": Picture("uav/cam", 8), "lidar": RangeImage("car/lidar", (8, 16))}
        (batch,) = greatx.batches(campaign, modalities, 100, missing="none", shuffle=False)
        self.assertEqual(len(batch["tick"]), 12 + 12 + 2)
        for name, cells in (("rgb", ("day", "dusk")), ("lidar", ("street",))):
            for cell, present, value in zip(batch["cell"], batch[name + "_present"], batch[name]):
                self.assertEqual(bool(present), cell in cells)
                self.assertEqual(bool(value.any()), cell in cells)


if __name__ == "__main__":
    unittest.main()
