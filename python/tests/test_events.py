# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the files of events against each other, DSEC's HDF5 by h5py, and the functions of greatx.Events."""
import unittest

import numpy as np

import greatx
import support


class EventFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ds = greatx.load(support.events())
        cls.camera = cls.ds["car/dvs"]
        cls.events = cls.camera.events()

    def test_stream_is_in_order_and_within_its_records(self):
        e, index = self.events, self.camera.index
        self.assertGreater(len(e), 1000)
        self.assertEqual(e.t.dtype, np.int64)
        key = ((e.t * e.height + e.y) * e.width + e.x) * 2 + e.p
        self.assertTrue((np.diff(key) >= 0).all())
        self.assertLess(e.x.max(), e.width)
        self.assertLess(e.y.max(), e.height)
        offsets = self.camera["t"].offsets
        self.assertEqual(offsets[1], 0)  # the first record has no earlier picture to compare with
        for i in range(1, len(index)):
            t = e.t[offsets[i] : offsets[i + 1]]
            if len(t):
                self.assertGreater(t[0], index[i - 1, 1])
                self.assertLessEqual(t[-1], index[i, 1])

    def test_hdf5_reads_back_as_dsec_does(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("no h5py (Debian: python3-h5py)")
        with h5py.File(self.camera["events"], "r") as file:
            self.assertEqual(
                {k: v.dtype for k, v in file["events"].items()},
                {"t": np.uint32, "x": np.uint16, "y": np.uint16, "p": np.uint8},
            )
            t = file["events/t"][:]
            np.testing.assert_array_equal(t, self.events.t // 1000)
            for name in "xyp":
                np.testing.assert_array_equal(file["events"][name][:], getattr(self.events, name))
            self.assertEqual(file["t_offset"][()], 0)
            ms = file["ms_to_idx"][:]
            self.assertEqual(ms.dtype, np.uint64)
            self.assertEqual(ms[-1], len(t))
            for i, first in enumerate(ms.tolist()):  # ms_to_idx[i] is the first event with t >= 1000 i
                self.assertTrue(first == len(t) or t[first] >= 1000 * i)
                self.assertTrue(first == 0 or t[first - 1] < 1000 * i)

    def test_text_is_the_same_stream(self):
        table = np.loadtxt(self.camera["events_text"], dtype=np.float64)
        np.testing.assert_allclose(table[:, 0] * 1e9, self.events.t, atol=1e-6)
        for column, name in enumerate("xyp", 1):
            np.testing.assert_array_equal(table[:, column], getattr(self.events, name))

    def test_differences(self):
        difference, picture = self.camera["difference"], self.camera["differences"]
        self.assertEqual(difference.dtype, np.int8)
        self.assertEqual(set(np.unique(difference)) - {-1, 0, 1}, set())
        self.assertFalse(difference[0].any())
        self.assertTrue(difference[2].any())
        np.testing.assert_array_equal(
            picture[2], np.choose(difference[2] + 1, [0, 128, 255]).astype(np.uint8)
        )


class EventTensors(unittest.TestCase):
    def setUp(self):
        self.events = greatx.Events(
            t=np.array([0, 10, 10, 25, 40]),
            x=np.array([0, 1, 1, 2, 0], np.uint16),
            y=np.array([0, 0, 1, 1, 0], np.uint16),
            p=np.array([1, 0, 1, 1, 1], np.uint8),
            width=3,
            height=2,
        )

    def test_counts_and_frame(self):
        np.testing.assert_array_equal(self.events.counts(), [[[0, 1, 0], [0, 0, 0]], [[2, 0, 0], [0, 1, 1]]])
        np.testing.assert_array_equal(self.events.frame(), [[2, -1, 0], [0, 1, 1]])
        picture = self.events.picture()
        self.assertEqual(tuple(picture[0, 2]), (128, 128, 128))
        self.assertGreater(picture[0, 0, 0], picture[0, 0, 2])
        self.assertGreater(picture[0, 1, 2], picture[0, 1, 0])

    def test_between_is_open_at_its_beginning(self):
        np.testing.assert_array_equal(self.events.between(0, 25).t, [10, 10, 25])
        self.assertEqual(len(self.events.between(40, 100)), 0)

    def test_voxel_grid_shares_an_event_between_two_bins(self):
        grid = self.events.voxel_grid(5)
        self.assertEqual(grid.dtype, np.float32)
        self.assertAlmostEqual(float(grid.sum()), 3.0)
        np.testing.assert_allclose(grid[:, 1, 2], [0, 0, 0.5, 0.5, 0])
        np.testing.assert_allclose(grid[:, 0, 0], [1, 0, 0, 0, 1])
        np.testing.assert_allclose(self.events.voxel_grid(2, (0, 100))[:, 0, 0], [1.6, 0.4])
        self.assertFalse(self.events.between(50, 60).voxel_grid(3).any())


if __name__ == "__main__":
    unittest.main()
