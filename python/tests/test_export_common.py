# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests what all exporters use: poses, the choice of sensors, clouds without twist, and whole folders."""

import contextlib
import io
import os
import pathlib
import signal
import subprocess
import sys
import types
import unittest
import unittest.mock

import numpy as np

import export_scene
import greatx
import support
from greatx.convert import folders, poses
from greatx.convert.__main__ import main
from greatx.convert.common import Command
from greatx.convert.clouds import cloud, rotations, sweep_s, untwisted
from greatx.convert.png import write_rgb
from greatx.convert.rig import Track, common_ticks, optics, pick_rig, pick_sensor, picture_file, time_ns
from greatx.errors import DatasetError
from greatx.frames import read_png
from greatx.layout import Metadata
from greatx.links import rotation

TOOLS = ("kitti-raw", "kitti-odometry", "kitti-object", "kitti-tracking", "nuscenes", "coco")


def turn(axis: str, degrees: float) -> np.ndarray:
    """Returns the rotation about an axis, counter-clockwise if the axis points to the viewer."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    out = np.eye(3)
    out[i, i] = out[j, j] = c
    out[i, j], out[j, i] = -s, s
    return out


def command(*arguments):
    """Runs python3 -m greatx.convert. Returns its exit code and what it prints as an error."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        try:
            code = main([str(a) for a in arguments])
        except SystemExit as stop:
            code = stop.code
    return code, said.getvalue()


class Poses(unittest.TestCase):
    def test_a_product_leads_from_frame_to_frame(self):
        a = poses.Pose(np.array([1.0, 2.0, 3.0]), turn("z", 90))
        b = poses.Pose(np.array([10.0, 0.0, 0.0]), turn("x", 90))
        point = np.array([0.0, 0.0, 1.0])
        # b turns z to -y and moves it along x; a turns x to y and y to -x, and moves it.
        np.testing.assert_allclose(b.apply(point), [10, -1, 0], atol=1e-12)
        np.testing.assert_allclose((a @ b).apply(point), [2, 12, 3], atol=1e-12)
        np.testing.assert_allclose((a @ b).apply(point), a.apply(b.apply(point)), atol=1e-12)

    def test_an_inverse_and_a_matrix(self):
        pose = poses.Pose(np.array([1.0, -2.0, 3.0]), turn("z", 30) @ turn("y", -50) @ turn("x", 100))
        np.testing.assert_allclose((pose @ pose.inverse()).matrix(), np.eye(4), atol=1e-12)
        points = np.arange(12.0).reshape(4, 3)
        np.testing.assert_allclose(
            np.hstack([points, np.ones((4, 1))]) @ pose.matrix().T,
            np.hstack([pose.apply(points), np.ones((4, 1))]),
            atol=1e-12,
        )

    def test_optical_axes(self):
        for body, optical in (([1, 0, 0], [0, 0, 1]), ([0, 1, 0], [-1, 0, 0]), ([0, 0, 1], [0, -1, 0])):
            np.testing.assert_array_equal(poses.OPTICAL_FROM_BODY @ body, optical)
        self.assertEqual(np.linalg.det(poses.OPTICAL_FROM_BODY), 1.0)

    def test_quaternions_give_back_their_rotation(self):
        rng = np.random.default_rng(3)
        quaternions = rng.normal(size=(200, 4))
        quaternions = [*quaternions, *np.eye(4), [1, 1, 0, 0], [0, 1, -1, 0], [0, 0, 1, 1], [1e-9, 1, 0, 0]]
        for q in quaternions:
            q = np.array(q, float) / np.linalg.norm(q)
            q = -q if q[np.flatnonzero(q)[0]] < 0 else q
            np.testing.assert_allclose(poses.quaternion(rotation(q)), q, atol=1e-12)
        np.testing.assert_allclose(
            poses.quaternion(turn("z", 90)), [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], atol=1e-15
        )

    def test_poses_of_sensors(self):
        sequence = greatx.load(export_scene.scene()).sequences[0]
        record = sequence["level/lidar"].record(0)
        # The node looks 75 degrees from east; its LiDAR is 0.4 m behind, 0.1 m left of and 0.3 m above it.
        c, s = np.cos(np.radians(75)), np.sin(np.radians(75))
        pose = poses.sensor_pose(record)
        np.testing.assert_allclose(
            pose.position, [-2 - 0.4 * c - 0.1 * s, -26 - 0.4 * s + 0.1 * c, 1.9], atol=1e-9
        )
        np.testing.assert_allclose(pose.rotation, turn("z", 75), atol=1e-12)
        optical = poses.optical_pose(sequence["level/left"].record(0))
        np.testing.assert_allclose(optical.rotation[:, 2], [c, s, 0], atol=1e-12)
        np.testing.assert_allclose(optical.rotation[:, 1], [0, 0, -1], atol=1e-12)
        node = poses.node_pose(sequence, "ego", 0)
        np.testing.assert_allclose(node.rotation, turn("z", 82) @ turn("y", 5) @ turn("x", -7), atol=1e-12)
        with self.assertRaisesRegex(DatasetError, "no node 'bus'; nodes are ego, level, car"):
            poses.node_pose(sequence, "bus", 0)

    def test_the_node_of_a_sensor_is_the_longest_name(self):
        self.assertEqual(poses.node_of("a/b/camera", ["a", "a/b", "b"]), "a/b")
        with self.assertRaisesRegex(DatasetError, "is at no node"):
            poses.node_of("csi", ["a", "b"])


class Choice(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dataset = greatx.load(export_scene.scene())
        cls.sequence = cls.dataset.sequences[0]

    def test_a_rig_has_the_sensors_of_its_node(self):
        rig = pick_rig(self.dataset, "ego", True, True)
        self.assertEqual(rig.cameras, ("ego/front", "ego/side"))
        self.assertEqual(rig.lidars, ("ego/lidar", "ego/spin"))
        self.assertEqual(rig.radars, ("ego/radar",))
        with self.assertRaisesRegex(DatasetError, "ego, level have a camera with rgb and a LiDAR.*--node"):
            pick_rig(self.dataset, None, True, True)
        with self.assertRaisesRegex(DatasetError, "no node 'bus'; nodes are"):
            pick_rig(self.dataset, "bus", True, True)
        with self.assertRaisesRegex(DatasetError, "expected the node car with a camera with rgb"):
            pick_rig(self.dataset, "car", True, False)

    def test_a_sensor_is_named_with_or_without_its_node(self):
        rig = pick_rig(self.dataset, "ego", True, True)
        for name in ("front", "ego/front"):
            self.assertEqual(pick_sensor(rig, rig.cameras, name, "camera", "--camera"), "ego/front")
        with self.assertRaisesRegex(DatasetError, "several cameras.*--camera.*ego/front, ego/side"):
            pick_sensor(rig, rig.cameras, None, "camera", "--camera")
        with self.assertRaisesRegex(DatasetError, "expected a camera 'rear'"):
            pick_sensor(rig, rig.cameras, "rear", "camera", "--camera")

    def test_frames_are_common_ticks(self):
        self.assertEqual(common_ticks(self.sequence, ["ego/front", "ego/lidar"]).tolist(), [0, 2, 4])
        self.assertEqual(time_ns(self.sequence, 2), 200_000_000)

    def test_pixels_are_counted_from_the_centre_of_the_first_one(self):
        found = optics(self.sequence["level/left"])
        self.assertAlmostEqual(found.fx, 32.0, delta=1e-9)
        self.assertEqual((found.cx, found.cy, found.width, found.height), (31.5, 23.5, 64, 48))

    def test_pictures_are_files(self):
        path = picture_file(self.sequence["ego/front"].record(3))
        self.assertEqual(path.name, "000003.png")
        self.assertTrue(path.is_file())


class Sweeps(unittest.TestCase):
    def test_rotations_in_closed_form(self):
        vectors = np.radians([[0, 0, 90], [30, 0, 0], [0, -20, 0], [0, 0, 0]])
        wanted = [turn("z", 90), turn("x", 30), turn("y", -20), np.eye(3)]
        np.testing.assert_allclose(rotations(vectors), wanted, atol=1e-12)

    def test_points_return_to_the_tick(self):
        """Twisted points are off the road and the depth picture; untwisted ones lie on both. The carrier
        turns and moves evenly, so the extrapolation is exact."""
        sequence = greatx.load(export_scene.scene()).sequences[0]
        record, camera = sequence["ego/spin"].record(1), sequence["ego/front"].at(2)
        self.assertEqual(sweep_s(record), 0.1)
        classes = np.array(["", *(entry["class"] for entry in sequence.dataset.instances)])
        road = classes[np.array(record["instance"])] == "road"
        optical = poses.optical_pose(camera).inverse() @ poses.sensor_pose(record)
        shares, heights = [], []
        for each in (cloud(record), untwisted(record, Track(sequence))):
            points = each.points[:, :3].astype(float)
            matrix = optics(camera.sensor).matrix()
            shares.append(export_scene.agreement(optical.apply(points), matrix, camera["depth"]))
            heights.append(np.abs(poses.sensor_pose(record).apply(points[road])[:, 2]).max())
        self.assertGreater(heights[0], 0.5)
        self.assertLess(heights[1], 2e-5)
        self.assertGreater(shares[1], 0.95)
        self.assertLess(shares[0], shares[1] - 0.1)

    def test_the_bound_of_the_extrapolation(self):
        """A body moves with a jerk and turns with an angular acceleration; the error is as clouds.py says."""
        jerk, angular = np.array([3.0, -4.0, 0.0]), 0.4  # m/s^3, rad/s^2
        velocity, acceleration, rate = np.array([8.0, 1.0, 0.0]), np.array([1.0, 2.0, 0.0]), 0.3
        rng = np.random.default_rng(5)
        there = rng.uniform(-40, 40, (400, 3))  # in the sensor's frame at the tick
        dt = rng.uniform(0, 0.1, 400)
        moved = velocity * dt[:, None] + acceleration * dt[:, None] ** 2 / 2 + jerk * dt[:, None] ** 3 / 6
        angles = rate * dt + angular * dt**2 / 2
        turned = rotations(np.stack([0 * dt, 0 * dt, angles], -1))
        seen = np.einsum("nji,nj->ni", turned, there - moved)
        record = _Record({"points": np.hstack([seen, seen[:, :1]]), "time_offset": dt})
        track = _Track({"velocity": velocity, "acceleration": acceleration, "angular_velocity": [0, 0, rate]})
        error = np.linalg.norm(untwisted(record, track).points[:, :3] - there, axis=1)
        distance = np.linalg.norm(seen, axis=1)
        bound = np.linalg.norm(jerk) * dt**3 / 6 + distance * angular * dt**2 / 2
        self.assertTrue(np.all(error < bound + 2e-5))  # points are floats
        self.assertGreater(np.max(error), 0.3 * np.max(bound))

    def test_a_sweep_without_times_is_an_error(self):
        record = _Record({"points": np.ones((3, 4))})
        with self.assertRaisesRegex(DatasetError, "expected an array 'time_offset'"):
            untwisted(record, _Track({}))


class _Record:
    """Stands for a record of a LiDAR at the origin of the node a."""

    def __init__(self, arrays):
        self._arrays = arrays
        self.tick = 0
        mount = {"position_m": [0, 0, 0], "orientation_wxyz": [1, 0, 0, 0]}
        metadata = Metadata({"sweep_s": 0.1, "body_from_sensor": mount}, "here")
        dataset = types.SimpleNamespace(path="here")
        sequence = types.SimpleNamespace(dataset=dataset)
        self.sensor = types.SimpleNamespace(
            metadata=metadata, arrays=arrays, name="a/lidar", sequence=sequence
        )

    def __getitem__(self, name):
        return self._arrays[name]


class _Track:
    """Stands for the poses of the node a, which is at the origin."""

    nodes = ["a"]

    def __init__(self, vectors):
        self._vectors = vectors

    def pose(self, node, tick):
        return poses.Pose(np.zeros(3), np.eye(3))

    def vector(self, name, node, tick):
        return np.array(self._vectors[name], float)


class Folders(unittest.TestCase):
    def test_a_folder_is_whole_or_not_there(self):
        out = export_scene.out_folder()
        with self.assertRaisesRegex(RuntimeError, "stop"):
            with folders.new_folder(out) as part:
                (part / "half").write_text("x")
                raise RuntimeError("stop")
        self.assertEqual(list(out.parent.iterdir()), [])
        with folders.new_folder(out) as part:
            (part / "whole").write_text("x")
            self.assertFalse(out.exists())
        self.assertEqual([p.name for p in out.iterdir()], ["whole"])

    def test_nothing_is_overwritten(self):
        out = export_scene.out_folder()
        out.mkdir()
        with folders.new_folder(out) as part:
            (part / "a").write_text("1")
        with self.assertRaisesRegex(FileExistsError, "no empty folder"):
            with folders.new_folder(out):
                pass
        self.assertEqual((out / "a").read_text(), "1")
        other = export_scene.out_folder()
        part = other.with_name("out.part")
        part.mkdir()
        (part / "mine").write_text("1")
        with self.assertRaisesRegex(FileExistsError, "no unfinished export"):
            with folders.new_folder(other):
                pass
        self.assertEqual((part / "mine").read_text(), "1")

    def test_a_killed_conversion_leaves_no_folder_and_the_next_run_cleans_up(self):
        out = export_scene.out_folder()
        script = (
            "import os, signal, sys\n"
            "from greatx.convert import folders\n"
            "with folders.new_folder(sys.argv[1]) as part:\n"
            "    (part / 'half').write_text('x')\n"
            "    os.kill(os.getpid(), int(sys.argv[2]))\n"
        )
        environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(greatx.__file__).parents[1])}

        def run(number):
            command = [sys.executable, "-c", script, str(out), str(int(number))]
            return subprocess.run(command, env=environment, capture_output=True, text=True).returncode

        self.assertEqual(run(signal.SIGKILL), -signal.SIGKILL)
        self.assertFalse(out.exists())
        self.assertTrue(out.with_name("out.part").is_dir())
        self.assertNotEqual(run(signal.SIGTERM), 0)
        self.assertEqual(list(out.parent.iterdir()), [])

    def test_files_are_linked_only_if_wished(self):
        folder = export_scene.out_folder().parent
        (folder / "a").write_bytes(b"1")
        folders.place(folder / "a", folder / "x/b", link=False)
        folders.place(folder / "a", folder / "x/c", link=True)
        self.assertEqual((folder / "x/b").read_bytes(), b"1")
        self.assertFalse(os.path.samefile(folder / "a", folder / "x/b"))
        self.assertTrue(os.path.samefile(folder / "a", folder / "x/c"))

    def test_png_comes_back(self):
        path = export_scene.out_folder()
        pixels = np.random.default_rng(1).integers(0, 256, (7, 5, 3), np.uint8)
        write_rgb(path, pixels)
        np.testing.assert_array_equal(read_png(path), pixels)


class Commands(unittest.TestCase):
    def test_errors_name_what_is_missing_and_write_nothing(self):
        data = export_scene.scene()
        cases = [
            (("kitti-raw", data), "ego, level have a camera with rgb and a LiDAR: say which one .--node"),
            (("kitti-raw", data, "--node", "ego"), "has several cameras: say which one .--camera"),
            (("kitti-odometry", data, "--node", "ego", "--camera", "front"), "several LiDARs.*--lidar"),
            (("kitti-object", data, "--node", "level"), "several cameras"),
            (("kitti-object", data, "--node", "ego", "--camera", "rear", "--lidar", "lidar"), "'rear'"),
            (("kitti-raw", data, "--node", "level", "--camera", "left", "--date", "yesterday"), "YYYY_MM_DD"),
            (("kitti-raw", data, "--node", "level", "--camera", "left", "--right", "left"), "stereo pair"),
            (("kitti-raw", data, "--node", "level", "--camera", "right", "--right", "left"), "-0.5, "),
            (("kitti-object", data, "--node", "level", "--camera", "left", "--type", "car"), "CLASS=NAME"),
            (
                ("kitti-object", data, "--node", "level", "--camera", "right"),
                "expected boxes.*--without-labels",
            ),
            (("nuscenes", data), "ego, level have a camera with rgb, a LiDAR or a radar"),
            (("nuscenes", data, "--node", "level", "--channel", "left=LIDAR_TOP"), "expected CAM_"),
            (
                ("nuscenes", data, "--node", "level", "--channel", "rear=CAM_BACK"),
                "--channel: expected SENSOR",
            ),
            (("nuscenes", data, "--node", "level", "--keyframes", "-1"), "--keyframes"),
            (("nuscenes", data, "--node", "level", "--sequence", "7"), "has no sequence 7; it has 0"),
            (("coco", data, "--camera", "level/right"), "rgb and ids, found level/right without"),
            (("coco", data, "--camera", "ego/rear"), "no camera 'ego/rear'; cameras are ego/front"),
            (("coco", data, "--things", "car"), "no class 'car' of objects"),
            (("kitti-raw", export_scene.plain()), "expected a node with a camera with rgb and a LiDAR"),
            (("kitti-odometry", export_scene.plain(), "--without-lidar", "--camera", "bent"), "distortion"),
            (("kitti-object", export_scene.plain(), "--without-lidar", "--camera", "eye"), "expected boxes"),
            (("nuscenes", export_scene.plain()), "expected boxes.*--without-annotations"),
            (("kitti-raw", support.space()), "expected a node with a camera"),
            (("nuscenes", support.space()), "expected a node with a camera with rgb, a LiDAR or a radar"),
            (("coco", support.space()), "expected a camera with the outputs rgb and ids, found no camera"),
        ]
        for arguments, message in cases:
            out = export_scene.out_folder()
            code, said = command(arguments[0], arguments[1], out, *arguments[2:])
            self.assertEqual(code, 1, (arguments, said))
            self.assertRegex(said, message, arguments)
            self.assertEqual(list(out.parent.iterdir()), [], arguments)

    def test_an_existing_folder_is_refused(self):
        arguments = ["--node", "level"]
        for tool in TOOLS:
            out = export_scene.out_folder()
            out.mkdir()
            (out / "mine").write_text("1")
            more = [] if tool == "coco" else arguments + (["--camera", "left"] if tool != "nuscenes" else [])
            code, said = command(tool, export_scene.scene(), out, *more)
            self.assertEqual(code, 1, tool)
            self.assertIn("nothing is overwritten", said)
            self.assertEqual([p.name for p in out.parent.iterdir()], ["out"])

    def test_an_interrupted_command_says_so(self):
        def stop(dataset, given):
            with folders.new_folder(given.OUT):
                raise KeyboardInterrupt

        out = export_scene.out_folder()
        with unittest.mock.patch("greatx.convert.__main__.COMMANDS", (Command("stop", "", stop),)):
            code, said = command("stop", export_scene.plain(), out)
        self.assertEqual(code, 130)
        self.assertIn("interrupted", said)
        self.assertEqual(list(out.parent.iterdir()), [])

    def test_an_unknown_tool_is_refused(self):
        code, said = command("kity", export_scene.scene(), export_scene.out_folder())
        self.assertEqual(code, 1)
        self.assertIn("kitti-raw", said)

    def test_a_damaged_picture_of_ids_fails_and_leaves_nothing(self):
        folder = support.copy_of(export_scene.plain())
        path = folder / "sequence_0000/pole/eye/instance/000001.png"
        path.write_bytes(path.read_bytes()[:60])
        out = export_scene.out_folder()
        code, said = command("coco", folder, out, "--camera", "pole/eye")
        self.assertEqual(code, 1)
        self.assertIn("000001.png", said)
        self.assertEqual(list(out.parent.iterdir()), [])

    def test_a_damaged_array_is_an_error_that_names_the_data_set(self):
        folder = support.copy_of(export_scene.scene())
        path = folder / "sequence_0000/level/left/boxes/size.npy"
        np.save(path, np.load(path)[:, :2])
        out = export_scene.out_folder()
        code, said = command("kitti-object", folder, out, "--node", "level", "--camera", "left")
        self.assertEqual(code, 1)
        self.assertIn("size.npy", said)
        self.assertEqual(list(out.parent.iterdir()), [])

    def test_the_same_data_set_gives_the_same_bytes(self):
        for tool in ("kitti-tracking", "nuscenes"):
            found = []
            for _ in range(2):
                out = export_scene.out_folder()
                more = ["--camera", "left"] if tool != "nuscenes" else []
                self.assertEqual(command(tool, export_scene.scene(), out, "--node", "level", *more)[0], 0)
                files = sorted(p for p in out.rglob("*") if p.is_file())
                found.append({str(p.relative_to(out)): p.read_bytes() for p in files})
            self.assertEqual(found[0], found[1])


if __name__ == "__main__":
    unittest.main()
