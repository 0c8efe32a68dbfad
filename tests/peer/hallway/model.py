# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes scenes for greatx of the hallway's model: Mitsuba's shapes, of which the walls are parted into zones
that may have materials of their own.
"""

import json
import pathlib
import re
import struct
import subprocess

import numpy as np

#: the zones of the walls: both ends of the corridor, its long sides, and everything beside it
ZONES = ("north", "south", "east", "west", "side_rooms")
SHAPES = ("floor", "ceiling", *ZONES)


def read_ply(path):
    """Returns the vertices [n, 3] and the faces (tuples of indices) of a binary little-endian PLY file."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    text = header.decode()
    if "format binary_little_endian" not in text:
        raise SystemExit(f"{path}: expected a binary little-endian PLY file")
    vertices, faces = (int(re.search(rf"element {e} (\d+)", text).group(1)) for e in ("vertex", "face"))
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4"}
    fields = re.findall(r"property (\w+) (\w+)\n", text.split("element face")[0])
    points = np.frombuffer(body, [(name, types[kind]) for kind, name in fields], vertices)
    at, found = points.nbytes, []
    for _ in range(faces):
        corners = body[at]
        found.append(struct.unpack_from(f"<{corners}i", body, at + 1))
        at += 1 + 4 * corners
    return np.stack([points[axis] for axis in "xyz"], axis=1).astype(float), found


def write_ply(path, points, faces):
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    lists = b"".join(bytes([len(f)]) + struct.pack(f"<{len(f)}i", *f) for f in faces)
    path.write_bytes(header.encode() + np.asarray(points, "<f4").tobytes() + lists)


def zone_of(corners, corridor):
    """Returns the zone of a wall. `corridor`: (x, y) ranges of the corridor."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    (x_0, x_1), (y_0, y_1) = corridor
    flat = high - low < 0.05
    if flat[1] and abs(low[1] - y_1) < 0.05:
        return "north"
    if flat[1] and abs(low[1] - y_0) < 0.05:
        return "south"
    if flat[0] and abs(low[0] - x_1) < 0.05:
        return "east"
    if flat[0] and abs(low[0] - x_0) < 0.05 and high[1] - low[1] > 5.0:
        return "west"
    return "side_rooms"


class Hall:
    """The model in a folder of its own: `glb`, and a sidecar of materials that can be written again."""

    def __init__(self, measured, folder, program, floor_m=0.0):
        """`floor_m`: height of the floor. The model has it 0.1 m too high, and the survey at 0."""
        self.folder = pathlib.Path(folder)
        (self.folder / "meshes").mkdir(parents=True, exist_ok=True)
        meshes = measured.folder / "scenes/inue_simple/meshes"
        for name in ("floor", "ceiling"):
            points, faces = read_ply(meshes / f"{name}.ply")
            if name == "floor":
                points[:, 2] = floor_m
            write_ply(self.folder / f"meshes/{name}.ply", points, faces)
        self._part_walls(*read_ply(meshes / "walls.ply"))
        self._write_xml()
        self.glb = self.folder / "hall.glb"
        subprocess.run(
            [program, "scene", "import", self.folder / "hall.xml", "-o", self.glb],
            check=True,
            stdout=subprocess.DEVNULL,
        )

    def _part_walls(self, points, faces):
        # The corridor is the longest part of the model along y: its ends are the outermost walls across it,
        # and its east wall is the outermost one along it.
        corners = [points[list(face)] for face in faces]
        across = [c for c in corners if np.ptp(c[:, 1]) < 0.05 and np.ptp(c[:, 0]) > 1.0]
        y_0, y_1 = min(c[0, 1] for c in across), max(c[0, 1] for c in across)
        end = next(c for c in across if c[0, 1] == y_1)
        corridor = ((end[:, 0].min(), end[:, 0].max()), (y_0, y_1))
        zones = {zone: [] for zone in ZONES}
        for face, at in zip(faces, corners):
            zones[zone_of(at, corridor)].append(face)
        for zone, part in zones.items():
            if not part:
                raise SystemExit(f"the model has no wall in the zone {zone!r}")
            write_ply(self.folder / f"meshes/{zone}.ply", points, part)

    def _write_xml(self):
        # The importer wants a radio material for each shape; the sidecar replaces it.
        materials = "".join(
            f'<bsdf type="itu-radio-material" id="{n}"><string name="type" value="concrete"/>'
            '<float name="thickness" value="0.1"/></bsdf>\n'
            for n in SHAPES
        )
        shapes = "".join(
            f'<shape type="ply" id="mesh-{n}"><string name="filename" value="meshes/{n}.ply"/>'
            f'<boolean name="face_normals" value="true"/><ref id="{n}" name="bsdf"/></shape>\n'
            for n in SHAPES
        )
        (self.folder / "hall.xml").write_text(f'<scene version="2.1.0">\n{materials}{shapes}</scene>\n')

    def write_materials(self, name, materials):
        """Writes a sidecar and returns its path. `materials`: fields of a radio material by the names of
        shapes; "walls" stands for all zones that have no entry of their own."""
        entries = {n: materials.get(n, materials.get("walls")) for n in SHAPES}
        path = self.folder / f"{name}.yaml"
        path.write_text("materials:\n" + "".join(f"  {n}: {json.dumps(v)}\n" for n, v in entries.items()))
        return path
