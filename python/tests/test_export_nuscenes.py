# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the export to nuScenes with readers made here from the format's description."""

import functools
import json
import math
import unittest

import numpy as np

import export_scene
import greatx
from greatx.convert import write_nuscenes
from greatx.convert.nuscenes.categories import CATEGORIES, attributes, visibility_token
from greatx.convert.nuscenes.channels import assign, azimuth_deg
from greatx.convert.nuscenes.points import RADAR_FIELDS, Detections, radar_bytes
from greatx.convert.nuscenes.write import EPOCH_US
from greatx.convert.objects import Inventory
from greatx.convert.poses import mount
from greatx.convert.rig import Track, pick_rig
from greatx.frames import read_pcd
from greatx.links import rotation


class Tables:
    """Reads the tables and follows tokens."""

    def __init__(self, folder):
        self.folder = folder
        self.rows = {path.stem: json.loads(path.read_text()) for path in (folder / "v1.0-mini").iterdir()}
        self.splits = self.rows.pop("splits")
        self._by_token = {name: {row["token"]: row for row in rows} for name, rows in self.rows.items()}

    def get(self, table, token):
        return self._by_token[table][token]

    def channel(self, data):
        calibrated = self.get("calibrated_sensor", data["calibrated_sensor_token"])
        return self.get("sensor", calibrated["sensor_token"])["channel"]

    def keyframe(self, sample, channel):
        """Returns the row of sample_data of a channel at a sample."""
        (row,) = [
            row
            for row in self.rows["sample_data"]
            if row["sample_token"] == sample["token"] and row["is_key_frame"] and self.channel(row) == channel
        ]
        return row

    def global_from_sensor(self, data):
        """Returns the translation and the rotation from a sensor's frame to the global one."""
        calibrated = self.get("calibrated_sensor", data["calibrated_sensor_token"])
        ego = self.get("ego_pose", data["ego_pose_token"])
        r = rotation(ego["rotation"])
        return (
            r @ calibrated["translation"] + ego["translation"],
            r @ rotation(calibrated["rotation"]),
        )

    def intrinsic(self, data):
        return np.array(self.get("calibrated_sensor", data["calibrated_sensor_token"])["camera_intrinsic"])

    def lidar(self, data):
        return np.fromfile(self.folder / data["filename"], "<f4").reshape(-1, 5)


@functools.lru_cache(maxsize=None)
def converted(**arguments):
    out = export_scene.out_folder()
    counts = write_nuscenes(greatx.load(export_scene.scene()), out, **arguments)
    return Tables(out), counts


def ego():
    """Returns the tables of the carrier with every common tick as a keyframe."""
    return converted(node="ego", keyframes_hz=0.0)


class Structure(unittest.TestCase):
    def test_tables_have_their_fields_and_tokens(self):
        tables, counts = ego()
        self.assertEqual(counts, {"scenes": 1, "samples": 3, "files": 21, "annotations": 3})
        fields = {
            "category": "token name description index",
            "attribute": "token name description",
            "visibility": "token level description",
            "instance": "token category_token nbr_annotations first_annotation_token last_annotation_token",
            "sensor": "token channel modality",
            "calibrated_sensor": "token sensor_token translation rotation camera_intrinsic",
            "ego_pose": "token timestamp rotation translation",
            "log": "token logfile vehicle date_captured location",
            "scene": "token log_token nbr_samples first_sample_token last_sample_token name description",
            "sample": "token timestamp scene_token prev next",
            "sample_data": "token sample_token ego_pose_token calibrated_sensor_token timestamp fileformat "
            "is_key_frame height width filename prev next",
            "sample_annotation": "token sample_token instance_token visibility_token attribute_tokens "
            "translation size rotation prev next num_lidar_pts num_radar_pts",
            "map": "token category filename log_tokens",
            "lidarseg": "token sample_data_token filename",
        }
        self.assertEqual(set(tables.rows), set(fields))
        for name, wanted in fields.items():
            self.assertTrue(tables.rows[name], name)
            tokens = [row["token"] for row in tables.rows[name]]
            self.assertEqual(len(tokens), len(set(tokens)), name)
            for row in tables.rows[name]:
                self.assertLessEqual(set(wanted.split()), set(row), name)
                for key, value in row.items():
                    if key.endswith("_token") and not key.startswith(("first_", "last_")):
                        tables.get(key[: -len("_token")], value)
        self.assertEqual([row["name"] for row in tables.rows["category"]], list(CATEGORIES))
        for row in tables.rows["map"]:
            self.assertTrue((tables.folder / row["filename"]).is_file())

    def test_chains_are_in_order_of_time(self):
        tables, _ = ego()
        scene = tables.rows["scene"][0]
        token, times = scene["first_sample_token"], []
        while token:
            row = tables.get("sample", token)
            times.append(row["timestamp"] - EPOCH_US)
            self.assertTrue(row["next"] or token == scene["last_sample_token"])
            token = row["next"]
        self.assertEqual(times, [0, 200000, 400000])
        for row in tables.rows["sample_data"]:
            self.assertTrue((tables.folder / row["filename"]).is_file())
            if row["next"]:
                after = tables.get("sample_data", row["next"])
                self.assertEqual(after["prev"], row["token"])
                self.assertGreater(after["timestamp"], row["timestamp"])
                self.assertEqual(tables.channel(after), tables.channel(row))
            # A sweep belongs to the keyframe that follows it.
            sample = tables.get("sample", row["sample_token"])
            self.assertGreaterEqual(sample["timestamp"], row["timestamp"])
            self.assertEqual(row["is_key_frame"], sample["timestamp"] == row["timestamp"])
            self.assertTrue(row["filename"].startswith("samples/" if row["is_key_frame"] else "sweeps/"))

    def test_scenes_have_names_and_a_split(self):
        self.assertEqual(ego()[0].splits, {"all": ["scene-0000"]})
        tables, _ = converted(node="level", scene_names=("scene-0103",))
        self.assertEqual(tables.rows["scene"][0]["name"], "scene-0103")
        self.assertEqual(tables.splits, {"all": ["scene-0103"]})
        with self.assertRaisesRegex(greatx.DatasetError, "expected 1 different names.*found a, b"):
            converted(node="level", scene_names=("a", "b"))

    def test_keyframes_have_a_rate(self):
        _, counts = converted(node="ego")  # 2 Hz, 0.4 s
        self.assertEqual((counts["samples"], counts["files"]), (1, 21))
        _, counts = converted(node="level", keyframes_hz=5.0)
        self.assertEqual(counts["samples"], 3)

    def test_channels_follow_the_direction(self):
        tables, _ = ego()
        self.assertEqual(
            sorted(row["channel"] for row in tables.rows["sensor"]),
            ["CAM_FRONT", "CAM_FRONT_LEFT", "LIDAR_SPIN", "LIDAR_TOP", "RADAR_FRONT"],
        )
        dataset = greatx.load(export_scene.scene())
        sequence = dataset.sequences[0]
        rig = pick_rig(dataset, "level", True, True)
        # Both look ahead: the first is CAM_FRONT, the other gets its own name.
        self.assertEqual(
            assign(sequence, rig),
            {"level/left": "CAM_FRONT", "level/right": "CAM_RIGHT", "level/lidar": "LIDAR_TOP"},
        )
        given = assign(sequence, rig, ["level/right=CAM_FRONT", "left=CAM_BACK"])
        self.assertEqual((given["level/right"], given["level/left"]), ("CAM_FRONT", "CAM_BACK"))
        self.assertEqual(azimuth_deg(np.array([0.0, 2.0, -1.0])), 90.0)
        self.assertIsNone(azimuth_deg(np.array([0.1, 0.1, -1.0])))


class Geometry(unittest.TestCase):
    def setUp(self):
        self.tables, _ = ego()
        self.sequence = greatx.load(export_scene.scene()).sequences[0]
        self.car = export_scene.car_id(self.sequence.dataset)
        self.origin = np.array(self.tables.rows["log"][0]["greatx_origin_m"])

    def test_lidar_points_are_in_the_world_and_on_the_depth_picture(self):
        for sample, tick in zip(self.tables.rows["sample"], (0, 2, 4)):
            data = self.tables.keyframe(sample, "LIDAR_TOP")
            points = self.tables.lidar(data)
            record = self.sequence["ego/lidar"].at(tick)
            np.testing.assert_array_equal(points[:, 4], record["ring"])
            np.testing.assert_array_equal(points[:, 3], record["points"][:, 3] * np.float32(255))
            # x to the right, y forward.
            np.testing.assert_array_equal(points[:, 1], record["points"][:, 0])
            np.testing.assert_array_equal(points[:, 0], -record["points"][:, 1])
            at, turned = self.tables.global_from_sensor(data)
            world = points[:, :3].astype(float) @ turned.T + at
            classes = np.array(["", *(entry["class"] for entry in self.sequence.dataset.instances)])
            road = classes[np.array(record["instance"])] == "road"
            self.assertGreater(road.sum(), 100)
            np.testing.assert_allclose(world[road, 2], 0, atol=2e-5)
            for channel, camera in (("CAM_FRONT", "front"), ("CAM_FRONT_LEFT", "side")):
                picture = self.tables.keyframe(sample, channel)
                at, turned = self.tables.global_from_sensor(picture)
                optical = (world - at) @ turned
                depth = self.sequence[f"ego/{camera}"].at(tick)["depth"]
                share = export_scene.agreement(optical, self.tables.intrinsic(picture), depth)
                self.assertGreater(share, 0.95)

    def test_boxes_hold_the_points_of_their_object(self):
        for row, tick in zip(self.tables.rows["sample_annotation"], (0, 2, 4)):
            data = self.tables.keyframe(self.tables.get("sample", row["sample_token"]), "LIDAR_TOP")
            at, turned = self.tables.global_from_sensor(data)
            world = self.tables.lidar(data)[:, :3].astype(float) @ turned.T + at
            mine = np.array(self.sequence["ego/lidar"].at(tick)["instance"]) == self.car
            width, length, height = row["size"]
            np.testing.assert_allclose([length, width, height], export_scene.CAR_M, atol=1e-3)
            off = export_scene.within(
                world, np.array(row["translation"]), rotation(row["rotation"]), [length, width, height]
            )
            self.assertGreater(mine.sum(), 10)
            self.assertLess(off[mine].max(), 2e-4)
            self.assertEqual(row["num_lidar_pts"], int((off <= 1e-3).sum()))
            self.assertGreaterEqual(row["num_lidar_pts"], mine.sum())
            poses = self.sequence.at(tick)["poses"]
            np.testing.assert_allclose(
                np.array(row["translation"])[:2] + self.origin[:2], poses["position"][2, :2], atol=0.02
            )
            self.assertEqual(row["visibility_token"], "4")
            (attribute,) = row["attribute_tokens"]
            self.assertEqual(self.tables.get("attribute", attribute)["name"], "vehicle.moving")

    def test_velocities_are_differences_of_positions(self):
        rows = self.tables.rows["sample_annotation"]
        step = np.array(rows[2]["translation"]) - rows[0]["translation"]
        velocity = self.sequence.at(2)["poses"]["velocity"][2]
        np.testing.assert_allclose(step / 0.4, velocity, atol=1e-9)

    def test_points_have_the_class_of_their_instance(self):
        data = self.tables.keyframe(self.tables.rows["sample"][1], "LIDAR_TOP")
        row = self.tables.get("lidarseg", data["token"])
        labels = np.fromfile(self.tables.folder / row["filename"], np.uint8)
        instance = np.array(self.sequence["ego/lidar"].at(2)["instance"])
        self.assertEqual(len(labels), len(instance))
        np.testing.assert_array_equal(labels == CATEGORIES.index("vehicle.car"), instance == self.car)
        classes = np.array(["", *(entry["class"] for entry in self.sequence.dataset.instances)])
        np.testing.assert_array_equal(
            labels == CATEGORIES.index("flat.driveable_surface"), classes[instance] == "road"
        )
        self.assertEqual(len(self.tables.rows["lidarseg"]), 3)

    def test_objects_are_known_where_no_camera_sees_them(self):
        """A box that a camera had at one tick is carried to all ticks by the pose of its node."""
        track = Track(self.sequence)
        inventory = Inventory(self.sequence, ["ego/front"], ["vehicle"], track)
        (thing,) = inventory.things
        for record in self.sequence["ego/front"]:
            index = list(record["box_instance"]).index(self.car)
            pose = inventory.world_from_box(thing, record.tick)
            np.testing.assert_allclose(pose.position, record["box_center"][index], atol=1e-6)
            np.testing.assert_allclose(pose.rotation, rotation(record["box_orientation"][index]), atol=1e-6)
        self.assertEqual(self.tables.rows["instance"][0]["nbr_annotations"], 3)
        self.assertEqual(self.tables.rows["instance"][0]["greatx_name"], "car/car")

    def test_far_objects_are_left_out(self):
        near, counts = converted(node="ego", keyframes_hz=0.0, range_m=5.0)
        self.assertEqual((counts["annotations"], near.rows["instance"]), (0, []))


class Radar(unittest.TestCase):
    def test_files_have_the_18_fields(self):
        tables, _ = ego()
        sequence = greatx.load(export_scene.scene()).sequences[0]
        rows = [r for r in tables.rows["sample_data"] if tables.channel(r) == "RADAR_FRONT"]
        self.assertEqual(len(rows), 5)
        for row, record in zip(rows, sequence["ego/radar"]):
            data = (tables.folder / row["filename"]).read_bytes()
            self.assertTrue(data.startswith(b"# .PCD v0.7"))
            plain = export_scene.out_folder()
            plain.write_bytes(data[:-1])
            points = read_pcd(plain)
            self.assertEqual(points.dtype.names, tuple(name for name, _ in RADAR_FIELDS))
            self.assertEqual(len(points.dtype.names), 18)
            self.assertEqual(points.dtype.itemsize, 43)
            wanted = np.array(record["detections"])
            self.assertEqual(len(points), len(wanted))
            for i, name in enumerate(("x", "y", "z", "rcs")):
                np.testing.assert_array_equal(points[name], wanted[:, i])

    def test_velocities_lie_along_the_line_of_sight(self):
        """Those of static surfaces vanish when the carrier's motion is added, but for half a velocity bin."""
        tables, _ = ego()
        sequence = greatx.load(export_scene.scene()).sequences[0]
        row = tables.keyframe(tables.rows["sample"][1], "RADAR_FRONT")
        path = export_scene.out_folder()
        path.write_bytes((tables.folder / row["filename"]).read_bytes()[:-1])
        points, record = read_pcd(path), sequence["ego/radar"].at(2)
        sight = np.stack([points["x"], points["y"], points["z"]], -1).astype(float)
        sight /= np.linalg.norm(sight, axis=1, keepdims=True)
        rate = np.array(record["velocity"], float)
        np.testing.assert_allclose(points["vx"], rate * sight[:, 0], atol=1e-5)
        np.testing.assert_allclose(points["vy"], rate * sight[:, 1], atol=1e-5)
        # The radar's own velocity: that of the node and of the arm that turns with it, in the sensor's axes.
        poses = sequence.at(2)["poses"]
        body, offset = rotation(poses["orientation"][0]), mount(record)
        own = poses["velocity"][0] + np.cross(poses["angular_velocity"][0], body @ offset.position)
        own = (body @ offset.rotation).T @ own
        np.testing.assert_allclose(points["vx_comp"], (rate + sight @ own) * sight[:, 0], atol=1e-5)
        np.testing.assert_allclose(points["vy_comp"], (rate + sight @ own) * sight[:, 1], atol=1e-5)
        # Most detections are walls and the road.
        moving = np.abs(rate + sight @ own)
        bin_ = record.sensor.metadata["velocity_bin_m_s"]
        self.assertLess(np.median(moving), bin_ / 2)
        self.assertGreater(np.median(np.abs(rate)), 3.0)
        np.testing.assert_array_equal(points["dyn_prop"], np.where(moving > max(0.5, bin_), 0, 1))

    def test_a_file_without_detections_has_one_point_of_nan(self):
        empty = Detections(*[np.empty((0, 3))] * 4, np.empty(0, bool))
        for found in (None, empty):
            path = export_scene.out_folder()
            path.write_bytes(radar_bytes(found)[:-1])
            points = read_pcd(path)
            self.assertEqual(len(points), 1)
            self.assertTrue(np.isnan(points["x"][0]))


class Taxonomy(unittest.TestCase):
    def test_visibilities_and_attributes(self):
        self.assertEqual([visibility_token(s) for s in (0, 0.39, 0.4, 0.6, 0.8, 1)], list("112344"))
        self.assertEqual(attributes("vehicle.car", 2, 5.0), ["vehicle.moving"])
        self.assertEqual(attributes("vehicle.car", 2, 0.0), ["vehicle.stopped"])
        self.assertEqual(attributes("vehicle.car", -1, 0.0), ["vehicle.parked"])
        self.assertEqual(attributes("human.pedestrian.adult", 1, 1.0), ["pedestrian.moving"])
        self.assertEqual(attributes("static.other", 1, 1.0), [])

    def test_categories_can_be_chosen(self):
        tables, _ = converted(node="level", categories=("vehicle=vehicle.truck",))
        instance = tables.rows["instance"][0]
        self.assertEqual(tables.get("category", instance["category_token"])["name"], "vehicle.truck")

    def test_sensors_alone(self):
        dataset = greatx.load(export_scene.plain())
        out = export_scene.out_folder()
        # The camera with distortion cannot be written; leave it out by its own node.
        with self.assertRaisesRegex(greatx.DatasetError, "pole/bent.*distortion"):
            write_nuscenes(dataset, out, without_annotations=True)
        tables, counts = converted(node="level", without_annotations=True)
        self.assertEqual((counts["annotations"], tables.rows["sample_annotation"]), (0, []))
        self.assertTrue(math.isclose(tables.rows["ego_pose"][0]["translation"][2], 1.6))


if __name__ == "__main__":
    unittest.main()
