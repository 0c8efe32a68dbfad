# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests hostile data sets: every fault raises a greatx.Error that names the file, and nothing hangs."""
import copy
import os
import pathlib
import pickle
import shutil
import signal
import struct
import tempfile
import unittest
import warnings

import numpy as np

import damage
import greatx
import support
from greatx.convert import sionna_paths, write_deepmimo
from greatx.frames import read_exr, read_pcd, read_ply, read_png

#: Number of random damages that are tried here. python/tests/damage.py can make any number.
TRIES = 60


def read_all(folder):
    """Reads all contents of a data set by every function that reads them."""
    ds = greatx.load(folder, incomplete=True)
    ds.materials, ds.instances, ds.semantic_classes
    for sequence in ds.sequences:
        for sensor in sequence.sensors.values():
            for name in [*sensor.arrays, *sensor.info.outputs]:
                opened = sensor[name]
                if not isinstance(opened, os.PathLike):
                    for i in range(len(opened)):
                        opened[i]
            if sensor.kind == "event_camera":
                sensor.events().picture()
            if sensor.kind == "csi":
                for record in sensor:
                    sionna_paths(record)
        for tick in sequence:
            tick.time_s
    for csi in [s for s in ds.sequences[0].sensors.values() if s.kind == "csi"]:
        with tempfile.TemporaryDirectory() as out:
            write_deepmimo(ds, pathlib.Path(out) / "scenario", csi.name, ds.sequences[0].number)


class Hostile(unittest.TestCase):
    def setUp(self):
        signal.alarm(60)  # ends the process if a test hangs

    def tearDown(self):
        signal.alarm(0)

    def fails(self, folder, word, part=""):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with self.assertRaises(greatx.Error) as caught:
                read_all(folder)
        self.assertIn(word, str(caught.exception))
        self.assertIn(part, str(caught.exception))

    def changed(self, change):
        folder = support.copy_of(support.space())
        support.edit_json(folder / "dataset.json", change)
        return folder

    def test_numbers_that_ask_for_for_ever(self):
        def put(*place, value):
            def change(info):
                for key in place[:-1]:
                    info = info[key]
                info[place[-1]] = value

            return change

        for rate in (
            "1e999999999",
            "9223372036854775807",
            "1/0",
            "-1",
            "",
            30,
            None,
            "1/9223372036854775807",
        ):
            self.fails(
                self.changed(put("tick_rate_hz", value=rate)), "dataset.json: tick_rate_hz: expected a"
            )
            if rate != "":  # an empty rate is valid for a sensor
                self.fails(
                    self.changed(put("sensors", 1, "rate_hz", value=rate)),
                    "dataset.json: sensors[1].rate_hz: expected a",
                )
        for count in (2**63 - 1, 10**30, 0, -1, 1.5, "2", True, None):
            self.fails(
                self.changed(put("sequences", value=count)), "dataset.json: sequences: expected an integer"
            )
        self.fails(self.changed(put("sequences", value=10**6)), "sequence_0002/index.npy: is missing")
        self.fails(
            self.changed(put("ticks_per_sequence", value=2)), "index.npy: row ", "expected a tick from 0 to 1"
        )
        self.fails(
            self.changed(put("sensors", 1, "arrays", 0, "shape", value=[2**40, 2**40])),
            "dataset.json: sensors[1].arrays[0].shape",
        )
        for dtype in ("O", "|V999999999", "<f2", 7, None):
            self.fails(
                self.changed(put("sensors", 1, "arrays", 0, "dtype", value=dtype)),
                "sensors[1].arrays[0].dtype: expected",
            )
        for metadata in ({}, {"carrier_hz": "x"}, []):
            self.fails(
                self.changed(put("sensors", 1, "metadata", value=metadata)),
                "dataset.json" if metadata != {"carrier_hz": "x"} else "csi",
            )

    def test_names_stay_inside(self):
        outside = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, outside)
        np.save(outside / "cfr.npy", np.zeros((3, 1, 1, 1, 1, 1, 8), np.complex64))
        for name in (str(outside), "../x", "a/../../x", "", "a//b", "a\nb", "/abs"):

            def change(info, name=name):
                info["sensors"][1]["name"] = name

            self.fails(
                self.changed(change),
                "dataset.json: sensors[1].name: expected a name that can be a folder below",
            )

            def output(info, name=name):
                info["sensors"][1]["outputs"][0]["name"] = name

            self.fails(self.changed(output), "dataset.json: sensors[1].outputs[0].name: expected a name")

    def test_what_is_no_plain_file(self):
        for name in ("sequence_0000/csi/cfr.npy", "sequence_0000/index.npy"):
            folder = support.copy_of(support.space())
            path = folder / name
            path.rename(folder.parent / "moved")
            path.symlink_to(folder.parent / "moved")
            self.fails(folder, str(path), "symbolic link")
            path.unlink()
            os.mkfifo(path)
            self.fails(folder, str(path))
        folder = support.copy_of(support.space())
        (folder / "sequence_0001").rename(folder.parent / "sequence")
        (folder / "sequence_0001").symlink_to(folder.parent / "sequence")
        self.fails(folder, "sequence_0001: expected no symbolic link")

    def test_deep_and_broken_json(self):
        for text in ("[" * 100_000, '{"a":' * 100_000, "{", "", "7", "\xff", '{"format": ' + "9" * 100_000):
            folder = support.copy_of(support.space())
            (folder / "dataset.json").write_text(text, "latin-1")
            self.fails(folder, "dataset.json")

    def test_indices_that_lie(self):
        for row, words in (
            ([2**62, 0, 0, 0, 0], "expected a tick"),
            ([0, 0, 99, 0, 0], "expected a sensor from 0 to 1, found 99"),
            ([0, 0, -1, 0, 0], "expected a sensor"),
            ([0, 0, 0, 0, -1], "expected a row"),
            ([0, 0, 0, 0, 0], "is not in order"),
        ):
            folder = support.copy_of(support.space())
            path = folder / "sequence_0000" / "index.npy"
            index = np.load(path)
            index[2] = row
            np.save(path, index)
            self.fails(folder, "index.npy: row 2", words)

    def test_exr_png_and_clouds_that_end_early_or_lie(self):
        folder = support.copy_of(support.street()) / "sequence_0000" / "car"
        exr, png, ply, pcd = (
            next((folder / part).glob("*"))
            for part in ("front/depth", "front/rgb", "lidar/cloud", "lidar/pcd")
        )
        for path, read in ((exr, read_exr), (png, read_png), (ply, read_ply), (pcd, read_pcd)):
            data = path.read_bytes()
            for size in [*range(0, 400, 7), len(data) // 2, len(data) - 1]:
                path.write_bytes(data[:size])
                with self.assertRaises(greatx.Error) as caught:
                    read(path)
                self.assertIn(str(path), str(caught.exception))
            path.write_bytes(data)
        data = exr.read_bytes()
        # The negative size of the attribute would lead the reader backwards, for ever.
        at = data.index(b"compression\0compression\0") + 24
        exr.write_bytes(data[:at] + struct.pack("<i", -29) + data[at + 4 :])
        with self.assertRaisesRegex(greatx.Error, "an attribute of -29 bytes"):
            read_exr(exr)
        at = data.index(b"dataWindow\0box2i\0") + 21
        exr.write_bytes(data[:at] + struct.pack("<4i", 0, 0, 2**31 - 2, 2**31 - 2) + data[at + 16 :])
        with self.assertRaisesRegex(greatx.Error, "expected a picture of at most"):
            read_exr(exr)
        text = pcd.read_bytes()
        pcd.write_bytes(b"VERSION 0.7\nFIELDS\nSIZE\nTYPE\nCOUNT\nPOINTS 1\nDATA binary\n" + text[-16:])
        with self.assertRaisesRegex(greatx.Error, "one or more FIELDS"):
            read_pcd(pcd)
        ply.write_bytes(ply.read_bytes().replace(b"element vertex ", b"element vertex -"))
        with self.assertRaisesRegex(greatx.Error, "expected a number of points"):
            read_ply(ply)

    def test_random_damage(self):
        folders = [support.street(), support.events(), support.space(), support.two_transmitters()]
        for seed in range(TRIES):
            folder = support.copy_of(folders[seed % len(folders)])
            done = damage.damage(folder, seed)
            with self.subTest(seed=seed, done=done), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    read_all(folder)
                except greatx.Error as error:
                    self.assertIn(str(folder), str(error))


class Copies(unittest.TestCase):
    def test_records_sensors_and_ticks_are_copied_and_pickled(self):
        ds = greatx.load(support.street())
        for record in (ds["csi"].record(1), ds["car/front"].record(0)):
            name = next(iter(record.sensor.arrays))
            for other in (copy.copy(record), copy.deepcopy(record), pickle.loads(pickle.dumps(record))):
                self.assertEqual(
                    (other.tick, other.row, other.sensor.name), (record.tick, record.row, record.sensor.name)
                )
                np.testing.assert_array_equal(other[name], record[name])
        for other in (copy.copy(ds["csi"]), copy.deepcopy(ds["csi"]), pickle.loads(pickle.dumps(ds["csi"]))):
            np.testing.assert_array_equal(other.cfr, ds["csi"].cfr)
            self.assertEqual(other.metadata, ds["csi"].metadata)
            self.assertEqual(other.metadata.where, ds["csi"].metadata.where)

    def test_metadata_that_are_missing_say_where(self):
        csi = greatx.load(support.street())["csi"]
        for kind in (KeyError, greatx.Error):
            with self.assertRaises(kind) as caught:
                csi.metadata["nothing"]
            self.assertIn(
                "dataset.json: csi: metadata.nothing: expected a value, found none", str(caught.exception)
            )
        self.assertNotIn("nothing", csi.metadata)

    def test_the_first_sensor_of_a_kind(self):
        sequence = greatx.load(support.street()).sequences[0]
        self.assertEqual(sequence.first("camera", ["depth"]).name, "car/front")
        with self.assertRaisesRegex(
            greatx.Error, r"kind 'camera' with records of flow, found .*car/front \(camera, 2 records\)"
        ):
            sequence.first("camera", ["flow"])


if __name__ == "__main__":
    unittest.main()
