# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the exporters of trajectories (TUM, EuRoC) and of event cameras (DSEC), on a rig that is asymmetric
in every axis, against the engine's own boxes and files and against closed forms."""

import csv
import dataclasses
import json
import pathlib
import tempfile
import unittest

import h5py
import numpy as np

import greatx
import support
from greatx.convert.dsec import write_dsec
from greatx.convert.dsec.rig import View, pair
from greatx.convert.dsec.truth import disparity, optical_flow, rectified_picture
from greatx.convert.optics import COEFFICIENTS, Lens, lens_model, lens_of
from greatx.convert.png import encode_png
from greatx.convert.poses import Pose, optical_pose
from greatx.convert.euroc import write_euroc
from greatx.convert.trajectories import write_tum
from greatx.frames import read_png
from greatx.links import rotation


def rows_of(path):
    return [[float(v) for v in row] for row in csv.reader(path.read_text().splitlines()) if row[0][0] != "#"]


def matrix_of(text):
    """Returns the matrix T_BS of a sensor.yaml."""
    data = text[text.index("data: [") + 7 :]
    return np.array([float(v) for v in data[: data.index("]")].split(",")]).reshape(4, 4)


def entries_of(text):
    """Returns what stands behind each key of a flat part of a YAML file, as JSON."""
    pairs = (line.split("#")[0].strip().partition(": ") for line in text.splitlines())
    return {key: json.loads(value) for key, _, value in pairs if value.startswith("[") and value[-1] == "]"}


def blocks_of(text):
    """Returns the entries of each block of cam_to_cam.yaml that is indented by two."""
    blocks = {}
    for line in text.splitlines():
        if line.startswith("  ") and line[2] != " " and line.split("#")[0].strip().endswith(":"):
            name = line.split(":")[0].strip()
        elif line.startswith("    "):
            blocks[name] = {**blocks.get(name, {}), **entries_of(line)}
    return blocks


def wide(k1=-0.3, p1=0.004, width=80, height=60):
    values = {**dict.fromkeys(COEFFICIENTS, 0.0), "k1": k1, "k2": 0.09, "p1": p1, "p2": -0.003}
    return Lens(50.0, 52.0, 38.0, 31.0, width, height, values)


class Exported(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.out = pathlib.Path(holder.name, "out")
        self.ds = greatx.load(support.rig())


class Tum(Exported):
    def test_poses_of_nodes_and_of_a_camera(self):
        counts = write_tum(self.ds, self.out, ["van", "car", "car/front", "car/radar"])
        self.assertEqual((counts["trajectories"], counts["poses"]), (8, 32))
        for sequence in self.ds.sequences:
            folder = self.out / sequence.path.name
            lines = [line.split() for line in (folder / "car.txt").read_text().splitlines()]
            self.assertEqual(lines[1][:3], ["#", "timestamp", "tx"])
            self.assertEqual(
                [l[0] for l in lines[2:]], ["0.000000000", "0.033333333", "0.066666667", "0.100000000"]
            )
            values = np.array(lines[2:], float)
            np.testing.assert_array_equal(values[:, 1:4], sequence.poses.position[:, 1])
            turned = rotation(values[:, [7, 4, 5, 6]])
            np.testing.assert_allclose(turned, rotation(sequence.poses.orientation[:, 1]), atol=1e-14)
            camera = np.loadtxt(folder / "car_front.txt")
            for record in sequence["car/front"]:
                row = camera[list(sequence.ticks).index(record.tick)]
                pose = optical_pose(record)
                np.testing.assert_allclose(row[1:4], pose.position, atol=1e-12)
                np.testing.assert_allclose(rotation(row[[7, 4, 5, 6]]), pose.rotation, atol=1e-12)

    def test_errors(self):
        for frames, word in (
            (["boat"], "no node or mounted sensor 'boat'"),
            (["csi"], "'csi'"),
            (["van", "van"], "another"),
        ):
            with self.assertRaisesRegex(greatx.DatasetError, word):
                write_tum(self.ds, self.out, frames)
        self.assertFalse(self.out.exists())


class Euroc(Exported):
    def test_cameras_look_where_the_engine_sees_the_van(self):
        """Projects the centre of the van's box, which the engine gives in the world, by the files."""
        write_euroc(self.ds, self.out, start_ns=10**15)
        folder = self.out / "sequence_0001/mav0"
        states = rows_of(folder / "state_groundtruth_estimate0/data.csv")
        text = (folder / "cam0/sensor.yaml").read_text()
        body_from_camera, entries = matrix_of(text), entries_of(text)
        fu, fv, cu, cv = entries["intrinsics"]
        k1, k2, p1, p2 = entries["distortion_coefficients"]
        self.assertEqual(entries["resolution"], [62, 48])
        for record in self.ds.sequences[1]["car/front"]:
            state = next(s for s in states if s[0] == 10**15 + record.time_ns)
            world_from_body = Pose(np.array(state[1:4]), rotation(state[4:8])).matrix()
            van = [i for i, name in enumerate(record.box_node) if name == 2][0]
            x, y, z, _ = np.linalg.inv(world_from_body @ body_from_camera) @ [*record.box_center[van], 1]
            self.assertGreater(z, 5)
            x, y = x / z, y / z
            r2 = x * x + y * y
            radial = 1 + k1 * r2 + k2 * r2 * r2
            u = cu + fu * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + 0.5
            v = cv + fv * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + 0.5
            left, top, right, bottom = record.box_amodal[van]
            # A box that the camera looks at from behind is about symmetric to its centre.
            self.assertLess(abs(u - (left + right) / 2), 0.1 * (right - left))
            self.assertLess(abs(v - (top + bottom) / 2), 0.15 * (bottom - top))
            name = f"{10**15 + record.time_ns}.png"
            self.assertIn(f"{10**15 + record.time_ns},{name}\n", (folder / "cam0/data.csv").read_text())
            picture = (folder / "cam0/data" / name).read_bytes()
            self.assertEqual(picture, record.sensor["rgb"].path(record.row).read_bytes())

    def test_the_inertial_sensor_follows_from_the_states(self):
        write_euroc(self.ds, self.out, sequence=0, gravity=9.7)
        folder = self.out / "sequence_0000/mav0"
        states = np.array(rows_of(folder / "state_groundtruth_estimate0/data.csv"))
        imu = np.array(rows_of(folder / "imu0/data.csv"))
        np.testing.assert_array_equal(states[:, 0], imu[:, 0])
        turn = rotation(states[:, 4:8])
        for i in range(3):
            dt = (states[i + 1, 0] - states[i, 0]) * 1e-9
            # Of the rotation between two states, R^T R', the rate of turn in the body's axes.
            between = turn[i].T @ turn[i + 1]
            odd = (between - between.T) / 2
            rate = np.array([odd[2, 1], odd[0, 2], odd[1, 0]]) / dt
            np.testing.assert_allclose(rate, (imu[i, 1:4] + imu[i + 1, 1:4]) / 2, atol=1e-4)
        self.assertGreater(np.linalg.norm(imu[0, 1:4]), 0.3)
        np.testing.assert_allclose(
            np.einsum("nij,nj->ni", turn, imu[:, 4:]),
            self.ds.sequences[0].poses.acceleration[:, 1] + [0, 0, 9.7],
            atol=1e-12,
        )
        np.testing.assert_array_equal(states[:, 8:11], self.ds.sequences[0].poses.velocity[:, 1])
        np.testing.assert_array_equal(states[:, 11:], np.zeros((4, 6)))

    def test_errors(self):
        with self.assertRaisesRegex(greatx.DatasetError, "has no node 'boat'"):
            write_euroc(self.ds, self.out, "boat")
        folder = support.copy_of(support.rig())
        change = lambda j: j["sensors"][1]["metadata"]["distortion"].update(k3=0.01)
        support.edit_json(folder / "dataset.json", change)
        with self.assertRaisesRegex(greatx.DatasetError, "car/front.*expected k3 = 0.*found 0.01"):
            write_euroc(greatx.load(folder), self.out)
        self.assertFalse(self.out.exists())


class WideLenses(Exported):
    """The engine's metadata of a fisheye is put in the place of the camera's distortion."""

    def changed(self, lens):
        def change(j):
            metadata = j["sensors"][1]["metadata"]
            del metadata["distortion"]
            metadata["lens"] = lens

        folder = support.copy_of(support.rig())
        support.edit_json(folder / "dataset.json", change)
        return greatx.load(folder)

    def test_a_fisheye_goes_to_euroc_as_equidistant(self):
        lens = {"model": "fisheye", "k1": -0.02, "k2": 0.003, "k3": -0.0004, "k4": 0.00005}
        dataset = self.changed({**lens, "circle_deg": 190.0})
        write_euroc(dataset, self.out)
        text = (self.out / "sequence_0000/mav0/cam0/sensor.yaml").read_text()
        self.assertIn("distortion_model: equidistant\n", text)
        self.assertEqual(entries_of(text)["distortion_coefficients"], [-0.02, 0.003, -0.0004, 0.00005])
        self.assertEqual(lens_model(dataset.sequences[0]["car/front"]), "fisheye")
        with self.assertRaisesRegex(greatx.DatasetError, "car/front: expected a pinhole camera.*'fisheye'"):
            lens_of(dataset.sequences[0]["car/front"])

    def test_a_panorama_is_refused_by_name(self):
        with self.assertRaisesRegex(greatx.DatasetError, "car/front: expected a pinhole.*'equirectangular'"):
            write_euroc(self.changed({"model": "equirectangular"}), self.out)
        self.assertFalse(self.out.exists())


class Optics(unittest.TestCase):
    def test_undistort_is_the_inverse_of_the_closed_form(self):
        for lens in (
            wide(),
            wide(k1=0.3, p1=-0.01),
            lens_of(greatx.load(support.rig()).sequences[0]["car/front"]),
        ):
            rows, columns = np.mgrid[0 : lens.height, 0 : lens.width]
            shown = lens.normalised(np.stack([columns, rows], -1))
            np.testing.assert_allclose(lens.distort(lens.undistort(shown)), shown, atol=1e-12)
        folded = dataclasses.replace(wide(k1=-2.0), where="camera")
        with self.assertRaisesRegex(greatx.DatasetError, "camera: expected a distortion with an inverse"):
            folded.undistort(np.array([[2.0, 2.0]]))

    def test_png_of_16_bits(self):
        random = np.random.default_rng(3)
        for shape in ((5, 7), (4, 3, 3)):
            for kind in (np.uint8, np.uint16):
                picture = random.integers(0, np.iinfo(kind).max, shape, kind, endpoint=True)
                with tempfile.TemporaryDirectory() as holder:
                    path = pathlib.Path(holder, "a.png")
                    path.write_bytes(encode_png(picture))
                    if shape == (4, 3, 3) and kind == np.uint16:
                        continue  # greatx has no such pictures; tests/peer/exports_data.py reads them
                    np.testing.assert_array_equal(read_png(path), picture)
        with self.assertRaises(ValueError):
            encode_png(np.zeros((2, 2, 2), np.uint8))


class Dsec(Exported):
    RIG = {
        "events_left": "car/dvs",
        "events_right": "car/dvs2",
        "images_left": "car/front",
        "images_right": "car/right",
    }

    def test_events_are_those_of_the_engines_own_file(self):
        counts = write_dsec(self.ds, self.out, events_left="car/dvs", start_us=5_000_000)
        self.assertGreater(counts["events"], 1000)
        for sequence in self.ds.sequences:
            with h5py.File(sequence["car/dvs"]["events"]) as wanted, h5py.File(
                self.out / sequence.path.name / "events/left/events.h5"
            ) as found:
                for name in ("events/p", "events/t", "events/x", "events/y", "ms_to_idx"):
                    self.assertEqual(found[name].dtype, wanted[name].dtype)
                    np.testing.assert_array_equal(found[name], wanted[name])
                self.assertEqual((found["t_offset"][()], wanted["t_offset"][()]), (5_000_000, 0))
                # DSEC's definition of ms_to_idx.
                t, index = found["events/t"][:].astype(int), found["ms_to_idx"][:].astype(int)
                for ms, i in enumerate(index[:-1]):
                    self.assertTrue((i == len(t) or t[i] >= 1000 * ms) and (i == 0 or t[i - 1] < 1000 * ms))
        times = (self.out / "sequence_0000/images/timestamps.txt").read_text().split()
        self.assertEqual(times, ["5000000", "5066666"])

    def test_rectify_map_in_closed_form(self):
        write_dsec(self.ds, self.out, sequence=0, **self.RIG)
        folder = self.out / "sequence_0000"
        text = (folder / "calibration/cam_to_cam.yaml").read_text()
        blocks = blocks_of(text)
        entries = entries_of(text[text.index("extrinsics") :])
        for number, side in ((0, "left"), (3, "right")):
            own = blocks[f"cam{number}"]
            rectified = blocks[f"camRect{number}"]["camera_matrix"]
            k1, k2, p1, p2 = own["distortion_coeffs"]
            with h5py.File(folder / f"events/{side}/rectify_map.h5") as file:
                places = file["rectify_map"][:].astype(float)
            self.assertEqual(places.shape, (48, 62, 2))
            rays = np.concatenate([(places - rectified[2:]) / rectified[:2], np.ones((48, 62, 1))], -1)
            x, y, z = np.moveaxis(rays @ np.array(entries[f"R_rect{number}"]), -1, 0)
            x, y = x / z, y / z
            r2 = x * x + y * y
            radial = 1 + k1 * r2 + k2 * r2 * r2
            fx, fy, cx, cy = own["camera_matrix"]
            u = cx + fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x))
            v = cy + fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)
            columns, rows = np.meshgrid(np.arange(62), np.arange(48))
            np.testing.assert_allclose(u, columns, atol=2e-5)  # the map has 24 bits
            np.testing.assert_allclose(v, rows, atol=2e-5)

    def test_a_point_is_in_one_row_of_both_views_and_has_its_disparity(self):
        views = pair(self.ds.sequences[0], "car/front", "car/right")
        left, right = views
        self.assertAlmostEqual(left.baseline, np.linalg.norm([0.05, -0.4, 0.05]), 12)
        body = np.array([9.0, 1.3, 0.4])  # x forward, y left, z up
        seen = []
        for view in views:
            point = view.body_from_camera.inverse().apply(body)
            pixel = view.lens.pixels(view.lens.distort(point[:2] / point[2]))
            turned = view.rectified_from_camera @ point
            seen.append((view.rectify(pixel), turned[2]))
            np.testing.assert_allclose(view.unrectify(seen[-1][0]), pixel, atol=1e-9)
        (first, depth), (second, other) = seen
        self.assertAlmostEqual(first[1], second[1], 9)
        self.assertAlmostEqual(depth, other, 9)
        self.assertAlmostEqual(first[0] - second[0], left.focal[0] * left.baseline / depth, 9)
        self.assertGreater(first[0], second[0])
        with self.assertRaisesRegex(greatx.DatasetError, "to the right of the first one"):
            pair(self.ds.sequences[0], "car/right", "car/front")

    def test_disparity_and_flow_of_a_plane(self):
        """A plane before a turned camera behind a lens has a disparity in closed form."""
        angle = 0.05
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        view = View("a", wide(), Pose(np.zeros(3), np.eye(3)), turn, (50.0, 52.0), (38.0, 31.0), 0.4)
        depth = np.full((60, 80), 7.0, np.float32)
        found = disparity(view, depth) / 256
        rays = np.concatenate([(view.grid() - view.centre) / view.focal, np.ones((60, 80, 1))], -1)
        wanted = 50.0 * 0.4 / 7.0 * (rays @ turn[:, 2])
        inside = found > 0
        self.assertGreater(inside.mean(), 0.8)
        # The nearest pixel is up to 0.71 pixels away, where the disparity differs by its slope.
        slope = 50.0 * 0.4 / 7.0 * abs(turn[0, 2]) / 50.0
        self.assertLess(np.abs(found - wanted)[inside].max(), 0.75 * slope * 1.6 + 1 / 256)
        depth[:, :40] = np.inf
        self.assertTrue(np.all(disparity(view, depth)[:, :20] == 0))
        plain = dataclasses.replace(
            view,
            lens=dataclasses.replace(view.lens, distortion=dict.fromkeys(COEFFICIENTS, 0.0)),
            rectified_from_camera=np.eye(3),
        )
        self.assertTrue(plain.is_rectified)
        np.testing.assert_array_equal(disparity(plain, depth)[:, 40:], round(256 * 50.0 * 0.4 / 7.0))
        flow = np.zeros((60, 80, 2), np.float32)
        flow[..., 0], flow[..., 1] = 1.5, -2.25
        flow[3, 4] = np.nan
        coded = optical_flow(plain, flow)
        self.assertEqual(coded[3, 4].tolist(), [0, 0, 0])
        self.assertEqual(coded[9, 9].tolist(), [2**15 + 192, 2**15 - 288, 1])
        # Behind the lens, a shift is the difference of the map at both places.
        coded = optical_flow(view, flow).astype(float)
        row, column = 30, 38
        place = view.unrectify(np.array([column, row], float))
        pixel = np.rint(place)
        moved = view.rectify(pixel + [1.5, -2.25]) - view.rectify(pixel)
        np.testing.assert_allclose((coded[row, column, :2] - 2**15) / 128, moved, atol=1 / 256 + 1e-9)

    def test_a_rectified_picture_is_linear_between_pixels(self):
        view = View("a", wide(), Pose(np.zeros(3), np.eye(3)), np.eye(3), (50.0, 52.0), (38.0, 31.0), 0.0)
        grid = view.grid()
        ramp = np.stack([2 * grid[..., 0], 3 * grid[..., 1], grid.sum(-1)], -1)
        found = rectified_picture(view, ramp.astype(np.uint8))
        places = view.unrectify(grid)
        wanted = np.stack([2 * places[..., 0], 3 * places[..., 1], places.sum(-1)], -1)
        inside = np.all((places >= 0) & (places <= [79, 59]), -1)
        self.assertGreater(inside.mean(), 0.5)
        self.assertLessEqual(np.abs(found - wanted)[inside].max(), 0.5 + 1e-9)
        self.assertTrue(np.all(found[~inside] == 0))

    def test_the_whole_folder(self):
        counts = write_dsec(self.ds, self.out, **self.RIG)
        self.assertEqual((counts["pictures"], counts["disparities"], counts["flows"]), (8, 8, 2))
        folder = self.out / "sequence_0001"
        times = (folder / "images/timestamps.txt").read_text()
        self.assertEqual((folder / "disparity/timestamps.txt").read_text(), times)
        self.assertEqual((folder / "flow/forward_timestamps.txt").read_text().splitlines()[1:], ["0, 66666"])
        # The van's back is 5.5 m before the camera or so, and disparity is larger there than of all behind.
        disparities = read_png(folder / "disparity/image/000001.png") / 256
        record = self.ds.sequences[1]["car/front"].record(1)
        van = record.box_visible_pixels.argmax()
        left = pair(self.ds.sequences[1], "car/front", "car/right")[0]
        u0, v0, u1, v1 = record.box_modal[van]
        u, v = np.rint(left.rectify(np.array([(u0 + u1) / 2 - 0.5, (v0 + v1) / 2 - 0.5]))).astype(int)
        distance = left.focal[0] * left.baseline / disparities[v, u]
        depth = record.depth[(v0 + v1) // 2, (u0 + u1) // 2]
        self.assertLess(abs(distance / depth - 1), 0.03)

    def test_errors(self):
        with self.assertRaisesRegex(greatx.DatasetError, "--events-left.*car/dvs, car/dvs2"):
            write_dsec(self.ds, self.out)
        with self.assertRaisesRegex(greatx.DatasetError, "expected a camera, found 'car/lidar'"):
            write_dsec(self.ds, self.out, events_left="car/dvs", images_left="car/lidar")
        with self.assertRaisesRegex(greatx.DatasetError, "found none"):
            write_dsec(greatx.load(support.space()), self.out)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
