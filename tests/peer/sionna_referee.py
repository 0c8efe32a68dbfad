# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Decides whether a specular path exists, by the image method and all triangles of the scene's own PLY files
in fp64. It shares nothing with greatx, not even the imported file, nor with Sionna RT."""
import pathlib
import xml.etree.ElementTree as ElementTree

import numpy as np

from model import ITU, fresnel, passed, permittivity, transfer  # noqa: F401 (transfer: for who imports this)

TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
}


def read_ply(file):
    """Returns the corners of the triangles [n, 3, 3] of a binary little-endian PLY file. All scenes of Sionna
    RT have this form."""
    data = pathlib.Path(file).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode().split("\n")
    assert "format binary_little_endian 1.0" in header
    counts, fields, at = {}, [], None
    for word in (line.split() for line in header):
        if word[:1] == ["element"]:
            at = word[1]
            counts[at] = int(word[2])
        elif word[:1] == ["property"] and at == "vertex":
            fields.append((word[2], "<" + TYPES[word[1]]))
    vertices = np.frombuffer(data, np.dtype(fields), counts["vertex"], end)
    start = end + counts["vertex"] * vertices.dtype.itemsize
    faces = np.frombuffer(data, np.dtype([("n", "u1"), ("i", "<i4", 3)]), counts["face"], start)
    assert (faces["n"] == 3).all()
    corners = np.stack([vertices[axis].astype(float) for axis in "xyz"], -1)
    return corners[faces["i"]]


class Referee:
    #: Largest distance of a claimed point from the surface that it names, m (fp32 at some hundred metres).
    tolerance = 5e-3

    def __init__(self, xml):
        xml = pathlib.Path(xml)
        root = ElementTree.parse(xml).getroot()
        self.itu = {
            b.get("id"): (
                b.find("string[@name='type']").get("value"),
                float(b.find("float[@name='thickness']").get("value")),
            )
            for b in root.findall("bsdf")
        }
        triangles, materials = [], []
        for shape in root.iter("shape"):
            name = shape.find("string[@name='filename']")
            if name is None:
                continue
            corners = read_ply(xml.parent / name.get("value"))
            triangles.append(corners)
            materials += [shape.find("ref").get("id")] * len(corners)
        self.triangles = np.concatenate(triangles)
        self.materials = np.array(materials)
        a, b, c = (self.triangles[:, i] for i in range(3))
        cross = np.cross(b - a, c - a)
        size = np.linalg.norm(cross, axis=1)
        keep = size > 0
        self.triangles, self.materials = self.triangles[keep], self.materials[keep]
        self.normals = cross[keep] / size[keep, None]
        self.offsets = np.einsum("ij,ij->i", self.normals, self.triangles[:, 0])
        self.edges = self._outlines()

    def _outlines(self):
        """Returns the edges [m, 2, 3] that do not lie between two triangles of one plane."""
        edges = {}
        for t, corners in enumerate(self.triangles):
            keys = [tuple(np.round(corner, 4)) for corner in corners]
            for i in range(3):
                edges.setdefault(tuple(sorted((keys[i], keys[(i + 1) % 3]))), []).append((t, i))
        out = []
        for users in edges.values():
            t, i = users[0]
            flat = len(users) == 2 and abs(self.normals[users[0][0]] @ self.normals[users[1][0]]) > 1 - 1e-7
            if not flat:
                out.append(self.triangles[t][[i, (i + 1) % 3]])
        return np.array(out)

    def distance_to_triangles(self, point):
        """Returns the distance in m to each triangle's plane, and how far outside the triangle the point lies
        (0: inside)."""
        height = self.normals @ point - self.offsets
        foot = point - height[:, None] * self.normals
        outside = np.zeros(len(height))
        for i in range(3):
            p, q = self.triangles[:, i], self.triangles[:, (i + 1) % 3]
            inward = np.cross(self.normals, q - p)
            inward /= np.linalg.norm(inward, axis=1, keepdims=True)
            outside = np.maximum(outside, -np.einsum("ij,ij->i", inward, foot - p))
        return np.abs(height), outside

    def crossings(self, a, b):
        """Returns (t, triangle) of all triangles that the segment crosses, 0 < t < 1, in order."""
        d = b - a
        slope = self.normals @ d
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (self.offsets - self.normals @ a) / slope
        near = np.flatnonzero((t > 0) & (t < 1))
        point = a + t[near, None] * d
        inside = np.ones(len(near), bool)
        for i in range(3):
            p, q = self.triangles[near, i], self.triangles[near, (i + 1) % 3]
            inside &= np.einsum("ij,ij->i", np.cross(self.normals[near], q - p), point - p) >= 0
        hit = near[inside]
        return sorted(zip(t[hit], hit))

    def edge_distance(self, a, b):
        """Returns the distance in m from the segment to the nearest outline."""
        p, q = self.edges[:, 0], self.edges[:, 1]
        u, v, w = b - a, q - p, a - p
        uu, uv, vv = u @ u, v @ u, np.einsum("ij,ij->i", v, v)
        uw, vw = w @ u, np.einsum("ij,ij->i", v, w)
        det = uu * vv - uv * uv
        with np.errstate(divide="ignore", invalid="ignore"):
            s = np.clip(np.where(det > 1e-12 * uu * vv, (uv * vw - vv * uw) / det, 0.0), 0, 1)
            t = np.clip((vw + s * uv) / vv, 0, 1)
            s = np.clip((t * uv - uw) / uu, 0, 1)
        return np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1).min()

    def planes_at(self, point, before, after):
        """Returns the triangle that reflects at a claimed point: it is near the point and across the
        bisector."""
        height, outside = self.distance_to_triangles(point)
        near = np.flatnonzero((height < self.tolerance) & (outside < 0.1))
        if len(near) == 0:
            return None
        bisector = after / np.linalg.norm(after) - before / np.linalg.norm(before)
        size = np.linalg.norm(bisector)
        aligned = np.abs(self.normals[near] @ bisector) / size if size > 1e-6 else np.ones(len(near))
        best = aligned > aligned.max() - 1e-6
        return near[best][np.argmin(outside[near[best]])]

    def judge(self, path):
        """Returns a dictionary: exists, why, edge_mm (distance of the exact path from the nearest outline),
        length (exact)."""
        turning = [i for i, k in enumerate(path.kinds) if k != "T"]
        if any(path.kinds[i] != "R" for i in turning):
            return {"exists": None, "why": "not specular"}
        corners = np.vstack([path.points[:1], path.points[1:-1][turning], path.points[-1:]])
        faces = []
        for i in range(1, len(corners) - 1):
            face = self.planes_at(corners[i], corners[i] - corners[i - 1], corners[i + 1] - corners[i])
            if face is None:
                return {"exists": False, "why": "a reflection where there is no surface"}
            faces.append(face)
        exact = self.unfold(corners[0], corners[-1], faces)
        if exact is None:
            return {"exists": False, "why": "an end on the wrong side of its mirror"}
        return self.judge_exact(exact, faces, path)

    def unfold(self, a, b, faces):
        images = [a]
        for f in faces:
            images.append(images[-1] - 2 * (self.normals[f] @ images[-1] - self.offsets[f]) * self.normals[f])
        points = [b]
        for f, image in zip(reversed(faces), reversed(images[1:])):
            d0, d1 = (self.normals[f] @ x - self.offsets[f] for x in (image, points[0]))
            if d0 * d1 >= 0:
                return None
            points.insert(0, image + d0 / (d0 - d1) * (points[0] - image))
        return np.array([a, *points])

    def judge_exact(self, corners, faces, path):
        answer = {"length": np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()}
        answer["edge_mm"] = 1e3 * min(self.edge_distance(p, q) for p, q in zip(corners, corners[1:]))
        for corner, face in zip(corners[1:], faces):
            height, outside = self.distance_to_triangles(corner)
            same = (height < 1e-4) & (np.abs(self.normals @ self.normals[face]) > 1 - 1e-6)
            if not same.any() or outside[same].min() > 1e-6:
                gap = outside[same].min() * 1e3 if same.any() else np.inf
                return answer | {"exists": False, "why": f"a reflection {gap:.3f} mm outside of its facet"}
        walls, at = [], 0
        for i, (p, q) in enumerate(zip(corners, corners[1:])):
            passed_here = len(path.kinds[at:].split("R")[0])
            own = [self.normals[f] for f in faces[max(0, i - 1) : i + 1]]
            found = self.distinct(p, q, own)
            if len(found) != passed_here:
                return answer | {
                    "exists": False,
                    "why": f"segment {i + 1} crosses {len(found)} surfaces where "
                    f"{passed_here} are claimed",
                    "crossed": len(found) - passed_here,
                }
            walls += found
            at += passed_here + 1
        return answer | {"exists": True, "why": "", "walls": walls, "corners": corners, "faces": faces}

    def distinct(self, p, q, own):
        """Returns the surfaces crossed. Triangles that meet at a seam count as one, and those of the mirrors
        at the ends do not count."""
        length = np.linalg.norm(q - p)
        out = []
        for t, face in self.crossings(p, q):
            at_end = min(t, 1 - t) * length < 1e-4 * (1 + 1e-2 * length)
            if at_end and any(abs(n @ self.normals[face]) > 1 - 1e-6 for n in own):
                continue
            if (
                out
                and (t - out[-1][0]) * length < 1e-6
                and abs(self.normals[face] @ self.normals[out[-1][1]]) > 1 - 1e-6
                and self._seam(face, out[-1][1])
            ):
                continue
            out.append((t, face))
        return out

    def _seam(self, a, b):
        """Returns whether two triangles share an edge, and so are one surface for a ray that passes there."""
        shared = sum(any(np.abs(p - q).max() < 1e-6 for q in self.triangles[b]) for p in self.triangles[a])
        return shared == 2

    def field(self, path, verdict, case):
        """Returns (lambda / 4 pi) T [2, 2] of a path that exists, by the peer checks' model of P.2040
        slabs."""
        points, walls, types, normals = [verdict["corners"][0]], [], [], []
        crossed = list(verdict["walls"])
        mirrors = list(verdict["faces"])
        corner = 1
        for kind in path.kinds:
            face = crossed.pop(0)[1] if kind == "T" else mirrors.pop(0)
            itu, thickness = self.itu[self.materials[face]]
            walls.append([(1.0, [(permittivity(itu, case.carrier_hz), thickness)])])
            types.append(2 if kind == "T" else 1)
            normals.append(self.normals[face])
            if kind == "T":
                points.append(self._foot(points[-1], verdict["corners"][corner], face))
            else:
                points.append(verdict["corners"][corner])
                corner += 1
        points.append(verdict["corners"][-1])
        t = transfer(
            np.array(points), np.array(types, int), walls, np.array(normals).reshape(-1, 3), case.wavelength
        )
        return case.wavelength / (4 * np.pi) * t

    def slab_phase(self, path, verdict, case):
        """Returns k d cos(theta) in rad, summed over the walls passed. This is the way through the walls,
        which the path's length already contains."""
        total, at = 0.0, 0
        segments = np.diff(verdict["corners"], axis=0)
        crossed = list(verdict["walls"])
        for kind in path.kinds:
            if kind != "T":
                at += 1
                continue
            face = crossed.pop(0)[1]
            cosine = abs(self.normals[face] @ segments[at]) / np.linalg.norm(segments[at])
            total += 2 * np.pi / case.wavelength * self.itu[self.materials[face]][1] * cosine
        return total

    def _foot(self, a, b, face):
        d0, d1 = (self.normals[face] @ x - self.offsets[face] for x in (a, b))
        return a + d0 / (d0 - d1) * (b - a)

    def draw_receivers(self, case):
        """Draws positions in the case's box that have nothing above them. In a closed scene any position will
        do."""
        random = np.random.default_rng(case.seed)
        out = []
        for _ in range(100000):
            if len(out) == case.count:
                break
            # Both tools get the same positions: whole millimetres, rounded to float.
            p = np.float32(np.round(random.uniform(case.low, case.high), 3)).astype(float)
            if case.scene in ("box", "simple_wedge") or not self.crossings(p, p + [0, 0, 500.0]):
                out.append(p)
        return np.array(out)
