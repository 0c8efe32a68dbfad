# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests a camera's ground truth in a data set by computations in NumPy: the flow by depth and poses, the
boxes by the corners of the 3-D boxes and the picture of ids, and the depth along the ray by the planar
depth.
"""
import unittest

import numpy as np

import greatx
import support


def rotation(q):
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


class Truth(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ds = greatx.load(support.truth())
        cls.camera = cls.ds["van/front"]
        cls.poses = cls.ds.single().poses
        m = cls.camera.metadata
        v, u = np.mgrid[: m["height"], : m["width"]] + m["pixel_center"]
        # Rays are in sensor axes: x forward, y left, z up.
        cls.pixel = np.stack([u, v], axis=-1)
        cls.rays = np.stack([np.ones_like(u), -(u - m["cx"]) / m["fx"], -(v - m["cy"]) / m["fy"]], axis=-1)

    def project(self, p):
        m = self.camera.metadata
        return np.stack(
            [m["cx"] - m["fx"] * p[..., 1] / p[..., 0], m["cy"] - m["fy"] * p[..., 2] / p[..., 0]], axis=-1
        )

    def camera_pose(self, row):
        """Returns the world position and the rotation world_from_sensor of the camera at a record."""
        mount = self.camera.metadata["body_from_sensor"]
        r = rotation(self.poses.orientation[row, 0])
        return self.poses.position[row, 0] + r @ mount["position_m"], r @ rotation(mount["orientation_wxyz"])

    def test_flow_is_the_reprojected_depth(self):
        instances = self.ds.instances
        for k in range(len(self.camera) - 1):
            record = self.camera.record(k)
            still = np.array([True] + [not i["name"].startswith(("van", "car")) for i in instances])[
                record.instance
            ]
            p0, r0 = self.camera_pose(k)
            p1, r1 = self.camera_pose(k + 1)
            depth = np.where(np.isfinite(record.depth), record.depth, 1e12)[..., None].astype(float)
            there = (p0 + (self.rays * depth) @ r0.T - p1) @ r1
            expected = self.project(there) - self.pixel
            seen = still & (there[..., 0] > self.camera.near_m)
            self.assertGreater(seen.sum(), 500)
            self.assertLess(np.abs(record.flow - expected)[seen].max(), 1e-3)
            self.assertTrue(np.isnan(record.flow)[still & ~seen].all())

    def test_depth_along_the_ray(self):
        record = self.camera.record(1)
        expected = record.depth * np.linalg.norm(self.rays, axis=-1)
        finite = np.isfinite(record.depth)
        np.testing.assert_allclose(record.depth_ray[finite], expected[finite], rtol=1e-6)
        self.assertTrue(np.isposinf(record.depth_ray[~finite]).all())

    def test_normals_are_unit_and_face_the_camera(self):
        record = self.camera.record(1)
        length = np.linalg.norm(record.normals, axis=-1)
        np.testing.assert_allclose(length, record.instance > 0, atol=1e-6)
        _, r = self.camera_pose(1)
        flat = np.array([False] + [i["class"] in ("road", "pavement") for i in self.ds.instances])[
            record.instance
        ]
        self.assertGreater(flat.sum(), 100)
        self.assertLess(np.sum(record.normals * (self.rays @ r.T), axis=-1)[flat].max(), 0)

    def test_boxes(self):
        corners = np.stack(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5]), axis=-1).reshape(8, 3)
        cars = 0
        for record in self.camera:
            for i in range(len(record.box_instance)):
                ids = record.box_instance[i] + np.arange(record.box_instance_count[i])
                where = np.isin(record.instance, ids)
                self.assertEqual(record.box_visible_pixels[i], where.sum())
                self.assertEqual(
                    self.ds.semantic_classes[record.box_semantic[i]], self.ds.instances[ids[0] - 1]["class"]
                )
                if where.any():
                    v, u = np.nonzero(where)
                    self.assertEqual(list(record.box_modal[i]), [u.min(), v.min(), u.max() + 1, v.max() + 1])
                self.assertLessEqual(record.box_visible_pixels[i], record.box_alone_pixels[i])
                # The 2-D box lies within the projected corners of the 3-D one.
                p = (corners * record.box_size[i]) @ rotation(
                    record.box_sensor_orientation[i]
                ).T + record.box_sensor_center[i]
                if record.box_crosses_near[i] or p[:, 0].min() < self.camera.near_m:
                    continue
                uv = self.project(p)
                self.assertTrue((record.box_unclipped[i, :2] >= uv.min(0) - 1e-3).all())
                self.assertTrue((record.box_unclipped[i, 2:] <= uv.max(0) + 1e-3).all())
                # The centres in sensor and world coordinates agree.
                position, r = self.camera_pose(record.row)
                np.testing.assert_allclose(
                    position + r @ record.box_sensor_center[i], record.box_center[i], atol=1e-6
                )
                if record.box_node[i] == 1:
                    cars += 1
                    turn = rotation(record.box_orientation[i]) - rotation(
                        self.poses.orientation[record.row, 1]
                    )
                    self.assertLess(np.abs(turn).max(), 1e-12)
        self.assertEqual(cars, len(self.camera))


if __name__ == "__main__":
    unittest.main()
