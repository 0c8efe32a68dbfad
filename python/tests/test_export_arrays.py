# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the exporters of whole data sets, HDF5 and WebDataset: every array comes back bit by bit, the same
data set gives the same bytes, and a failure leaves nothing behind."""

import csv
import io
import json
import pathlib
import re
import resource
import subprocess
import sys
import tarfile
import tempfile
import unittest
from unittest import mock

import h5py
import numpy as np

import greatx
import support
from greatx.convert.__main__ import main
from greatx.convert.files import EXTRAS
from greatx.convert.hdf5 import write_hdf5
from greatx.convert.mcap.output import plain
from greatx.convert.mcap.scene import path_lines, statistics
from greatx.convert.webdataset import write_webdataset
from greatx.frames import read_ply, read_png


class Exported(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.out = self.folder / "out"

    def same(self, found, wanted, what):
        found, wanted = np.asarray(found), np.asarray(wanted)
        self.assertEqual((found.dtype, found.shape), (wanted.dtype, wanted.shape), what)
        self.assertEqual(found.tobytes(), wanted.tobytes(), what)


def tree(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


class Hdf5(Exported):
    def check(self, folder):
        ds = greatx.load(folder)
        write_hdf5(ds, self.out)
        with h5py.File(self.out) as file:
            self.assertEqual(json.loads(file["dataset.json"][()]), ds.info)
            for sequence in ds.sequences:
                group = file[sequence.path.name]
                self.same(group["index"], sequence.index, "index")
                for name, sensor in sequence.sensors.items():
                    self.same(group[name]["tick"], sensor.ticks, name)
                    self.same(group[name]["time_ns"], sensor.index[:, 1], name)
                    for array, info in sensor.arrays.items():
                        stored = group[name][array]
                        self.assertEqual(stored.attrs["unit"], info.unit)
                        offsets = group[name].get(stored.attrs.get("offsets", "none"))
                        for i in range(len(sensor)):
                            part = stored[i] if offsets is None else stored[offsets[i] : offsets[i + 1]]
                            self.same(part, sensor[array][i], f"{name}/{array}")
                        if offsets is not None:
                            self.assertEqual(len(stored), offsets[-1])
        return ds

    def test_every_array_comes_back(self):
        ds = self.check(support.rig())
        with h5py.File(self.out) as file:
            camera = file["sequence_0000/car/front"]
            self.assertEqual(camera.attrs["kind"], "camera")
            self.assertEqual(camera.attrs["metadata.fx"], ds.sensors["car/front"].metadata["fx"])
            self.assertEqual(camera["rgb"].compression, "gzip")
            self.assertEqual(camera["rgb"].chunks[1:], (48, 62, 3))
        again = self.folder / "again"
        write_hdf5(ds, again)
        self.assertEqual(again.read_bytes(), self.out.read_bytes())

    def test_packed_records_and_empty_ones(self):
        self.check(support.made("events_packed", support.EVENTS, "--compression", "fast"))
        self.out.unlink()
        self.check(support.two_transmitters())

    def test_a_part(self):
        ds = greatx.load(support.rig())
        counts = write_hdf5(ds, self.out, sequence=1, sensors=["car/lidar"], level=0)
        self.assertEqual((counts["sequences"], counts["sensors"], counts["records"]), (1, 1, 2))
        with h5py.File(self.out) as file:
            self.assertEqual(list(file["sequence_0001"]), ["car", "index"])
            self.assertIsNone(file["sequence_0001/car/lidar/points"].compression)
        with self.assertRaisesRegex(FileExistsError, "exists"):
            write_hdf5(ds, self.out)
        with self.assertRaisesRegex(greatx.DatasetError, "no sensor 'mirror'; it has poses"):
            write_hdf5(ds, self.folder / "other", sensors=["mirror"])
        with self.assertRaisesRegex(greatx.DatasetError, "0 to 9"):
            write_hdf5(ds, self.folder / "other", level=10)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["out"])


class WebDataset(Exported):
    def samples(self):
        """Returns the members of each sample, read by tarfile, as (basename, {extension: bytes})."""
        samples = []
        for shard in sorted(self.out.glob("*.tar")):
            with tarfile.open(shard) as tar:
                for member in tar:
                    base, extension = member.name.split(".", 1)
                    if not samples or samples[-1][0] != base:
                        samples.append((base, {}))
                    self.assertNotIn(extension, samples[-1][1])
                    samples[-1][1][extension] = tar.extractfile(member).read()
                    self.assertEqual((member.mtime, member.uid, member.gid, member.uname), (0, 0, 0, ""))
        return samples

    def test_every_array_comes_back(self):
        ds = greatx.load(support.rig())
        counts = write_webdataset(ds, self.out, shard_mb=0.5)
        samples = self.samples()
        self.assertEqual(len(samples), 8)
        self.assertEqual(counts["samples"], 8)
        for (base, members), tick in zip(samples, (t for s in ds.sequences for t in s)):
            self.assertEqual(base, f"sequence_{tick.sequence.number:04d}_{tick.tick:012d}")
            about = json.loads(members.pop("json"))
            self.assertEqual((about["tick"], about["time_ns"]), (tick.tick, tick.time_ns))
            self.assertEqual(about["samples"], {name: record.sample for name, record in tick.items()})
            wanted = {f"{n.replace('/', '.')}.{a}" for n in tick for a in ds.sensors[n].arrays}
            self.assertEqual({m.rsplit(".", 1)[0] for m in members}, wanted)
            for name, record in tick.items():
                for array, info in record.sensor.arrays.items():
                    member = f"{name.replace('/', '.')}.{array}"
                    if member + ".png" in members:
                        path = self.folder / "picture.png"
                        path.write_bytes(members[member + ".png"])
                        found = read_png(path).astype(info.dtype)
                    else:
                        found = np.load(io.BytesIO(members[member + ".npy"]))
                    self.same(found, record[array], member)

    def test_shards_and_index(self):
        ds = greatx.load(support.rig())
        counts = write_webdataset(ds, self.out, shard_mb=0.5)
        index = json.loads((self.out / "index.json").read_text())
        shards = sorted(self.out.glob("shard-*.tar"))
        self.assertEqual([s["url"] for s in index["shardlist"]], [s.name for s in shards])
        self.assertEqual([s["filesize"] for s in index["shardlist"]], [s.stat().st_size for s in shards])
        self.assertEqual(sum(s["nsamples"] for s in index["shardlist"]), 8)
        self.assertEqual((counts["shards"] > 2, index["wids_version"]), (True, 1))
        # A shard that would be larger than asked holds one sample.
        for entry in index["shardlist"]:
            self.assertTrue(entry["filesize"] <= 0.5e6 + 10240 or entry["nsamples"] == 1)
        members = {}
        for shard in shards:
            with tarfile.open(shard) as tar:
                members.update({(shard.name, m.name): (m.offset_data, m.size) for m in tar})
        with open(self.out / "index.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(members))
        for row in rows:
            place = members[row["shard"], f"{row['sample']}.{row['member']}"]
            self.assertEqual((int(row["offset"]), int(row["size"])), place)
        again = self.folder / "again"
        write_webdataset(ds, again, shard_mb=0.5)
        self.assertEqual(tree(again), tree(self.out))
        self.out = self.folder / "two"
        write_webdataset(ds, self.out, shard_samples=3, name="part")
        self.assertEqual(len(list(self.out.glob("part-00000?.tar"))), 3)

    def test_a_part(self):
        ds = greatx.load(support.rig())
        arrays = ["car/front/rgb", "csi/cfr", "car/lidar/points", "car/lidar/ring"]
        counts = write_webdataset(ds, self.out, sequence=0, arrays=arrays, complete=True, clouds=True)
        self.assertEqual((counts["samples"], counts["ticks left out"]), (2, 2))
        for base, members in self.samples():
            self.assertEqual(set(members), {"json", "car.front.rgb.png", "csi.cfr.npy", "car.lidar.ply"})
            path = self.folder / "cloud.ply"
            path.write_bytes(members["car.lidar.ply"])
            record = ds.sequences[0]["car/lidar"].at(int(base.rsplit("_", 1)[1]))
            self.same(read_ply(path)["ring"], record.ring, "ring")
        other = self.folder / "other"
        for options, word in (
            ({"arrays": ["car/front/infrared"]}, "no array 'car/front/infrared'; it has"),
            ({"sensors": ["car"]}, "no sensor 'car'"),
            ({"shard_mb": 0}, "more than 0 MB"),
            ({"name": "a/b"}, "beginning of a file's name"),
        ):
            with self.assertRaisesRegex(greatx.DatasetError, word):
                write_webdataset(ds, other, **options)
        with self.assertRaisesRegex(FileExistsError, "nothing is overwritten"):
            write_webdataset(ds, self.out)
        self.assertFalse(other.exists())


class Mcap(unittest.TestCase):
    """What needs no packages; tests/peer/exports_mcap.py reads whole files by MCAP's own reader."""

    def test_lines_are_as_long_as_the_delays_of_their_paths(self):
        for folder in (support.street(), support.rig()):
            for record in greatx.load(folder).sequences[0]["csi"]:
                paths = record.paths()
                lines, left_out = path_lines(record, 1000)
                self.assertEqual((len(lines), left_out), (len(paths["delay"]), 0))
                power = np.mean(np.abs(paths["amplitude"].astype(complex)) ** 2, axis=(1, 2))
                order = np.argsort(-power, kind="stable")
                for (points, below), number in zip(lines, order):
                    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
                    self.assertAlmostEqual(length / (support.C * paths["delay"][number]), 1, 9)
                    self.assertAlmostEqual(below, 10 * np.log10(power[number] / power[order[0]]), 9)
                self.assertEqual([len(lines[0][0]), path_lines(record, 1)[1]], [2, len(lines) - 1])

    def test_links_of_a_channel(self):
        record = greatx.load(support.street())["csi"].record(2)
        schema, value = statistics(record)
        links = json.loads(json.dumps(value, allow_nan=False))["links"]
        names = [(link["rx"], link["tx"]) for link in links]
        ends = ("car/antenna", "walker/antenna"), ("bs/panel", "corner/panel")
        self.assertEqual(names, [(rx, tx) for rx in ends[0] for tx in ends[1]])
        for number, link in enumerate(links):
            rx, tx = divmod(number, 2)
            self.assertEqual(set(link), set(schema["properties"]["links"]["items"]["properties"]))
            self.assertEqual(link["path_count"], record.path_count[rx, tx])
            self.assertEqual(link["delay_spread"], record.delay_spread[rx, tx])
            self.assertAlmostEqual(link["path_gain_db"], 10 * np.log10(record.path_gain[rx, tx]), 12)
        self.assertEqual(
            [plain(v) for v in (np.nan, np.inf, np.float32(0.5), np.uint8(3))], [None, None, 0.5, 3]
        )

    def test_no_paths_and_missing_arrays(self):
        second = greatx.load(support.two_transmitters())["csi"].record(1)
        self.assertEqual(path_lines(second, 10), ([], 0))
        links = statistics(second)[1]["links"]
        self.assertEqual([len(links), links[5]["path_count"]], [6, 0])


class Failures(Exported):
    def test_a_full_disk_leaves_nothing(self):
        for tool in ("hdf5", "webdataset", "dsec"):
            done = subprocess.run(
                [sys.executable, "-m", "greatx.convert", tool, support.rig(), self.out]
                + (["--events-left", "car/dvs"] if tool == "dsec" else []),
                capture_output=True,
                text=True,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)),
            )
            self.assertEqual((tool, done.returncode), (tool, 1), done.stderr)
            self.assertRegex(done.stderr.splitlines()[-1], "^error: ")
            self.assertEqual(list(self.folder.iterdir()), [], tool)

    def test_a_file_of_a_killed_export_is_replaced_and_other_things_are_not(self):
        ds = greatx.load(support.space())
        part = self.folder / "out.part"
        part.write_text("half")
        write_hdf5(ds, self.out)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["out"])
        other = self.folder / "other"
        (self.folder / "other.part").mkdir()
        with self.assertRaisesRegex(FileExistsError, "no unfinished export"):
            write_hdf5(ds, other)
        self.assertFalse(other.exists())

    def test_missing_packages_are_named_with_their_extra(self):
        for tool, module, packages in (
            ("hdf5", "h5py", "h5py"),
            ("mcap", "mcap.writer", "mcap mcap-protobuf-support foxglove-schemas-protobuf"),
            ("radial", "PIL.Image", "pillow"),
        ):
            said = io.StringIO()
            with mock.patch.dict(sys.modules, {module: None}), mock.patch("sys.stderr", said):
                code = main(
                    [
                        tool,
                        str(support.rig()),
                        str(self.out),
                        *(["--camera", "car/front"] * (tool == "radial")),
                    ]
                )
            self.assertEqual(code, 1)
            self.assertIn(f"`pip install {packages}`", said.getvalue())
            self.assertIn(module, said.getvalue())
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_extras_are_those_of_the_package(self):
        text = (pathlib.Path(greatx.__file__).resolve().parents[1] / "pyproject.toml").read_text()
        for extra, packages in EXTRAS.items():
            listed = re.search(rf"^{extra} = \[(.*)\]$", text, re.MULTILINE)[1]
            self.assertEqual(re.findall(r'"([\w-]+)', listed), list(packages))

    def test_a_campaign_is_no_data_set(self):
        campaign = self.folder / "campaign"
        campaign.mkdir()
        (campaign / "splits.csv").write_text("cell,sequence,split\nday,0,train\n")
        said = io.StringIO()
        with mock.patch("sys.stderr", said):
            self.assertEqual(main(["hdf5", str(campaign), str(self.out)]), 1)
        self.assertIn("expected a data set, found a campaign; convert one of its cells", said.getvalue())


if __name__ == "__main__":
    unittest.main()
