# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests greatx.load: the places of arrays, views of files, and messages about faulty data sets."""
import pickle
import unittest
import warnings
from fractions import Fraction

import numpy as np

import greatx
import support
from greatx.links import antenna_pose, receivers, rotation, transmitters


class Loading(unittest.TestCase):
    def setUp(self):
        self.ds = greatx.load(support.street())

    def test_arrays_are_what_dataset_json_says(self):
        for name, sensor in self.ds.single().sensors.items():
            for array in sensor.arrays.values():
                value = sensor.record(0)[array.name]
                self.assertEqual(value.dtype, array.dtype, (name, array.name))
                self.assertEqual(len(value.shape), len(array.shape), (name, array.name))
                for found, wanted in zip(value.shape, array.shape):
                    self.assertIn(wanted, (-1, found), (name, array.name))

    def test_the_channel_is_a_memory_map_of_all_records(self):
        csi = self.ds["csi"]
        self.assertIsInstance(csi.cfr, np.memmap)
        self.assertEqual(csi.cfr.shape, (4, 2, 1, 2, 4, 3, 64))
        self.assertEqual(csi.cfr.dtype, np.complex64)
        self.assertIs(csi.cfr, csi["cfr"])
        with self.assertRaises(ValueError):
            csi.cfr[0] = 0

    def test_records_of_paths_are_views(self):
        csi = self.ds["csi"]
        delay = csi["paths/delay"]
        self.assertEqual(len(delay), 4)
        self.assertTrue(all(np.shares_memory(one, delay.values) for one in delay))
        np.testing.assert_array_equal(np.concatenate(list(delay)), delay.values)
        np.testing.assert_array_equal(delay.counts, csi.path_count.sum(axis=(1, 2)))
        np.testing.assert_array_equal(delay[-1], csi.delay[3])
        with self.assertRaises(IndexError):
            delay[4]

    def test_the_paths_of_a_link_are_views_and_all_of_them(self):
        record = self.ds["csi"].record(1)
        self.assertEqual(record.path_count.shape, (2, 2))
        for rx, tx in np.ndindex(2, 2):
            paths = record.paths(rx, tx)
            self.assertEqual(len(paths["delay"]), record.path_count[rx, tx])
            self.assertTrue(np.all(paths["rx"] == rx) and np.all(paths["tx"] == tx))
            self.assertTrue(np.shares_memory(paths["amplitude"], self.ds["csi"]["amplitude"].values))
        with self.assertRaisesRegex(IndexError, "2 receivers"):
            record.paths(rx=2)

    def test_the_response_is_the_sum_of_the_paths(self):
        csi = self.ds["csi"]
        f = (np.arange(csi.subcarriers) + csi.first_subcarrier) * csi.subcarrier_spacing_hz
        t = np.arange(csi.time_samples) * csi.time_spacing_s
        for record in csi:
            for rx, tx in np.ndindex(2, 2):
                p = record.paths(rx, tx)
                h = np.einsum(
                    "prs,pt,pk->rstk",
                    p["amplitude"],
                    np.exp(2j * np.pi * np.outer(p["doppler"], t)),
                    np.exp(-2j * np.pi * np.outer(p["delay"], f)),
                )
                np.testing.assert_allclose(record.cfr[rx, :, tx], h, atol=1e-5 * np.abs(h).max())

    def test_ticks_hold_the_sensors_that_fired(self):
        sequence = self.ds.single()
        self.assertEqual(list(sequence.ticks), [0, 1, 2, 3])
        self.assertEqual(list(self.ds["car/front"].ticks), [0, 2])
        self.assertIn("car/lidar", sequence.at(2))
        self.assertNotIn("car/lidar", sequence.at(1))
        with self.assertRaisesRegex(KeyError, "car/front.*no record at tick 1"):
            sequence.at(1)["car/front"]
        with self.assertRaisesRegex(KeyError, "nothing was recorded at tick 4"):
            self.ds.at(4)
        tick = self.ds.at(3)
        self.assertEqual((tick.time_ns, tick.time_s, tick["csi"].row), (150_000_000, 0.15, 3))
        self.assertEqual(self.ds.tick_rate_hz, Fraction(20))
        np.testing.assert_allclose(self.ds["car/front"].times_s, [0, 0.1])
        self.assertEqual([t.tick for t in sequence], [0, 1, 2, 3])
        self.assertEqual(self.ds["car/front"].record(-1).sample, 1)

    def test_names_metadata_and_ends(self):
        csi = self.ds["csi"]
        self.assertEqual(csi.carrier_hz, 3.5e9)
        self.assertEqual([e["name"] for e in receivers(csi)], ["car/antenna", "walker/antenna"])
        position, turn = antenna_pose(csi.record(2), receivers(csi)[0])
        np.testing.assert_allclose(position, [2.4, -29, 1.6], atol=1e-9)
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
        position, turn = antenna_pose(csi.record(2), transmitters(csi)[0])
        np.testing.assert_allclose(position, [6.3, -21.7, 9.4])
        np.testing.assert_allclose(turn @ [1, 0, 0], [0, 1, 0], atol=1e-12)  # yaw 90 degrees
        with self.assertRaisesRegex(AttributeError, "no_such_thing"):
            csi.no_such_thing
        with self.assertRaisesRegex(KeyError, "it has poses, "):
            self.ds["uav/front"]
        self.assertIn("carrier_hz", dir(csi))
        instances = self.ds["car/front"].record(0).instance
        self.assertLessEqual(instances.max(), len(self.ds.instances))

    def test_several_sequences_must_be_said(self):
        ds = greatx.load(support.space())
        self.assertEqual([s.number for s in ds.sequences], [0, 1])
        with self.assertRaisesRegex(greatx.DatasetError, "2 sequences"):
            ds["csi"]
        self.assertEqual(ds.sequences[1]["csi"].cfr.shape, (3, 1, 1, 1, 1, 1, 8))

    def test_pickled_data_sets_open_the_files_again(self):
        _ = self.ds["csi"].cfr
        text = pickle.dumps(self.ds)
        self.assertLess(len(text), 500)
        np.testing.assert_array_equal(pickle.loads(text)["csi"].cfr, self.ds["csi"].cfr)

    def test_rotation(self):
        half = np.sqrt(0.5)
        np.testing.assert_allclose(rotation([half, 0, 0, half]) @ [1, 0, 0], [0, 1, 0], atol=1e-15)
        self.assertEqual(rotation(np.tile([1.0, 0, 0, 0], (5, 2, 1))).shape, (5, 2, 3, 3))


class TwoTransmitters(unittest.TestCase):
    def setUp(self):
        self.ds = greatx.load(support.two_transmitters())

    def test_links(self):
        csi = self.ds["csi"]
        counts = [[len(csi.record(0).paths(rx, tx)["delay"]) for tx in range(2)] for rx in range(3)]
        self.assertEqual(counts, [[1, 2], [0, 0], [2, 1]])
        np.testing.assert_allclose(
            csi.record(0).paths(tx=1)["delay"], [2e-7, 3e-7, 6e-7]
        )  # a copy, because the paths are not contiguous
        self.assertEqual([e["name"] for e in transmitters(csi)], ["a/antenna", "b/antenna"])

    def test_a_tick_without_paths(self):
        record = self.ds.at(5)["csi"]
        self.assertEqual(record.paths(0, 1)["vertex"].shape, (0, 2, 3))
        self.assertEqual(record.path_count.shape, (3, 2))


class Damage(unittest.TestCase):
    def fails(self, folder, *words, use=lambda ds: None):
        with self.assertRaises(greatx.DatasetError) as caught:
            use(greatx.load(folder))
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_no_data_set(self):
        self.fails("/nonexistent", "/nonexistent", "no dataset.json")

    def test_other_formats_and_versions(self):
        for change, words in (
            (lambda j: j.update(format_version=2), ("format_version is 2", "reads 1")),
            (lambda j: j.update(format="zarr"), ("greatx-dataset", "zarr")),
            (lambda j: j["sensors"][0]["outputs"][0].update(format="hdf5"), ("hdf5", "npy_stack")),
        ):
            folder = support.copy_of(support.space())
            support.edit_json(folder / "dataset.json", change)
            self.fails(folder, "dataset.json", *words)
        (folder / "dataset.json").write_text("{")
        self.fails(folder, "dataset.json", "no JSON")

    def test_incomplete(self):
        folder = support.copy_of(support.space())
        (folder / "manifest.json").unlink()
        (folder / "sequence_0001/index.npy").unlink()
        self.fails(folder, "incomplete", "--resume", "incomplete=True")
        with self.assertWarnsRegex(UserWarning, "1 of 2 sequences are whole"):
            ds = greatx.load(folder, incomplete=True)
        self.assertEqual(len(ds["csi"]), 3)
        (folder / "sequence_0000/index.npy").unlink()
        with self.assertRaisesRegex(greatx.DatasetError, "0 of 2"):
            greatx.load(folder, incomplete=True)

    def test_missing_short_and_misshapen_files(self):
        cfr = "sequence_0000/csi/cfr.npy"

        def use(ds):
            return ds.sequences[0]["csi"].cfr

        folder = support.copy_of(support.space())
        data = (folder / cfr).read_bytes()
        (folder / cfr).write_bytes(data[:-8])
        self.fails(folder, cfr, use=use)
        np.save(folder / cfr, np.zeros((3, 1, 1, 1, 1, 1, 9), np.complex64))
        self.fails(
            folder,
            cfr,
            "expected complex64 [3, 1, 1, 1, 1, 1, 8]",
            "found complex64 [3, 1, 1, 1, 1, 1, 9]",
            use=use,
        )
        (folder / cfr).unlink()
        self.fails(folder, cfr, "cannot be read", use=use)
        np.save(folder / "sequence_0000/csi/paths/delay_offsets.npy", np.array([0, 1, 2, 4]))
        self.fails(
            folder,
            "delay_offsets.npy",
            "from 0 up to 3",
            "from 0 to 4",
            use=lambda ds: ds.sequences[0]["csi"].delay,
        )
        (folder / "sequence_0001/index.npy").unlink()
        self.fails(folder, "sequence_0001/index.npy")

    def test_complete_data_sets_give_no_warning(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            greatx.load(support.space())


if __name__ == "__main__":
    unittest.main()
