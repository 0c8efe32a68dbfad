# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes small glTF scenes, and asks greatx for the paths in them."""
import base64
import json
import pathlib

import numpy as np

import greatx

ASPHALT = {"itu": "asphalt_concrete"}
CONCRETE = {"itu": "concrete"}


def rectangle(origin, along, up):
    """Returns the two triangles [2, 3, 3] of the rectangle with a corner and two sides. Its front is
    along x up."""
    a = np.asarray(origin, float)
    b, d = a + along, a + up
    return np.array([[a, b, b + up], [a, b + up, d]])


def ground(half_side_m):
    """Returns the triangles of a square at z = 0 around the origin, front up."""
    side = 2.0 * half_side_m
    return rectangle([-half_side_m, -half_side_m, 0], np.array([side, 0, 0]), np.array([0, side, 0]))


def block(low, high):
    """Returns the triangles of a closed box with its faces outwards."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    x, y, z = np.diag(high - low)
    return np.concatenate(
        [
            rectangle(low, y, x),
            rectangle(low + z, x, y),
            rectangle(low, x, z),
            rectangle(low + y, z, x),
            rectangle(low, z, y),
            rectangle(low + x, y, z),
        ]
    )


def write_gltf(path, parts):
    """Writes a glTF file of parts (name, radio material, triangles [n, 3, 3] in the world's axes)."""
    blob = b""
    document = {key: [] for key in ("nodes", "meshes", "accessors", "bufferViews", "materials")}
    for i, (name, material, triangles) in enumerate(parts):
        # glTF has y up: x east, y up, -z north.
        points = np.asarray(triangles, float).reshape(-1, 3)[:, [0, 2, 1]] * [1, 1, -1]
        points = points.astype("<f4")
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(blob), "byteLength": points.nbytes})
        document["accessors"].append(
            {
                "bufferView": i,
                "componentType": 5126,
                "type": "VEC3",
                "count": len(points),
                "min": points.min(0).tolist(),
                "max": points.max(0).tolist(),
            }
        )
        document["materials"].append({"name": name, "extensions": {"GREATX_radio_material": material}})
        document["meshes"].append({"primitives": [{"attributes": {"POSITION": i}, "material": i}]})
        document["nodes"].append({"name": f"{name}_{i}", "mesh": i})
        blob += points.tobytes()
    document.update(
        asset={"version": "2.0"},
        extensionsUsed=["GREATX_radio_material"],
        buffers=[
            {
                "byteLength": len(blob),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(blob).decode(),
            }
        ],
        scene=0,
        scenes=[{"nodes": list(range(len(parts)))}],
    )
    pathlib.Path(path).write_text(json.dumps(document))


class World:
    """Holds a scene and its simulation. Effects that are not named are off, but for the line of sight and
    reflections, so that a result has one cause."""

    OFF = ("transmission", "finite_reflectors", "gas", "rain", "fog", "roughness")

    def __init__(self, folder, parts, **effects):
        file = pathlib.Path(folder) / "scene.gltf"
        write_gltf(file, parts)
        self.simulation = greatx.Simulation.from_scene(
            file, effects={**dict.fromkeys(self.OFF, "off"), **effects}
        )

    def channel(self, f_hz, transmitter, **fields):
        """Adds a channel from a point, or from several points [tx, 3], and returns its name."""
        number = len(self.simulation.channels)
        names = [
            self.simulation.place_transmitter(f"tx{number}_{i}", point)
            for i, point in enumerate(np.atleast_2d(transmitter))
        ]
        fields = {"subcarriers": 1, "subcarrier_spacing_hz": 1e3, **fields}
        return self.simulation.add_channel(
            f"channel{number}", transmitters=names, receivers=[], carrier_hz=float(f_hz), **fields
        )

    def paths(self, f_hz, transmitter, receivers, **fields):
        """Returns the greatx.Paths of such a channel to receivers [rx, 3]."""
        name = self.channel(f_hz, transmitter, **fields)
        return self.simulation.paths(name, receivers=np.asarray(receivers, float))


def field(paths, component=(0, 0)):
    """Returns the sum over the paths of each receiver, (lambda/4 pi) T exp(-j 2 pi f tau), complex128 [rx],
    for one component of T: (0, 0) vertical to vertical, (1, 1) horizontal to horizontal."""
    turns = paths.carrier_hz * paths["delay"] % 1.0
    terms = paths["transfer"][:, component[0], component[1]].astype(complex) * np.exp(-2j * np.pi * turns)
    total = np.zeros(paths.shape[0], complex)
    np.add.at(total, paths["rx"], terms)
    return total * 299792458.0 / paths.carrier_hz / (4 * np.pi)


def power(paths, keep=None):
    """Returns the sum of the powers of the paths of each receiver, vertical to vertical, float64 [rx]: the
    mean over the small-scale fading. `keep` selects paths."""
    scale = 299792458.0 / paths.carrier_hz / (4 * np.pi)
    terms = np.abs(paths["transfer"][:, 0, 0].astype(complex) * scale) ** 2
    if keep is not None:
        terms = np.where(keep, terms, 0.0)
    total = np.zeros(paths.shape[0])
    np.add.at(total, paths["rx"], terms)
    return total


def decibel(value):
    """Returns 10 lg of a power; nothing gives -inf without a warning."""
    with np.errstate(divide="ignore"):
        return 10 * np.log10(value)


def line_fit(x, y):
    """Returns slope, offset and the standard deviation of the residuals of y = offset + slope x."""
    slope, offset = np.polyfit(x, y, 1)
    return slope, offset, float(np.std(y - offset - slope * x))
