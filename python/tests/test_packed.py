# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests compressed data sets: the same arrays as uncompressed ones, also by h5py, and damaged files."""
import pickle
import random
import signal
import unittest

import numpy as np

import greatx
import support
from test_hostile import read_all

RIG = """
greatx: 1
name: packed
ticks: 6
tick_rate_hz: 20
scene: {generate: {kind: canyon, seed: 9, size_m: 80}, optical_only: true}
environment: {clouds: 0}
nodes:
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2.4, -30, 1.5], rotation_deg: [90, 0, 0]},
                                           {t_s: 1, position_m: [2.4, -20, 1.5], rotation_deg: [95, 0, 0]}]}
    sensors:
      - {name: front, type: camera, rate_hz: 20, width: 62, height: 48, fov_deg: 80}
      - {name: flow, type: camera, rate_hz: 20, width: 62, height: 48, fov_deg: 80, outputs: [flow, depth]}
      - {name: dvs, type: event_camera, rate_hz: 20, width: 62, height: 48, fov_deg: 80, steps: 4,
         outputs: [events, instance]}
      - {name: lidar, type: lidar, rate_hz: 20, channels: 8, elevation_min_deg: -30, elevation_max_deg: 15,
         azimuth_steps: 64, max_range_m: 150, point_step_m: 0.01}
      - {name: sky, type: lidar, rate_hz: 20, channels: 2, elevation_min_deg: 88, elevation_max_deg: 89,
         azimuth_steps: 8, max_range_m: 150}
"""


def plain():
    return support.made("packed_plain", RIG)


def packed(compression="small"):
    return support.made(f"packed_{compression}", RIG, "--compression", compression)


class Packed(unittest.TestCase):
    def test_every_array_is_the_same(self):
        for compression in ("none", "fast", "small"):
            one, other = greatx.load(plain()).single(), greatx.load(packed(compression)).single()
            self.assertEqual(list(one.sensors), list(other.sensors))
            for name, sensor in one.sensors.items():
                self.assertEqual(list(sensor.arrays), list(other[name].arrays))
                for array in sensor.arrays:
                    for i in range(len(sensor)):
                        a, b = np.asarray(sensor[array][i]), np.asarray(other[name][array][i])
                        self.assertEqual((a.dtype, a.shape), (b.dtype, b.shape), (name, array))
                        self.assertEqual(a.tobytes(), b.tobytes(), (compression, name, array, i))
            a, b = one["car/dvs"].events(), other["car/dvs"].events()
            self.assertGreater(len(a), 1000)
            for column in ("t", "x", "y", "p", "instance"):
                np.testing.assert_array_equal(getattr(a, column), getattr(b, column))
            np.testing.assert_array_equal(
                one["car/dvs"].record(2).events().frame(), other["car/dvs"].record(2).events().frame()
            )

    def test_objects(self):
        ds = greatx.load(packed())
        depth, points, t = ds["car/front"].depth, ds["car/lidar"].points, ds["car/dvs"].t
        self.assertIsInstance(depth, greatx.PackedStack)
        self.assertEqual((depth.shape, depth.dtype, depth.ndim), ((6, 48, 62), np.float32, 3))
        np.testing.assert_array_equal(depth[1:4:2], np.stack([depth[1], depth[3]]))
        np.testing.assert_array_equal(np.asarray(depth), np.stack(list(depth)))
        np.testing.assert_array_equal(depth[-1], depth[5])
        self.assertIsInstance(points, greatx.PackedRagged)
        self.assertEqual(points.counts.tolist(), [len(p) for p in points])
        self.assertEqual(t.values.tolist(), np.concatenate(list(t)).tolist())
        self.assertEqual(t.offsets[-1], len(t.values))
        self.assertEqual(len(t.rows(1, 3)), len(t[1]) + len(t[2]))
        self.assertEqual([len(part) for part in t[0:2]], t.counts[:2].tolist())
        self.assertEqual(ds["car/sky"].points[0].shape, (0, 4))
        self.assertEqual(ds["car/sky"].points.values.shape, (0, 4))
        record = ds["car/lidar"].record(2)
        self.assertEqual(set(record["records"]), set(ds["car/lidar"].arrays))
        self.assertEqual(len(record.points), len(record.ring))
        for bad in (6, -7):
            with self.assertRaises(IndexError):
                depth[bad]
        for opened in (depth, points, ds["car/lidar"]["records"]):
            self.assertIn("greatx.Packed", repr(opened))
        again = pickle.loads(pickle.dumps(ds["car/lidar"]))
        np.testing.assert_array_equal(again.points[1], points[1])

    def test_samples(self):
        names = ["car/dvs/t", "car/front/depth", "car/lidar/points"]
        data = greatx.load(packed()).samples(names, pad=True)
        self.assertEqual(len(data), 6)
        longest = greatx.load(packed())["car/lidar"].points.counts.max()
        for item in data:
            self.assertEqual(item["car/lidar/points"].shape, (longest, 4))
            self.assertEqual(item["car/front/depth"].shape, (48, 62))
        item = pickle.loads(pickle.dumps(data))[3]
        self.assertEqual(item["car/dvs/t_count"], greatx.load(packed())["car/dvs"].t.counts[3])

    def test_points_keep_their_bound(self):
        exact = greatx.load(support.made("packed_exact", RIG.replace(", point_step_m: 0.01", "")))
        lidar = greatx.load(packed())["car/lidar"]
        self.assertEqual(lidar.arrays["points"].step, 0.01)
        moved = 0.0
        for a, b in zip(exact["car/lidar"].points, lidar.points):
            away = np.linalg.norm(a[:, :3].astype(float) - b[:, :3], axis=1)
            self.assertLessEqual(away.max(), lidar.metadata["point_error_m"])
            moved = max(moved, away.max())
            np.testing.assert_array_equal(a[:, 3], b[:, 3])
        self.assertGreater(moved, 0.5 * lidar.metadata["point_error_m"])

    def test_h5py_reads_what_the_table_says(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("no h5py (Debian: python3-h5py)")
        folder = packed() / "sequence_0000" / "car"
        ds = greatx.load(packed())
        with h5py.File(folder / "dvs" / "records.h5", "r") as file:
            t = ds["car/dvs"].t
            for i in range(len(t)):
                steps = file[f"t_steps/{i:06d}"]
                self.assertEqual(steps.dtype, np.uint32)
                np.testing.assert_array_equal(file["t_first"][i] + np.cumsum(steps[()], dtype=np.int64), t[i])
                for name in ("x", "y", "p", "instance"):
                    np.testing.assert_array_equal(file[f"{name}/{i:06d}"][()], ds["car/dvs"][name][i])
        with h5py.File(folder / "lidar" / "records.h5", "r") as file:
            for i, points in enumerate(ds["car/lidar"].points):
                for c, name in enumerate(("x", "y", "z", "intensity")):
                    column = file[f"points/{name}/{i:06d}"]
                    self.assertEqual(column.dtype, np.float32 if c == 3 else np.int16)
                    values = column[()].astype(float) * file[f"points/{name}"].attrs.get("step", 1.0)
                    np.testing.assert_array_equal(values.astype(np.float32), points[:, c])
        with h5py.File(folder / "front" / "records.h5", "r") as file:
            self.assertEqual(file["depth"].chunks, (1, 48, 62))
            np.testing.assert_array_equal(file["depth"][()], np.asarray(ds["car/front"].depth))

    def test_data_of_another_length_unpack_to_nothing(self):
        def places(change):
            folder = support.copy_of(packed())
            path = folder / "sequence_0000" / "car" / "dvs" / "records.npy"
            table = np.load(path)
            change(table)
            np.save(path, table)
            return folder

        def put(column, number, value):
            def change(table):
                table[3, column, number] = value

            return change

        for change in (
            put(0, 0, -1),
            put(0, 0, 2**62),
            put(0, 1, 2**62),
            put(0, 1, -5),
            put(0, 1, 0),
            put(0, 2, -1),
            put(0, 2, 2**62),
            put(0, 2, 2**31),
            put(1, 2, 3),
            put(0, 3, 0),
            put(0, 3, 77),
            put(2, 0, 0),
        ):
            with self.assertRaisesRegex(greatx.DatasetError, "car/dvs"):
                read_all(places(change))
        for shape in ((6, 5), (5, 5, 5), (6, 4, 5), (6, 5, 4)):
            folder = support.copy_of(packed())
            np.save(folder / "sequence_0000" / "car" / "dvs" / "records.npy", np.zeros(shape, np.int64))
            with self.assertRaisesRegex(greatx.DatasetError, r"records.npy: expected int64 \[6, 5, 5\]"):
                read_all(folder)
        folder = support.copy_of(packed())
        data = folder / "sequence_0000" / "car" / "lidar" / "records.h5"
        data.write_bytes(data.read_bytes()[:-2000])
        with self.assertRaisesRegex(greatx.DatasetError, "records"):
            read_all(folder)
        data.unlink()
        with self.assertRaisesRegex(greatx.DatasetError, "records.h5"):
            read_all(folder)
        data.symlink_to(packed() / "sequence_0000" / "car" / "lidar" / "records.h5")
        with self.assertRaisesRegex(greatx.DatasetError, "a symbolic link"):
            read_all(folder)

    def test_random_damage_ends_in_an_error_or_in_arrays(self):
        signal.alarm(120)  # ends the process if a damage hangs
        self.addCleanup(signal.alarm, 0)
        refused = 0
        for seed in range(40):
            folder = support.copy_of(packed())
            files = list((folder / "sequence_0000" / "car").glob("*/records.*"))
            rng = random.Random(seed)
            path = rng.choice(files)
            data = bytearray(path.read_bytes())
            for _ in range(rng.choice((1, 20, 400))):
                data[rng.randrange(len(data))] = rng.randrange(256)
            path.write_bytes(data[: rng.choice((len(data), rng.randrange(len(data))))])
            try:
                read_all(folder)
            except greatx.Error as error:
                self.assertIn("car/", str(error))
                refused += 1
        self.assertGreater(refused, 20)


if __name__ == "__main__":
    unittest.main()
