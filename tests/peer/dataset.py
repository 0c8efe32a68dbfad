# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the parts of a data set that the channel checks need, by docs/dataset.md alone. Uses NumPy and JSON
and nothing of greatx."""
import json
import pathlib

import numpy as np

C = 299792458.0


def rotation(q):
    """Returns the 3x3 matrix of the unit quaternion w, x, y, z."""
    w, x, y, z = np.asarray(q, float) / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


class Channel:
    """Reads one channel sensor of one sequence."""

    def __init__(self, folder, name=None, sequence=0):
        self.folder = pathlib.Path(folder)
        self.info = json.loads((self.folder / "dataset.json").read_text())
        channels = [s for s in self.info["sensors"] if s["kind"] == "csi"]
        self.sensor = next(s for s in channels if name in (None, s["name"]))
        self.meta = self.sensor["metadata"]
        self.materials = self.info["run"]["materials"]
        self.effects = self.info["run"]["effects"]
        root = self.folder / f"sequence_{sequence:04d}"
        self.root = root / self.sensor["name"]
        self.cfr = np.load(self.root / "cfr.npy", mmap_mode="r")
        self.path_count = np.load(self.root / "path_count.npy")
        self.path_gain = np.load(self.root / "path_gain.npy")
        self.line_of_sight = np.load(self.root / "line_of_sight.npy")
        self.every_element = np.load(self.root / "every_element.npy")
        self.arrays = {f.stem: np.load(f, mmap_mode="r") for f in sorted((self.root / "paths").glob("*.npy"))}
        index = np.load(root / "index.npy")
        sensors = self.info["sensors"]
        of = lambda s: index[index[:, 2] == sensors.index(s)]
        pose = next(s for s in sensors if s["kind"] == "pose")
        pose_row = {tick: row for tick, _, _, _, row in of(pose)}
        self.records = [(tick, row, pose_row[tick]) for tick, _, _, _, row in of(self.sensor)]
        self.nodes = pose["metadata"]["nodes"]
        self.position = np.load(root / "poses/position.npy")
        self.orientation = np.load(root / "poses/orientation.npy")
        num, _, den = str(self.info["tick_rate_hz"]).partition("/")
        self.tick_rate = float(num) / float(den or 1)

    def __len__(self):
        return len(self.records)

    def paths(self, record):
        """Returns the arrays of the paths in the channel's record number `record`, by name."""
        row = self.records[record][1]
        out = {}
        for name, array in self.arrays.items():
            if not name.endswith("_offsets"):
                offsets = self.arrays[name + "_offsets"]
                out[name] = np.array(array[offsets[row] : offsets[row + 1]])
        return out

    def response(self, record):
        return np.array(self.cfr[self.records[record][1]])

    def end(self, record, description):
        """Returns the world position and the world_from_antenna matrix of an antenna at a record."""
        node = self.nodes.index(description["name"].split("/")[0])
        row = self.records[record][2]
        turn = rotation(self.orientation[row, node])
        mount = description["body_from_antenna"]
        return (
            self.position[row, node] + turn @ np.array(mount["position_m"]),
            turn @ rotation(mount["orientation_wxyz"]),
        )
