# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the export to COCO, and its run lengths against letters worked out by hand."""

import functools
import json
import unittest

import numpy as np

import export_scene
import greatx
from greatx.convert import write_coco
from greatx.convert.coco.rle import decode, encode, pack, run_lengths
from greatx.frames import read_png


class RunLengths(unittest.TestCase):
    def test_letters_by_hand(self):
        # 5 = 00101: '5'. 16 = 10000 is negative in five bits, so 0 follows: (16 + 32 + 48), 48 = '`', '0'.
        self.assertEqual(pack(np.array([5])), "5")
        self.assertEqual(pack(np.array([16])), "`0")
        self.assertEqual(pack(np.array([31])), "o0")
        # 100 = 00011 00100: 4 + 32 + 48 = 'T', 3 + 48 = '3'. The fourth run is kept as a difference from the
        # second: 2 - 7 = -5 = ...11011: 27 + 48 = 'K'.
        self.assertEqual(pack(np.array([100, 7, 3, 2])), "T373K")

    def test_runs_begin_with_zeros_and_go_down_the_columns(self):
        mask = np.array([[1, 0, 0], [1, 1, 0]])
        self.assertEqual(run_lengths(mask).tolist(), [0, 2, 1, 1, 2])
        self.assertEqual(run_lengths(np.zeros((2, 2))).tolist(), [4])
        self.assertEqual(run_lengths(np.ones((2, 2))).tolist(), [0, 4])
        self.assertEqual(encode(mask)["size"], [2, 3])

    def test_masks_come_back(self):
        rng = np.random.default_rng(4)
        masks = [np.zeros((3, 4)), np.ones((3, 4)), np.eye(40), rng.random((200, 300)) < 0.5]
        big = np.zeros((2000, 1500), bool)
        big[:, 700:] = True
        for mask in [*masks, big, ~big, rng.random((1, 1)) < 2]:
            np.testing.assert_array_equal(decode(encode(mask)), np.asarray(mask, bool))


@functools.lru_cache(maxsize=None)
def converted():
    out = export_scene.out_folder()
    return out, write_coco(greatx.load(export_scene.scene()), out)


class Export(unittest.TestCase):
    def setUp(self):
        self.out, self.counts = converted()
        self.dataset = greatx.load(export_scene.scene())
        self.found = json.loads((self.out / "annotations/instances.json").read_text())

    def record(self, image):
        sensor = self.dataset.sequences[image["greatx_sequence"]][image["greatx_camera"]]
        return sensor.at(image["greatx_tick"])

    def test_all_cameras_are_there(self):
        self.assertEqual(self.counts["pictures"], 15)
        self.assertEqual(self.counts["cameras without ids left out"], 1)
        self.assertEqual(
            {i["greatx_camera"] for i in self.found["images"]}, {"ego/front", "ego/side", "level/left"}
        )
        for image in self.found["images"]:
            record = self.record(image)
            np.testing.assert_array_equal(read_png(self.out / "images" / image["file_name"]), record["rgb"])
            self.assertEqual((image["height"], image["width"]), record["instance"].shape)

    def test_masks_are_those_of_the_ids(self):
        car = export_scene.car_id(self.dataset)
        images = {image["id"]: image for image in self.found["images"]}
        categories = {c["id"]: c["name"] for c in self.found["categories"]}
        self.assertGreater(len(self.found["annotations"]), 8)
        seen = set()
        for annotation in self.found["annotations"]:
            record = self.record(images[annotation["image_id"]])
            mask = decode(annotation["segmentation"])
            np.testing.assert_array_equal(mask, record["instance"] == annotation["greatx_instance"])
            self.assertEqual(annotation["area"], mask.sum())
            rows, columns = np.nonzero(mask)
            x, y, w, h = annotation["bbox"]
            self.assertEqual((x, y), (columns.min(), rows.min()))
            self.assertEqual((x + w, y + h), (columns.max() + 1, rows.max() + 1))
            seen.add(annotation["greatx_instance"])
            if annotation["greatx_instance"] == car:
                self.assertEqual(categories[annotation["category_id"]], "vehicle")
                index = list(record["box_instance"]).index(car)
                np.testing.assert_array_equal(record["box_modal"][index], [x, y, x + w, y + h])
        self.assertIn(car, seen)
        ids = [annotation["id"] for annotation in self.found["annotations"]]
        self.assertEqual(ids, list(range(1, len(ids) + 1)))

    def test_panoptic_pictures_cover_all_pixels_with_a_class(self):
        whole = json.loads((self.out / "annotations/panoptic.json").read_text())
        images = {image["id"]: image for image in whole["images"]}
        things = {c["id"] for c in whole["categories"] if c["isthing"]}
        for annotation in whole["annotations"]:
            record = self.record(images[annotation["image_id"]])
            rgb = read_png(self.out / "annotations/panoptic" / annotation["file_name"]).astype(int)
            ids = rgb[..., 0] + 256 * rgb[..., 1] + 65536 * rgb[..., 2]
            self.assertEqual({s["id"] for s in annotation["segments_info"]}, set(np.unique(ids)) - {0})
            category = np.zeros_like(ids)
            for segment in annotation["segments_info"]:
                self.assertEqual(segment["area"], (ids == segment["id"]).sum())
                self.assertEqual(segment["category_id"] in things, segment["id"] > 256)
                category[ids == segment["id"]] = segment["category_id"]
            np.testing.assert_array_equal(category, record["semantic"])

    def test_pictures_of_all_sequences_are_one_set(self):
        """Also from a compressed data set and a camera with distortion."""
        out = export_scene.out_folder()
        self.assertEqual(write_coco(greatx.load(export_scene.plain()), out)["pictures"], 8)
        images = json.loads((out / "annotations/instances.json").read_text())["images"]
        self.assertEqual([image["id"] for image in images], list(range(1, 9)))
        self.assertEqual(images[-1]["file_name"], "sequence_0001/pole/bent/000001.png")
        self.assertTrue(all((out / "images" / image["file_name"]).is_file() for image in images))

    def test_classes_of_objects_can_be_chosen(self):
        out = export_scene.out_folder()
        counts = write_coco(self.dataset, out, cameras=["level/left"], things=["building"], panoptic=False)
        found = json.loads((out / "annotations/instances.json").read_text())
        self.assertEqual([c["name"] for c in found["categories"]], ["building"])
        self.assertEqual(counts["pictures"], 5)
        self.assertGreater(counts["annotations"], 5)
        self.assertFalse((out / "annotations/panoptic.json").exists())


if __name__ == "__main__":
    unittest.main()
