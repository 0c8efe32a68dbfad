# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests what exporters write of inertial sensors and GNSS receivers: EuRoC's folders with the sensor as the
body, TUM RGB-D's folders, against the data set and against closed forms."""

import csv
import pathlib
import tempfile
import unittest

import numpy as np

import greatx
import support
from greatx.convert.euroc import write_euroc
from greatx.convert.inertial import MOST_GAUSS_MARKOV_ALLAN, at_times, pick_imu, read_imu
from greatx.convert.poses import Pose, mount, optical_pose
from greatx.convert.rgbd import encode_depth, write_rgbd
from greatx.frames import read_png
from greatx.links import rotation

# A car in a street whose inertial sensor is turned and off the origin in every axis.
NAVIGATION = """
greatx: 1
name: navigation
seed: 3
ticks: 11
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 9, size_m: 80}, optical_only: true}
environment: {clouds: 0, place: {latitude_deg: 52, longitude_deg: 4.4}, time: 2026-06-21T12:00:00Z}
nodes:
  - name: car
    trajectory: {type: waypoints, interpolation: smooth, points: [{t_s: 0, position_m: [2.4, -30, 0], \
rotation_deg: [90, 0, 0]}, {t_s: 0.5, position_m: [2.6, -24, 0.2], rotation_deg: [97, 2, 1]}, \
{t_s: 1, position_m: [3, -19, 0.1], rotation_deg: [110, -2, 4]}]}
    sensors:
      - {name: front, type: camera, rate_hz: 5, width: 62, height: 48, fov_deg: 80, outputs: [rgb, depth],
         mount: {position_m: [1.5, 0.2, 1.6], rotation_deg: [3, 5, 1]}}
      - {name: imu, type: imu, device: bmi088, rate_hz: 10, samples_per_record: 20, output: mean,
         mount: {position_m: [0.3, -0.1, 0.5], rotation_deg: [4, -3, 2]}, gyroscope: {bias_walk: 1e-4}}
      - {name: gnss, type: gnss, rate_hz: 5, mask_deg: 40, mount: {position_m: [0, 0, 1.7]}}
      - {name: second, type: gnss, rate_hz: 1, mask_deg: 89}
      - {name: air, type: barometer, rate_hz: 10}
      - {name: compass, type: magnetometer, rate_hz: 10}
"""


def rows_of(path):
    return np.array(
        [[float(v) for v in row] for row in csv.reader(path.read_text().splitlines()) if row[0][0] != "#"]
    )


def matrix_of(text):
    data = text[text.index("data: [") + 7 :]
    return np.array([float(v) for v in data[: data.index("]")].split(",")]).reshape(4, 4)


def value_of(text, key):
    return float(next(line for line in text.splitlines() if line.startswith(key + ":")).split(":")[1])


class Navigation(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.out = pathlib.Path(holder.name, "out")
        self.ds = greatx.load(support.made("navigation", NAVIGATION))
        self.sequence = self.ds.sequences[0]

    def test_records_have_the_arrays_of_the_page(self):
        imu = self.sequence["car/imu"]
        self.assertEqual([len(imu["time"][i]) for i in range(3)], [1, 20, 20])
        np.testing.assert_array_equal(imu["time"][1], np.arange(1, 21) * 5_000_000)
        self.assertEqual(imu["specific_force"][1].shape, (20, 3))
        gnss = self.sequence["car/gnss"]
        self.assertEqual(gnss["satellite_state"][:].shape, (6, 24))
        self.assertEqual(gnss.metadata["satellites"][:2], ["A1", "A2"])
        self.assertEqual(self.sequence["car/air"]["pressure"][:].shape, (11, 1))
        field = np.linalg.norm(self.sequence["car/compass"]["field_true"][:], axis=1)
        np.testing.assert_allclose(field, 49.4e-6, atol=0.7e-6)

    def test_euroc_has_the_measured_samples_and_the_sensor_as_body(self):
        counts = write_euroc(self.ds, self.out)
        self.assertEqual((counts["samples"], counts["states"]), (201, 11))
        folder = self.out / "sequence_0000/mav0"
        imu, samples = read_imu(self.sequence, "car/imu"), rows_of(folder / "imu0/data.csv")
        np.testing.assert_array_equal(samples[:, 0], imu.time_ns)
        np.testing.assert_array_equal(samples[:, 1:4], imu.rate)
        np.testing.assert_array_equal(samples[:, 4:], imu.force)
        states = rows_of(folder / "state_groundtruth_estimate0/data.csv")
        body = mount(self.sequence["car/imu"].record(0))
        poses = self.sequence.poses
        for i, state in enumerate(states):
            node = Pose(poses.position[i, 0], rotation(poses.orientation[i, 0]))
            expected = node @ body
            np.testing.assert_allclose(state[1:4], expected.position, atol=1e-13)
            np.testing.assert_allclose(rotation(state[4:8]), expected.rotation, atol=1e-13)
            # A record's last sample has the time of the state.
            np.testing.assert_array_equal(state[11:14], imu.rate_bias[20 * i])
            np.testing.assert_array_equal(state[14:], imu.force_bias[20 * i])
        self.assertGreater(np.abs(states[:, 11:]).max(), 1e-4)
        # From the states, biases and samples: velocity and attitude of the next state.
        g = 9.8124  # at 52 degrees
        scale = 0.02  # the device's errors of scale and misalignment, and its noise
        for i in range(10):
            turn, velocity = rotation(states[i, 4:8]), states[i, 8:11].copy()
            for row, bias in zip(
                samples[20 * i + 1 : 20 * i + 21, 1:], np.repeat(states[i : i + 1, 11:], 20, 0)
            ):
                velocity += 0.005 * (turn @ (row[3:] - bias[3:]) - [0, 0, g])
                angle = 0.005 * (row[:3] - bias[:3])
                cross = np.array(
                    [[0, -angle[2], angle[1]], [angle[2], 0, -angle[0]], [-angle[1], angle[0], 0]]
                )
                turn = turn @ (np.eye(3) + cross + cross @ cross / 2)
            np.testing.assert_allclose(velocity, states[i + 1, 8:11], atol=0.1 * g * 3 * scale)
            np.testing.assert_allclose(turn, rotation(states[i + 1, 4:8]), atol=0.01)
        text = (folder / "imu0/sensor.yaml").read_text()
        self.assertEqual(value_of(text, "rate_hz"), 200.0)
        self.assertAlmostEqual(value_of(text, "gyroscope_noise_density"), np.radians(0.014), places=12)
        drive = np.radians(2 / 3600) / MOST_GAUSS_MARKOV_ALLAN * np.sqrt(2 / 300)
        self.assertAlmostEqual(value_of(text, "gyroscope_random_walk"), np.hypot(1e-4, drive), places=12)
        np.testing.assert_array_equal(matrix_of(text), np.eye(4))
        camera = matrix_of((folder / "cam0/sensor.yaml").read_text())
        front = self.sequence["car/front"]
        state = states[list(poses.index[:, 1]).index(front.record(1).time_ns)]
        world = Pose(state[1:4], rotation(state[4:8])).matrix() @ camera
        np.testing.assert_allclose(world, optical_pose(front.record(1)).matrix(), atol=1e-12)

    def test_euroc_has_the_fixes_of_receivers(self):
        counts = write_euroc(self.ds, self.out)
        folder = self.out / "sequence_0000/mav0"
        gnss = self.sequence["car/gnss"]
        fixed = gnss["fix"][:, 0] > 0
        self.assertEqual(counts["positions"], int(fixed.sum()))
        if fixed.any():
            rows = rows_of(folder / "gnss0/data.csv")
            np.testing.assert_array_equal(rows[:, 1:], gnss["position"][:][fixed])
        self.assertTrue(np.isnan(self.sequence["car/second"]["position"][:]).all())
        self.assertEqual((folder / "gnss1/data.csv").read_text().count("\n"), 1)
        lever = matrix_of((folder / "gnss0/sensor.yaml").read_text())
        body = mount(self.sequence["car/imu"].record(0)).matrix()
        np.testing.assert_allclose((body @ lever)[:3, 3], [0, 0, 1.7], atol=1e-14)

    def test_euroc_without_the_sensor_is_ideal(self):
        write_euroc(self.ds, self.out, imu="none", gravity=9.7)
        states = rows_of(self.out / "sequence_0000/mav0/state_groundtruth_estimate0/data.csv")
        np.testing.assert_array_equal(states[:, 1:4], self.sequence.poses.position[:, 0])
        np.testing.assert_array_equal(states[:, 11:], 0)
        with self.assertRaisesRegex(greatx.DatasetError, "expected an imu 'x'"):
            pick_imu(self.ds, "car", "x")
        self.assertEqual(pick_imu(self.ds, "car", "imu"), "car/imu")

    def test_tum_rgbd_has_pictures_depth_truth_and_accelerometer(self):
        counts = write_rgbd(self.ds, self.out, depth_factor=500.0)
        folder = self.out / "sequence_0000"
        self.assertEqual((counts["pictures"], counts["poses"], counts["samples"]), (6, 11, 201))
        lines = [line.split() for line in (folder / "associations.txt").read_text().splitlines()]
        self.assertEqual([l[0] for l in lines][:2], ["0.000000000", "0.200000000"])
        front = self.sequence["car/front"]
        far = 0
        for record, (time, rgb, again, depth) in zip(front, lines):
            self.assertEqual(time, again)
            self.assertEqual((folder / rgb).read_bytes(), record.sensor["rgb"].path(record.row).read_bytes())
            steps = read_png(folder / depth)
            self.assertEqual(steps.dtype, np.uint16)
            metres = np.asarray(record["depth"], float)
            near = np.isfinite(metres) & (metres * 500 <= 65535.4)
            np.testing.assert_allclose(steps[near] / 500.0, metres[near], atol=0.5001 / 500)
            self.assertEqual(steps[~near].max(initial=0), 0)
            far += int((np.isfinite(metres) & ~near).sum())
        self.assertEqual(counts["depths too far"], far)
        truth = np.loadtxt(folder / "groundtruth.txt")
        for record in front:
            row = truth[list(self.sequence.ticks).index(record.tick)]
            pose = optical_pose(record)
            np.testing.assert_allclose(row[1:4], pose.position, atol=1e-12)
            np.testing.assert_allclose(rotation(row[[7, 4, 5, 6]]), pose.rotation, atol=1e-12)
        accelerometer = np.loadtxt(folder / "accelerometer.txt")
        np.testing.assert_array_equal(accelerometer[:, 1:], read_imu(self.sequence, "car/imu").force)
        for name in ("rgb.txt", "depth.txt"):
            self.assertEqual(sum(not l.startswith("#") for l in (folder / name).read_text().splitlines()), 6)

    def test_depth_is_rounded_and_what_is_too_far_is_none(self):
        steps, far = encode_depth(np.array([[0.0001, 1.00009, 13.107, 13.2, np.inf]]), 5000.0)
        np.testing.assert_array_equal(steps, [[0, 5000, 65535, 0, 0]])
        self.assertEqual(far, 1)
        for factor in (0.0, -1.0, float("nan")):
            with self.assertRaisesRegex(greatx.DatasetError, "depth factor"):
                write_rgbd(self.ds, self.out, depth_factor=factor)
        with self.assertRaisesRegex(greatx.DatasetError, "car/imu"):
            write_rgbd(self.ds, self.out, camera="car/imu")
        self.assertFalse(self.out.exists())

    def test_values_between_samples_are_interpolated(self):
        found = at_times(np.array([0, 10]), np.array([[1.0, 2.0], [3.0, 6.0]]), np.array([-5, 5, 20]))
        np.testing.assert_allclose(found, [[1, 2], [2, 4], [3, 6]])


if __name__ == "__main__":
    unittest.main()
