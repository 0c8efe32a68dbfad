# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the four layouts of KITTI with readers made here from the formats' descriptions, and closed forms."""

import functools
import math
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

import export_scene
import greatx
import support
from greatx.convert import (
    write_kitti_object,
    write_kitti_odometry,
    write_kitti_raw,
    write_kitti_tracking,
)
from greatx.convert.kitti.labels import label, wrapped
from greatx.convert.kitti.oxts import GRAVITY, Places, angles
from greatx.convert.kitti.source import choose
from greatx.convert.objects import Seen
from greatx.convert.poses import OPTICAL_FROM_BODY, Pose, optical_pose, sensor_pose
from greatx.geodesy import LocalFrame
from greatx.links import rotation
from test_export_common import turn

EGO = {"node": "ego", "camera": "front", "lidar": "lidar"}
LEVEL = {"node": "level", "camera": "left", "lidar": "lidar"}


def entries(path):
    """Reads a file of lines NAME: numbers or NAME numbers."""
    out = {}
    for line in path.read_text().splitlines():
        name, *words = line.split()
        try:
            out[name.rstrip(":")] = np.array([float(word) for word in words])
        except ValueError:
            pass  # a date
    return out


def rigid(values):
    """Returns a homogeneous matrix of the entries R and T, or of 12 numbers."""
    out = np.eye(4)
    if isinstance(values, dict):
        out[:3, :3], out[:3, 3] = values["R"].reshape(3, 3), values["T"]
    else:
        out[:3] = values.reshape(3, 4)
    return out


def apply(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def mercator(packets):
    """Returns the poses of packets of oxts, 4 x 4, as KITTI's convertOxtsToPose defines them, less the first
    position."""
    r, out = 6378137.0, []
    scale = math.cos(math.radians(packets[0][0]))
    for p in packets:
        t = np.array(
            [
                scale * r * math.radians(p[1]),
                scale * r * math.log(math.tan(math.pi * (90 + p[0]) / 360)),
                p[2],
            ]
        )
        matrix = np.eye(4)
        matrix[:3, :3] = (
            turn("z", math.degrees(p[5])) @ turn("y", math.degrees(p[4])) @ turn("x", math.degrees(p[3]))
        )
        matrix[:3, 3] = t
        out.append(matrix)
    first = out[0][:3, 3].copy()
    for matrix in out:
        matrix[:3, 3] -= first
    return out


@functools.lru_cache(maxsize=None)
def converted(name, node="ego"):
    """Returns the folder and the counts of a converted data set."""
    write = {
        "raw": write_kitti_raw,
        "odometry": write_kitti_odometry,
        "object": write_kitti_object,
        "tracking": write_kitti_tracking,
    }[name]
    out = export_scene.out_folder()
    return out, write(greatx.load(export_scene.scene()), out, **(EGO if node == "ego" else LEVEL))


class Raw(unittest.TestCase):
    def setUp(self):
        self.out, self.counts = converted("raw")
        self.day = self.out / "2000_01_01"
        self.drive = self.day / "2000_01_01_drive_0000_sync"
        self.sequence = greatx.load(export_scene.scene()).sequences[0]
        self.packets = [
            [float(word) for word in path.read_text().split()]
            for path in sorted((self.drive / "oxts/data").iterdir())
        ]

    def points(self, frame):
        return np.fromfile(self.drive / f"velodyne_points/data/{frame:010d}.bin", "<f4").reshape(-1, 4)

    def test_the_frames_are_the_ticks_of_all_sensors(self):
        self.assertEqual(
            self.counts, {"drives": 1, "frames": 3, "points": self.counts["points"], "tracklets": 1}
        )
        for frame, sample in enumerate((0, 2, 4)):
            picture = self.drive / f"image_02/data/{frame:010d}.png"
            source = self.sequence.path / f"ego/front/rgb/{sample:06d}.png"
            self.assertEqual(picture.read_bytes(), source.read_bytes())
            np.testing.assert_array_equal(
                self.points(frame), self.sequence["ego/lidar"].record(frame)["points"]
            )
        times = (self.drive / "oxts/timestamps.txt").read_text()
        self.assertEqual(times.splitlines()[1], "2000-01-01 00:00:00.200000000")
        for name in ("image_02/timestamps", "velodyne_points/timestamps", "velodyne_points/timestamps_end"):
            self.assertEqual((self.drive / f"{name}.txt").read_text(), times)

    def test_the_projection_of_the_readers_gives_the_true_poses(self):
        found = mercator(self.packets)
        for i, tick in enumerate((0, 2, 4)):
            poses = self.sequence.at(tick)["poses"]
            first = self.sequence.at(0)["poses"]["position"][0]
            np.testing.assert_allclose(found[i][:3, 3], poses["position"][0] - first, atol=1e-8)
            np.testing.assert_allclose(found[i][:3, :3], rotation(poses["orientation"][0]), atol=1e-12)

    def test_velocities_and_rates_have_their_frames(self):
        for i, tick in enumerate((0, 2, 4)):
            p = self.packets[i]
            self.assertEqual(len(p), 30)
            poses = self.sequence.at(tick)["poses"]
            body = rotation(poses["orientation"][0])
            level = turn("z", math.degrees(p[5]))
            velocity, rate = poses["velocity"][0], poses["angular_velocity"][0]
            self.assertEqual((p[6], p[7]), (velocity[1], velocity[0]))
            np.testing.assert_allclose(p[8:11], level.T @ velocity, atol=1e-12)
            force = poses["acceleration"][0] + [0, 0, GRAVITY]
            np.testing.assert_allclose(p[11:14], body.T @ force, atol=1e-12)
            np.testing.assert_allclose(p[14:17], level.T @ force, atol=1e-12)
            np.testing.assert_allclose(p[17:20], body.T @ rate, atol=1e-12)
            np.testing.assert_allclose(p[20:23], level.T @ rate, atol=1e-12)
            # The carrier drives north and looks there: forward and upward velocities are known.
            self.assertGreater(p[8], 9.5)
            self.assertAlmostEqual(p[10], 0.5, delta=1e-9)

    def test_points_fall_on_the_depth_picture(self):
        camera = entries(self.day / "calib_cam_to_cam.txt")
        velo = rigid(entries(self.day / "calib_velo_to_cam.txt"))
        for frame, tick in enumerate((0, 2, 4)):
            points = apply(velo, self.points(frame)[:, :3].astype(float))
            depth = self.sequence["ego/front"].at(tick)["depth"]
            projection = camera["P_rect_02"].reshape(3, 4)
            self.assertGreater(export_scene.agreement(points, projection, depth), 0.95)
            for flip in np.diag([-1.0, 1, 1]), np.diag([1.0, -1, 1]):
                self.assertLess(export_scene.agreement(points @ flip, projection, depth), 0.75)
        np.testing.assert_array_equal(camera["S_rect_02"], [64, 48])

    def test_the_imu_is_the_body(self):
        """Points go from the LiDAR to the world by the calibration and the poses of oxts."""
        velo_from_imu = rigid(entries(self.day / "calib_imu_to_velo.txt"))
        poses = mercator(self.packets)
        first = self.sequence.at(0)["poses"]["position"][0]
        for frame, tick in enumerate((0, 2, 4)):
            points = self.points(frame)[:, :3].astype(float)
            world = apply(poses[frame] @ np.linalg.inv(velo_from_imu), points)
            wanted = sensor_pose(self.sequence["ego/lidar"].record(frame)).apply(points) - first
            np.testing.assert_allclose(world, wanted, atol=1e-8)

    def test_tracklets_hold_the_points_of_their_object(self):
        tracklets = ElementTree.parse(self.drive / "tracklet_labels.xml").getroot().find("tracklets")
        (item,) = tracklets.findall("item")
        self.assertEqual(item.findtext("objectType"), "Car")
        size = np.array([float(item.findtext(name)) for name in "lwh"])
        np.testing.assert_allclose(size, export_scene.CAR_M, atol=1e-3)
        poses = item.find("poses").findall("item")
        self.assertEqual((item.findtext("first_frame"), len(poses)), ("0", 3))
        car = export_scene.car_id(self.sequence.dataset)
        for frame, pose in enumerate(poses):
            t = np.array([float(pose.findtext(name)) for name in ("tx", "ty", "tz")])
            x, y, z = (math.degrees(float(pose.findtext(name))) for name in ("rx", "ry", "rz"))
            matrix = turn("z", z) @ turn("y", y) @ turn("x", x)
            mine = np.array(self.sequence["ego/lidar"].record(frame)["instance"]) == car
            points = self.points(frame)[mine, :3]
            self.assertGreater(len(points), 10)
            centre = t + matrix @ [0, 0, size[2] / 2]
            self.assertLess(export_scene.within(points, centre, matrix, size).max(), 2e-4)
            # Ahead, to the left and above, and its front points away from the carrier.
            self.assertGreater((matrix @ [1, 0, 0]) @ t / np.linalg.norm(t), 0.8)

    def test_absent_cameras_repeat_the_left_one(self):
        camera = entries(self.day / "calib_cam_to_cam.txt")
        for name in ("00", "01", "03"):
            np.testing.assert_array_equal(camera[f"P_rect_{name}"], camera["P_rect_02"])
        self.assertFalse((self.drive / "image_03").exists())


class Oxts(unittest.TestCase):
    def test_angles_in_closed_form(self):
        for roll, pitch, yaw in ((10, -20, 130), (-170, 80, -5), (0, 0, 180)):
            matrix = turn("z", yaw) @ turn("y", pitch) @ turn("x", roll)
            np.testing.assert_allclose(np.degrees(angles(matrix)), (roll, pitch, yaw), atol=1e-10)
        for pitch in (90, -90):
            matrix = turn("z", 25) @ turn("y", pitch) @ turn("x", 0)
            self.assertEqual(angles(matrix)[0], 0.0)
            np.testing.assert_allclose(
                turn("z", math.degrees(angles(matrix)[2])) @ turn("y", pitch), matrix, atol=1e-9
            )

    def test_the_projection_gives_back_positions_everywhere(self):
        """Positions come back within 1e-8 m for 10 km about places at many latitudes."""
        rng = np.random.default_rng(2)
        for latitude in (0, 12, -35, 52, 70, -80):
            frame = LocalFrame(latitude, 170.0, 50.0)
            first = rng.uniform(-1e3, 1e3, 3)
            places = Places(frame, np.zeros(3), first, "mercator")
            positions = np.vstack([first, first + rng.uniform(-1e4, 1e4, (50, 3))])
            packets = [[*places.of(p), 0, 0, 0] for p in positions]
            found = np.array([matrix[:3, 3] for matrix in mercator(packets)])
            np.testing.assert_allclose(found, positions - first, atol=1e-8)
            np.testing.assert_allclose(packets[0][:3], frame.place(first), atol=1e-12)

    def test_the_deviation_from_true_places_has_its_bound(self):
        worst = 0.0
        for latitude in (0.0, 20.0, 49.0, 65.0):
            frame = LocalFrame(latitude, 8.0, 0.0)
            places = Places(frame, np.zeros(3), np.zeros(3), "mercator")
            for azimuth in np.radians(np.arange(0, 360, 15)):
                position = 1000.0 * np.array([math.cos(azimuth), math.sin(azimuth), 0])
                off = np.linalg.norm(frame.local(places.of(position)) - position)
                self.assertLess(off, 0.0068 * 1000 + 1000**2 / (2 * 6378137.0))
                worst = max(worst, off)
        self.assertGreater(worst, 0.0066 * 1000)

    def test_true_places_on_demand(self):
        scenario = export_scene.SCENE.replace("size_m: 80}}", "size_m: 80}, georeference: GEO}").replace(
            "GEO", "{latitude_deg: 52.0116, longitude_deg: 4.3571, height_m: 45}"
        )
        folder = support.made("export_geo", scenario, "--ticks", "2")
        dataset = greatx.load(folder)
        for places, bound in (("mercator", 1e-6), ("geodetic", 1e-12)):
            out = export_scene.out_folder()
            write_kitti_raw(dataset, out, places=places, **EGO)
            path = out / "2000_01_01/2000_01_01_drive_0000_sync/oxts/data/0000000000.txt"
            found = np.array(path.read_text().split()[:3], float)
            np.testing.assert_allclose(found, dataset.at(0)["poses"]["geodetic"][0], atol=bound)
        with self.assertRaisesRegex(greatx.DatasetError, "--origin would contradict"):
            write_kitti_raw(dataset, export_scene.out_folder(), origin=(1.0, 2.0, 3.0), **EGO)


class Odometry(unittest.TestCase):
    def test_poses_are_those_of_the_left_camera(self):
        out, counts = converted("odometry")
        self.assertEqual(counts["frames"], 3)
        calib = entries(out / "sequences/00/calib.txt")
        sequence = greatx.load(export_scene.scene()).sequences[0]
        lines = [np.array(l.split(), float) for l in (out / "poses/00.txt").read_text().splitlines()]
        self.assertEqual([len(line) for line in lines], [12, 12, 12])
        first = optical_pose(sequence["ego/front"].at(0)).inverse()
        for frame, tick in enumerate((0, 2, 4)):
            wanted = (first @ optical_pose(sequence["ego/front"].at(tick))).matrix()
            np.testing.assert_allclose(rigid(lines[frame]), wanted, atol=1e-11)
            # Scans of all frames lie on one world: the road's points have one height.
            points = np.fromfile(out / f"sequences/00/velodyne/{frame:06d}.bin", "<f4").reshape(-1, 4)
            camera = apply(rigid(lines[frame]) @ rigid(calib["Tr"]), points[:, :3].astype(float))
            world = first.inverse().apply(camera)
            np.testing.assert_allclose(
                world, sensor_pose(sequence["ego/lidar"].record(frame)).apply(points[:, :3]), atol=1e-8
            )
        times = np.array((out / "sequences/00/times.txt").read_text().split(), float)
        np.testing.assert_allclose(times, [0, 0.2, 0.4], atol=1e-12)

    def test_a_stereo_pair_has_its_baseline(self):
        """The right camera sees the disparity that P3 says: points project to the same row, and to a column
        that is smaller by fx b / z."""
        out = export_scene.out_folder()
        write_kitti_odometry(greatx.load(export_scene.scene()), out, right="right", **LEVEL)
        calib = entries(out / "sequences/00/calib.txt")
        p2, p3 = calib["P2"].reshape(3, 4), calib["P3"].reshape(3, 4)
        np.testing.assert_allclose(p3[:, 3], [-32.0 * 0.5, 0, 0], atol=1e-9)
        np.testing.assert_array_equal(p2[:, :3], p3[:, :3])
        np.testing.assert_array_equal(calib["P1"], calib["P3"])
        self.assertEqual(len(list((out / "sequences/00/image_3").iterdir())), 5)

    def test_without_a_lidar_the_frame_is_the_body(self):
        out = export_scene.out_folder()
        counts = write_kitti_odometry(
            greatx.load(export_scene.plain()), out, camera="eye", without_lidar=True
        )
        self.assertEqual((counts["sequences"], counts["frames"], counts["points"]), (2, 4, 0))
        self.assertEqual(sorted(p.name for p in (out / "poses").iterdir()), ["00.txt", "01.txt"])
        self.assertFalse((out / "sequences/00/velodyne").exists())
        tr = rigid(entries(out / "sequences/00/calib.txt")["Tr"])
        np.testing.assert_allclose(tr[:3, :3], OPTICAL_FROM_BODY, atol=1e-12)


class Object(unittest.TestCase):
    def boxes(self, folder, frame):
        """Returns the only label of a frame: its words, size l, w, h, centre and axes in camera 0."""
        (line,) = (folder / f"label_2/{frame:06d}.txt").read_text().splitlines()
        words = line.split()
        self.assertEqual(len(words), 15)
        h, w, l, x, y, z, ry = (float(word) for word in words[8:])
        # The box's x, y, z axes: at ry = 0 along the camera's x, z and -y.
        axes = turn("y", math.degrees(ry)) @ np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
        return words, np.array([l, w, h]), np.array([x, y - h / 2, z]), axes

    def test_a_level_camera_loses_nothing(self):
        out, counts = converted("object", "level")
        folder = out / "training"
        self.assertEqual((counts["frames"], counts["labels"]), (5, 5))
        self.assertLess(counts["degrees of tilt lost at most"], 0.01)
        sequence = greatx.load(export_scene.scene()).sequences[0]
        car = export_scene.car_id(sequence.dataset)
        for frame in range(5):
            calib = entries(folder / f"calib/{frame:06d}.txt")
            np.testing.assert_array_equal(calib["R0_rect"], np.eye(3).reshape(-1))
            words, size, centre, axes = self.boxes(folder, frame)
            self.assertEqual(words[0], "Car")
            np.testing.assert_allclose(size, export_scene.CAR_M, atol=1e-3)
            record = sequence["level/lidar"].at(frame)
            points = np.fromfile(folder / f"velodyne/{frame:06d}.bin", "<f4").reshape(-1, 4)
            camera = apply(rigid(calib["Tr_velo_to_cam"]), points[:, :3].astype(float))
            mine = camera[np.array(record["instance"]) == car]
            self.assertGreater(len(mine), 5)
            self.assertLess(export_scene.within(mine, centre, axes, size).max(), 1e-3)
            depth = sequence["level/left"].at(frame)["depth"]
            self.assertGreater(export_scene.agreement(camera, calib["P2"].reshape(3, 4), depth), 0.95)
            # The corners of the box project to the rectangle, which the box of the mesh fills to 2.5 pixels.
            signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
            corners = (signs * size / 2) @ axes.T + centre
            uv = np.hstack([corners, np.ones((8, 1))]) @ calib["P2"].reshape(3, 4).T
            uv = uv[:, :2] / uv[:, 2:]
            rectangle = np.array(words[4:8], float)
            np.testing.assert_allclose(rectangle, [*uv.min(axis=0), *uv.max(axis=0)], atol=2.5)
            # Pixels of the car lie in the rectangle.
            rows, columns = np.nonzero(sequence["level/left"].at(frame)["instance"] == car)
            self.assertTrue(rectangle[0] - 0.51 <= columns.min() and columns.max() <= rectangle[2] + 0.51)
            self.assertTrue(rectangle[1] - 0.51 <= rows.min() and rows.max() <= rectangle[3] + 0.51)
            alpha = float(words[14]) - math.atan2(float(words[11]), float(words[13]))
            self.assertAlmostEqual(float(words[3]), alpha, delta=2e-6)
        frames = (out / "frames.csv").read_text().splitlines()
        self.assertEqual(frames[3], "000002,0,2,200000000")

    def test_a_tilted_camera_loses_the_tilt_alone(self):
        out, counts = converted("object")
        sequence = greatx.load(export_scene.scene()).sequences[0]
        worst = 0.0
        for frame, tick in enumerate((0, 2, 4)):
            record = sequence["ego/front"].at(tick)
            index = list(record["box_instance"]).index(export_scene.car_id(sequence.dataset))
            wanted = OPTICAL_FROM_BODY @ record["box_sensor_center"][index]
            true = OPTICAL_FROM_BODY @ rotation(record["box_sensor_orientation"][index])
            _, size, centre, axes = self.boxes(out / "training", frame)
            np.testing.assert_allclose(centre, wanted, atol=2e-6)
            tilt = math.degrees(math.acos(-true[1, 2]))
            worst = max(worst, tilt)
            # The heading is that of the true box, seen along the camera's y axis.
            heading = true[[0, 2], 0] / np.hypot(*true[[0, 2], 0])
            np.testing.assert_allclose(axes[[0, 2], 0], heading, atol=1e-5)
            lost = true @ axes.T
            turned = math.acos(min(1.0, (np.trace(lost) - 1) / 2))
            half = np.linalg.norm(size) / 2
            signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T * size / 2
            off = np.linalg.norm(signs @ (true - axes).T, axis=1).max()
            self.assertLessEqual(off, half * 2 * math.sin(turned / 2) + 1e-9)
        self.assertAlmostEqual(counts["degrees of tilt lost at most"], worst, delta=1e-2)
        self.assertGreater(worst, 5.0)

    def test_rotation_y_and_alpha_in_closed_form(self):
        """Objects that look ahead, to the right, at the camera and to the left, at a place to its right."""
        calibration = choose(greatx.load(export_scene.scene()), **LEVEL).calibration
        for yaw, rotation_y in ((0, -math.pi / 2), (-90, 0.0), (180, math.pi / 2), (90, math.pi)):
            seen = Seen(
                7, 1, "vehicle", -1, Pose(np.zeros(3), np.eye(3)),
                Pose(np.array([10.0, -10.0, 1.0]), turn("z", yaw)), np.array([4.0, 2.0, 1.5]),
                np.array([1.0, 2.0, 90.0, 40.0]), np.array([1, 2, 9, 9]), 5, 0.7, 0.25,
            )  # fmt: skip
            found = label(seen, "Car", calibration)
            self.assertAlmostEqual(math.remainder(found.rotation_y - rotation_y, 2 * math.pi), 0, delta=1e-9)
            self.assertAlmostEqual(
                math.remainder(found.alpha - (rotation_y - math.pi / 4), 2 * math.pi), 0, delta=1e-9
            )
            np.testing.assert_allclose(found.bottom, [10, -1 + 0.75, 10], atol=1e-12)
            np.testing.assert_array_equal(found.size, [1.5, 2, 4])
            np.testing.assert_array_equal(found.rectangle, [0.5, 1.5, 63, 39.5])
            self.assertEqual((found.occlusion, found.truncation), (1, 0.25))
        self.assertAlmostEqual(wrapped(3 * math.pi / 2), -math.pi / 2)

    def test_types_can_be_chosen(self):
        dataset = greatx.load(export_scene.scene())
        out = export_scene.out_folder()
        write_kitti_object(dataset, out, types=["vehicle=Van"], **LEVEL)
        self.assertTrue((out / "training/label_2/000000.txt").read_text().startswith("Van "))
        out = export_scene.out_folder()
        write_kitti_raw(dataset, out, types=["vehicle=Van"], date="2011_09_26", **LEVEL)
        drive = out / "2011_09_26/2011_09_26_drive_0000_sync"
        self.assertIn("<objectType>Van</objectType>", (drive / "tracklet_labels.xml").read_text())
        out = export_scene.out_folder()
        counts = write_kitti_object(dataset, out, types=["vehicle="], **LEVEL)
        self.assertEqual(counts["labels"], 0)
        out = export_scene.out_folder()
        write_kitti_object(dataset, out, without_labels=True, node="level", camera="right")
        self.assertFalse((out / "training/label_2").exists())

    def test_frames_of_all_sequences_follow_one_another(self):
        plain = {"camera": "eye", "without_lidar": True, "without_labels": True}
        for sequence, wanted in ((None, ["0,0", "0,1", "1,0", "1,1"]), (1, ["1,0", "1,1"])):
            out = export_scene.out_folder()
            write_kitti_object(greatx.load(export_scene.plain()), out, sequence=sequence, **plain)
            lines = (out / "frames.csv").read_text().splitlines()[1:]
            self.assertEqual(
                [line.rpartition(",")[0] for line in lines], [f"{i:06d},{w}" for i, w in enumerate(wanted)]
            )
            self.assertEqual(len(list((out / "training/image_2").iterdir())), len(wanted))


class Tracking(unittest.TestCase):
    def test_labels_have_a_frame_and_a_track(self):
        out, counts = converted("tracking", "level")
        folder = out / "training"
        self.assertEqual((counts["sequences"], counts["frames"], counts["labels"]), (1, 5, 5))
        lines = [line.split() for line in (folder / "label_02/0000.txt").read_text().splitlines()]
        car = export_scene.car_id(greatx.load(export_scene.scene()))
        for frame, words in enumerate(lines):
            self.assertEqual((len(words), words[0], words[1], words[2]), (17, str(frame), str(car), "Car"))
            objects = (
                (converted("object", "level")[0] / f"training/label_2/{frame:06d}.txt").read_text().split()
            )
            self.assertEqual(words[4:], objects[2:])
        calib = entries(folder / "calib/0000.txt")
        object_ = entries(converted("object", "level")[0] / "training/calib/000000.txt")
        for mine, other in (
            ("R_rect", "R0_rect"),
            ("Tr_velo_cam", "Tr_velo_to_cam"),
            ("Tr_imu_velo", "Tr_imu_to_velo"),
        ):
            np.testing.assert_array_equal(calib[mine], object_[other])
        self.assertEqual(len((folder / "oxts/0000.txt").read_text().splitlines()), 5)
        self.assertTrue((folder / "image_02/0000/000004.png").is_file())
        self.assertTrue((folder / "velodyne/0000/000004.bin").is_file())

    def test_a_compressed_data_set_gives_the_same_files(self):
        out = export_scene.out_folder()
        write_kitti_tracking(greatx.load(export_scene.scene("fast")), out, **LEVEL)
        wanted = converted("tracking", "level")[0]
        files = sorted(p.relative_to(out) for p in out.rglob("*") if p.is_file())
        self.assertEqual(files, sorted(p.relative_to(wanted) for p in wanted.rglob("*") if p.is_file()))
        for name in files:
            if name.suffix != ".png":
                self.assertEqual((out / name).read_bytes(), (wanted / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()
