# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the readers of PNG, OpenEXR, PLY, PCD and KITTI with files made here, and one format against
another.
"""

import hashlib
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest
import zlib

import numpy as np

import greatx
import support
from greatx.frames import read_exr, read_kitti, read_pcd, read_ply, read_png


def png(lines, width, height, bits, colour):
    """Returns a PNG of filtered lines, each of which begins with the number of its filter."""

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    packed = zlib.compress(bytes(lines))
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", packed[:5])
        + chunk(b"IDAT", packed[5:])
        + chunk(b"IEND", b"")
    )


def exr(channels, height, width, compression):
    """Returns an OpenEXR of the channels {name: float32 [h, w]}, written independently from the format's
    description."""

    def attribute(name, kind, body):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(body)) + body

    names = sorted(channels)
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for n in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    out = (
        struct.pack("<II", 20000630, 2)
        + attribute(b"channels", b"chlist", listed)
        + attribute(b"compression", b"compression", bytes([compression]))
        + attribute(b"dataWindow", b"box2i", box)
        + b"\0"
    )
    per_block = 16 if compression == 3 else 1
    blocks = []
    for y in range(0, height, per_block):
        raw = b"".join(
            channels[n][line].astype("<f4").tobytes()
            for line in range(y, min(y + per_block, height))
            for n in names
        )
        body = raw
        if compression == 3:
            halves = np.frombuffer(raw[0::2] + raw[1::2], np.uint8).astype(int)
            coded = np.concatenate([halves[:1], np.diff(halves) + 128]) % 256
            body = min(zlib.compress(coded.astype(np.uint8).tobytes()), raw, key=len)
        blocks.append(struct.pack("<ii", y, len(body)) + body)
    at = len(out) + 8 * len(blocks)
    for block in blocks:
        out += struct.pack("<Q", at)
        at += len(block)
    return out + b"".join(blocks)


class Files(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.path = pathlib.Path(holder.name, "frame")
        self.random = np.random.default_rng(3)

    def test_png_filters(self):
        pixels = self.random.integers(0, 256, (4, 5, 3), np.uint8)
        left = np.diff(pixels, axis=1, prepend=np.zeros((4, 1, 3), np.uint8)).astype(np.uint8)
        above = np.diff(pixels, axis=0, prepend=np.zeros((1, 5, 3), np.uint8)).astype(np.uint8)
        for filters in ([2, 2, 2, 2], [0, 1, 2, 1], [1, 0, 0, 2]):
            lines = b"".join(
                bytes([f]) + (pixels, left, above)[f][y].tobytes() for y, f in enumerate(filters)
            )
            self.path.write_bytes(png(lines, 5, 4, 8, 2))
            np.testing.assert_array_equal(read_png(self.path), pixels, str(filters))

    def test_png_of_16_bits_and_grey(self):
        ids = self.random.integers(0, 65536, (3, 7), np.uint16)
        raw = ids.astype(">u2").view(np.uint8).reshape(3, 14)
        self.path.write_bytes(png(b"".join(b"\0" + row.tobytes() for row in raw), 7, 3, 16, 0))
        np.testing.assert_array_equal(read_png(self.path), ids)
        self.path.write_bytes(png(b"".join(b"\0" + row.tobytes() for row in raw), 14, 3, 8, 0))
        np.testing.assert_array_equal(read_png(self.path), raw)

    def test_png_that_greatx_does_not_write(self):
        for data, words in (
            (b"GIF89a" * 9, "is no PNG"),
            (png(b"\4" + bytes(3), 1, 1, 8, 2), "filter 4"),
            (png(b"\0" + bytes(4), 1, 1, 8, 6), "colour type 6"),
            (png(b"\0", 1, 1, 8, 2), "damaged"),
        ):
            self.path.write_bytes(data)
            with self.assertRaisesRegex(greatx.DatasetError, f"frame: .*{words}"):
                read_png(self.path)

    def test_exr(self):
        values = self.random.normal(size=(37, 9)).astype(np.float32)
        values[3, 4], values[5, 5] = np.inf, np.nan
        smooth = np.tile(np.arange(9, dtype=np.float32), (37, 1))
        for compression in (0, 3):
            for plane in "YZ":  # greatx writes Y; some data sets have Z
                self.path.write_bytes(exr({plane: values}, 37, 9, compression))
                np.testing.assert_array_equal(read_exr(self.path), values)
            self.path.write_bytes(exr({"R": values, "G": smooth, "B": -smooth}, 37, 9, compression))
            np.testing.assert_array_equal(read_exr(self.path), np.stack([values, smooth, -smooth], -1))
        self.path.write_bytes(exr({"A": values}, 37, 9, 0))
        with self.assertRaisesRegex(greatx.DatasetError, "frame: .*found A"):
            read_exr(self.path)
        for data in (b"", b"nonsense" * 9, exr({"Z": values}, 37, 9, 3)[:-40], exr({"Z": values}, 37, 9, 4)):
            self.path.write_bytes(data)
            with self.assertRaisesRegex(greatx.DatasetError, "frame: "):
                read_exr(self.path)

    def test_ply(self):
        self.path.write_bytes(
            b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
            b"property ushort ring\nend_header\n" + struct.pack("<fHfH", 1.5, 7, -2, 9)
        )
        points = read_ply(self.path)
        self.assertEqual((list(points["x"]), list(points["ring"])), ([1.5, -2.0], [7, 9]))
        for data in (b"", b"ply\nformat ascii 1.0\nend_header\n", self.path.read_bytes()[:-1]):
            self.path.write_bytes(data)
            with self.assertRaisesRegex(greatx.DatasetError, "frame: "):
                read_ply(self.path)

    def test_pcd_and_kitti(self):
        head = (
            b"# .PCD v0.7\nVERSION 0.7\nFIELDS x ring\nSIZE 4 2\nTYPE F U\nCOUNT 1 1\nWIDTH 2\nHEIGHT 1\n"
            b"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n"
        )
        self.path.write_bytes(head + struct.pack("<fHfH", 1.5, 7, -2, 9))
        points = read_pcd(self.path)
        self.assertEqual((list(points["x"]), list(points["ring"])), ([1.5, -2.0], [7, 9]))
        for data in (
            b"",
            head.replace(b"binary", b"ascii"),
            head,
            head.replace(b"COUNT 1", b"COUNT 2"),
            self.path.read_bytes()[:-1],
        ):
            self.path.write_bytes(data)
            with self.assertRaisesRegex(greatx.DatasetError, "frame: "):
                read_pcd(self.path)
        self.path.write_bytes(struct.pack("<8f", *range(8)))
        np.testing.assert_array_equal(read_kitti(self.path), np.arange(8, dtype=np.float32).reshape(2, 4))
        self.path.write_bytes(bytes(20))
        with self.assertRaisesRegex(greatx.DatasetError, "frame: .*20 bytes"):
            read_kitti(self.path)


class OfADataSet(unittest.TestCase):
    def setUp(self):
        self.ds = greatx.load(support.street())

    def test_depth_is_the_same_in_both_formats(self):
        for record in self.ds["car/front"]:
            exact = record["depth"]
            self.assertEqual(exact.shape, (24, 31))
            coded = record["depth24"]
            near = exact < 999
            self.assertTrue(near.any() and not near.all())
            np.testing.assert_allclose(coded[near], exact[near], atol=4e-5)
            self.assertTrue(np.all(coded[~near] == 1000))

    def test_pictures_and_ids(self):
        camera = self.ds["car/front"]
        record = camera.record(1)
        self.assertEqual((record.rgb.shape, record.rgb.dtype), ((24, 31, 3), np.uint8))
        sky = np.isinf(record.depth)
        self.assertTrue(np.all(record.instance[sky] == 0) and np.all(record.instance[~sky] > 0))
        # Development is monotonic: a pixel of more radiance is not darker in the picture.
        bright = record.hdr.max(axis=-1) > 2 * np.median(record.hdr)
        self.assertGreater(record.rgb[bright].mean(), record.rgb[~bright].mean())
        self.assertEqual(camera.rgb.path(1).name, "000001.png")
        self.assertEqual([p.shape for p in camera.rgb[:]], [(24, 31, 3)] * 2)
        with self.assertRaises(IndexError):
            camera.rgb[2]

    def test_clouds_are_the_same_in_both_formats(self):
        record = self.ds["car/lidar"].record(0)
        cloud = record.cloud
        np.testing.assert_array_equal(cloud["points"], record.points)
        np.testing.assert_array_equal(cloud["ring"], record.ring)
        np.testing.assert_array_equal(record.velodyne, record.points)
        for name, values in record.pcd.items():
            np.testing.assert_array_equal(values, cloud[name])
        header = self.ds["car/lidar"]["cloud"].path(0).read_bytes().split(b"end_header")[0]
        # The names that Open3D's tensor reader knows.
        self.assertIn(b"property uint16 ring\n", header)
        self.assertIn(b"property int instance\n", header)
        self.assertEqual((record.instance.dtype, cloud["instance"].dtype), (np.uint32, np.uint32))
        self.assertTrue(np.all(record.return_number == 1) and np.all(record.return_count >= 1))
        np.testing.assert_allclose(np.linalg.norm(record.points[:, :3], axis=1), record["range"], rtol=1e-5)

    def test_clouds_of_older_data_sets(self):
        """Types were called ushort and uint before; the program and the package read both."""
        folder = support.copy_of(support.street())
        wanted = {name: np.array(values) for name, values in self.ds["car/lidar"].record(1).cloud.items()}
        manifest = json.loads((folder / "manifest.json").read_text())
        for path in sorted((folder / "sequence_0000/car/lidar/cloud").iterdir()):
            data = path.read_bytes().replace(b"y uint16 ", b"y ushort ").replace(b"y int ", b"y uint ")
            path.write_bytes(data)
            (entry,) = [f for f in manifest["files"] if f["path"] == str(path.relative_to(folder))]
            manifest["totals"]["bytes"] += len(data) - entry["size"]
            entry.update(size=len(data), sha256=hashlib.sha256(data).hexdigest())
        (folder / "manifest.json").write_text(json.dumps(manifest))
        for name, values in greatx.load(folder)["car/lidar"].record(1).cloud.items():
            np.testing.assert_array_equal(values, wanted[name])
        subprocess.run([os.environ["GREATX_PROGRAM"], "verify", folder], check=True, capture_output=True)
        data = path.read_bytes().replace(b"y uint ", b"y int ")
        path.write_bytes(data[:-1] + b"\xff")
        with self.assertRaisesRegex(
            greatx.DatasetError, "000001.ply: is damaged: .*expected material from 0"
        ):
            greatx.load(folder)["car/lidar"].record(1).cloud


if __name__ == "__main__":
    unittest.main()
