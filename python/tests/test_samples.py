# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests Dataset.samples and Dataset.torch, the latter with a stand-in for torch and, if installed, with
torch.
"""
import importlib.util
import pickle
import sys
import types
import unittest
from unittest import mock

import numpy as np

import greatx
import support


class Items(unittest.TestCase):
    def setUp(self):
        self.ds = greatx.load(support.street())

    def test_an_item_is_a_tick_at_which_all_sensors_have_a_record(self):
        self.assertEqual(len(self.ds.samples("csi/cfr")), 4)
        samples = self.ds.samples(["csi/cfr", "car/front/rgb"])
        self.assertEqual([item["tick"] for item in samples], [0, 2])
        item = samples[-1]
        self.assertEqual(set(item), {"sequence", "tick", "time_s", "csi/cfr", "car/front/rgb"})
        np.testing.assert_array_equal(item["csi/cfr"], self.ds["csi"].cfr[2])
        np.testing.assert_array_equal(item["car/front/rgb"], self.ds["car/front"].rgb[1])
        self.assertTrue(np.shares_memory(item["csi/cfr"], self.ds["csi"].cfr))
        with self.assertRaises(IndexError):
            samples[2]

    def test_a_sensor_stands_for_its_arrays_of_fixed_shape(self):
        item = self.ds.samples("poses")[1]
        self.assertEqual(item["poses/orientation"].shape, (4, 4))
        item = self.ds.samples("csi")[1]
        self.assertIn("csi/path_count", item)
        self.assertNotIn("csi/delay", item)

    def test_paths_are_padded_to_the_longest(self):
        counts = self.ds["csi"].delay.counts
        samples = self.ds.samples(["csi/paths/delay", "csi/vertex", "csi/cfr"], pad=True)
        for i, item in enumerate(samples):
            self.assertEqual(item["csi/paths/delay"].shape, (counts.max(),))
            self.assertEqual(item["csi/paths/delay_count"], counts[i])
            self.assertEqual(item["csi/vertex"].shape[:1], (counts.max(),))
            np.testing.assert_array_equal(item["csi/paths/delay"][: counts[i]], self.ds["csi"].delay[i])
            self.assertFalse(item["csi/paths/delay"][counts[i] :].any())
            self.assertNotIn("csi/cfr_count", item)
        self.assertEqual(self.ds.samples("csi/delay")[0]["csi/delay"].shape, (counts[0],))
        with self.assertRaisesRegex(ValueError, "car/lidar/points"):
            self.ds.samples("car/lidar/points", pad=True)

    def test_sequences_follow_each_other(self):
        ds = greatx.load(support.space())
        samples = ds.samples("csi/cfr")
        self.assertEqual(
            [(i["sequence"], i["tick"]) for i in samples], [(s, t) for s in (0, 1) for t in range(3)]
        )
        self.assertEqual([i["sequence"] for i in ds.samples("csi/cfr", sequences=[1])], [1, 1, 1])

    def test_what_is_not_there(self):
        for arrays in ("csi/nothing", "uav/front/rgb", "car/lidar/cloud"):
            with self.assertRaisesRegex(KeyError, arrays):
                self.ds.samples(arrays)
        with self.assertRaisesRegex(ValueError, "no arrays"):
            self.ds.samples([])
        with self.assertRaisesRegex(greatx.DatasetError, "no tick"):
            self.ds.samples("csi/cfr", sequences=[])

    def test_pickled(self):
        samples = self.ds.samples(["csi/cfr", "csi/delay"], pad=True)
        _ = samples[0]
        text = pickle.dumps(samples)
        self.assertLess(len(text), 2000)
        np.testing.assert_array_equal(pickle.loads(text)[1]["csi/delay"], samples[1]["csi/delay"])


def stand_in():
    """Returns modules with the part of torch that greatx uses, by NumPy."""
    torch = types.ModuleType("torch")
    torch.from_numpy = np.asarray
    torch.utils = types.ModuleType("torch.utils")
    torch.utils.data = types.ModuleType("torch.utils.data")
    torch.utils.data.Dataset = object
    return {"torch": torch, "torch.utils": torch.utils, "torch.utils.data": torch.utils.data}


class Tensors(unittest.TestCase):
    """Runs with a stand-in for torch. The class RealTorch below runs the same tests with torch."""

    names = ["csi/cfr", "csi/id", "car/front/rgb", "car/front/instance", "csi/rx"]

    def setUp(self):
        if type(self) is Tensors:
            sys.modules.pop("greatx.torch_dataset", None)
            patch = mock.patch.dict(sys.modules, stand_in())
            patch.start()
            self.addCleanup(sys.modules.pop, "greatx.torch_dataset", None)
            self.addCleanup(patch.stop)
        self.ds = greatx.load(support.street())

    def test_items(self):
        data = self.ds.torch(self.names, pad=True)
        self.assertEqual(len(data), 2)
        item = {k: np.asarray(v) for k, v in data[1].items()}
        self.assertEqual(item["csi/cfr"].dtype, np.complex64)
        self.assertEqual(item["car/front/rgb"].dtype, np.uint8)
        self.assertEqual(item["car/front/instance"].dtype, np.int32)  # uint16 on disk
        np.testing.assert_array_equal(
            item["csi/id"].view(np.uint64)[: item["csi/id_count"]], self.ds["csi"].id[2]
        )
        item["csi/cfr"][...] = 0  # a tensor has its own memory, because the file is mapped read-only
        self.assertTrue(self.ds["csi"].cfr[2].any())

    def test_transform(self):
        data = self.ds.torch("csi/cfr", transform=lambda item: item["tick"])
        self.assertEqual([data[i] for i in range(4)], [0, 1, 2, 3])


class NoTorch(unittest.TestCase):
    def test_it_says_so(self):
        sys.modules.pop("greatx.torch_dataset", None)
        with mock.patch.dict(sys.modules, {"torch": None}):
            with self.assertRaisesRegex(ImportError, "pip install torch"):
                greatx.load(support.street()).torch("csi/cfr")


@unittest.skipUnless(importlib.util.find_spec("torch"), "torch is not installed")
class RealTorch(Tensors):
    def test_loader(self):
        import torch

        data = self.ds.torch(self.names, pad=True)
        self.assertIsInstance(data, torch.utils.data.Dataset)
        for workers in (0, 2):
            (batch,) = torch.utils.data.DataLoader(data, batch_size=2, num_workers=workers)
            self.assertEqual(batch["csi/cfr"].dtype, torch.complex64)
            self.assertEqual(tuple(batch["csi/cfr"].shape), (2, *self.ds["csi"].cfr.shape[1:]))
            self.assertEqual(batch["tick"].tolist(), [0, 2])


if __name__ == "__main__":
    unittest.main()
