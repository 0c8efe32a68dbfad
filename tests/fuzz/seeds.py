# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the inputs that mutators begin with: small, sound inputs of every kind. The program accepts each of
them."""
from __future__ import annotations

import base64
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import time

from case import Case, Entry
import pictures

INFO = ["scene", "info", "scene.gltf"]


class Buffer:
    """Collects the binary data of a glTF file with its views and accessors."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def view(self, data: bytes, **fields) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **fields})
        self.data += data
        return len(self.views) - 1

    def accessor(self, form: str, component: int, type_: str, values: list, **fields) -> int:
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[type_]
        view = self.view(struct.pack(f"<{len(values)}{form}", *values))
        self.accessors.append(
            {
                "bufferView": view,
                "componentType": component,
                "count": len(values) // width,
                "type": type_,
                **fields,
            }
        )
        return len(self.accessors) - 1


def gltf_tree(buffer: Buffer, images: list[dict], buffer_uri: str | None) -> dict:
    """Returns two walls and a lamp, textured with a tangent-space normal map. Radio properties are given by
    name and by extension."""
    positions = [0, 0, 0, 4, 0, 0, 4, 3, 0, 0, 3, 0]
    corners = [0, 0, 1, 0, 1, 1, 0, 1]
    position = buffer.accessor("f", 5126, "VEC3", positions, min=[0, 0, 0], max=[4, 3, 0])
    normal = buffer.accessor("f", 5126, "VEC3", [0, 0, 1] * 4)
    tangent = buffer.accessor("f", 5126, "VEC4", [1, 0, 0, 1] * 4)
    uv = buffer.accessor("f", 5126, "VEC2", corners)
    indices = buffer.accessor("H", 5123, "SCALAR", [0, 1, 2, 0, 2, 3])
    bytes_ = buffer.accessor("B", 5121, "SCALAR", [2, 1, 0])
    sparse_indices = buffer.view(struct.pack("<2H", 1, 2))
    sparse_values = buffer.view(struct.pack("<6f", 4, 0, 1, 4, 3, 1))
    buffer.accessors.append(
        {
            "componentType": 5126,
            "count": 4,
            "type": "VEC3",
            "sparse": {
                "count": 2,
                "indices": {"bufferView": sparse_indices, "componentType": 5123},
                "values": {"bufferView": sparse_values},
            },
        }
    )
    sparse = len(buffer.accessors) - 1
    textures = [{"source": i, "sampler": 0} for i in range(len(images))]
    color = {"baseColorTexture": {"index": 0, "texCoord": 0}} if images else {}
    materials = [
        {
            "name": "itu_concrete",
            "doubleSided": True,
            "pbrMetallicRoughness": {**color, "metallicFactor": 0.1, "roughnessFactor": 0.8},
            **({"normalTexture": {"index": len(images) - 1, "scale": 0.5}} if images else {}),
        },
        {
            "name": "pane",
            "alphaMode": "MASK",
            "alphaCutoff": 0.5,
            "emissiveFactor": [0.1, 0.2, 0.3],
            "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.6, 0.7, 1]},
            "extensions": {
                "GREATX_radio_material": {
                    "layers": [
                        {"itu": "glass", "thickness_m": 0.006},
                        {"relative_permittivity": 1.0, "conductivity": 0.0, "thickness_m": 0.012},
                        {
                            "rows": [{"a": 6, "b": 0, "c": 0.01, "d": 1, "min_hz": 1e9, "max_hz": 1e11}],
                            "thickness_m": 0.006,
                        },
                    ],
                    "reflectance_905nm": 0.08,
                }
            },
        },
    ]
    plain = {
        "attributes": {"POSITION": position, "NORMAL": normal, "TANGENT": tangent, "TEXCOORD_0": uv},
        "indices": indices,
        "material": 0,
    }
    tree = {
        "asset": {"version": "2.0", "generator": "fuzz"},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {
                "name": "house",
                "children": [1],
                "translation": [1, 2, 3],
                "rotation": [0, 0.7071068, 0, 0.7071068],
                "scale": [1, 2, 1],
                "mesh": 0,
                "extras": {"greatx_class": "building"},
            },
            {"name": "pane", "mesh": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
            {"name": "lamp", "translation": [0, 4, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "meshes": [
            {"name": "wall", "primitives": [plain]},
            {
                "name": "panes",
                "primitives": [
                    {"attributes": {"POSITION": sparse}, "indices": indices, "material": 1},
                    {"attributes": {"POSITION": position}, "indices": bytes_, "material": 1, "mode": 4},
                ],
            },
        ],
        "materials": materials,
        "samplers": [{"wrapS": 10497, "wrapT": 33071}],
        "textures": textures,
        "images": images,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data), **({"uri": buffer_uri} if buffer_uri else {})}],
        "extensionsUsed": ["KHR_lights_punctual", "GREATX_radio_material"],
        "extensions": {
            "KHR_lights_punctual": {
                "lights": [
                    {
                        "type": "spot",
                        "color": [1, 0.9, 0.8],
                        "intensity": 100,
                        "range": 20,
                        "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5},
                    }
                ]
            }
        },
    }
    return {key: value for key, value in tree.items() if value != []}


RADIO = {
    "materials": {
        "pane": {
            "itu": "glass",
            "thickness_m": 0.01,
            "scattering_coefficient": 0.3,
            "pattern": "directive",
            "pattern_exponent": 4,
        },
        "itu_*": {"thickness_m": 0.3, "roughness_m": 0.001, "deviation_m": 0.003, "cross_polarization": 0.1},
        "facade": {
            "itu": "brick",
            "windows": {
                "share": 0.22,
                "layers": [
                    {"itu": "glass", "thickness_m": 0.006},
                    {"relative_permittivity": 1.0, "conductivity": 0.0, "thickness_m": 0.016},
                ],
            },
        },
        "leaves": {"foliage": {"attenuation_db_per_m": 1.5}},
        "*": {"relative_permittivity": 4.0, "conductivity": 0.02, "extrapolate": True},
    }
}


def gltf_files(images: list[tuple[str, bytes]]) -> dict[str, Entry]:
    buffer = Buffer()
    mime = {"png": "image/png", "jpg": "image/jpeg"}
    tree = gltf_tree(buffer, [{"uri": name, "mimeType": mime[name[-3:]]} for name, _ in images], "scene.bin")
    return {
        "scene.gltf": Entry(tree=tree, pack="json"),
        "scene.bin": Entry(data=buffer.data),
        **{name: Entry(data=data) for name, data in images},
    }


def gltf() -> list[Case]:
    textured = gltf_files([("color.png", pictures.png(8, 4)), ("normal.jpg", pictures.jpeg(1, 1))])
    embedded = Buffer()
    views = [embedded.view(pictures.png(4, 4, 4)), embedded.view(pictures.jpeg(2, 1, 1))]
    images = [
        {"bufferView": views[0], "mimeType": "image/png"},
        {"bufferView": views[1], "mimeType": "image/jpeg"},
    ]
    glb = Entry(tree=gltf_tree(embedded, images, None), pack="glb")
    glb.data = embedded.data
    inline = Buffer()
    uri = {"uri": "data:image/png;base64," + base64.b64encode(pictures.png(2, 2)).decode()}
    tree = gltf_tree(inline, [uri], "")
    tree["buffers"][0]["uri"] = (
        "data:application/octet-stream;base64," + base64.b64encode(inline.data).decode()
    )
    radio = {"radio.yaml": Entry(tree=RADIO, pack="yaml")}
    return [
        Case("gltf", INFO, textured),
        Case("gltf", ["scene", "info", "scene.glb"], {"scene.glb": glb}),
        Case(
            "gltf",
            INFO + ["--radio-materials", "radio.yaml"],
            {"scene.gltf": Entry(tree=tree, pack="json"), **radio},
        ),
        Case("gltf", INFO + ["--optical-only"], {"scene.gltf": Entry(tree=tree, pack="json")}),
    ]


def picture() -> list[Case]:
    drawn = [
        ("a.png", pictures.png(9, 7, 4, interlaced=True)),
        ("a.png", pictures.png(5, 3, 1, 16)),
        ("a.png", pictures.png_palette(6, 4)),
        ("a.png", pictures.png(3, 3, 2)),
        ("a.jpg", pictures.jpeg(2, 2)),
        ("a.jpg", pictures.jpeg(3, 1, 1)),
        ("a.jpg", pictures.jpeg(2, 1, progressive=True)),
        ("a.jpg", pictures.jpeg(1, 2, 1, progressive=True)),
    ]
    return [Case("picture", INFO, gltf_files([image])) for image in drawn]


PLY_HEAD = (
    "ply\nformat {} 1.0\ncomment a wall\nelement vertex 4\n"
    "property float x\nproperty float y\nproperty float z\n"
    "property float s\nproperty float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
)


def plys() -> list[Entry]:
    points = [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)]
    faces = [(0, 1, 2), (0, 2, 3)]
    text = PLY_HEAD.format("ascii") + "".join(f"{x} {y} {z} 0.5 1e-3\n" for x, y, z in points)
    entries = [Entry(data=(text + "".join(f"3 {a} {b} {c}\n" for a, b, c in faces)).encode())]
    for order, name in (("<", "binary_little_endian"), (">", "binary_big_endian")):
        data = PLY_HEAD.format(name).encode() + b"".join(
            struct.pack(f"{order}5f", *p, 0.5, 0.25) for p in points
        )
        entries.append(Entry(data=data + b"".join(struct.pack(f"{order}B3i", 3, *f) for f in faces)))
    return entries


XML = """<scene version="2.1.0">
<default name="spp" value="16"/>
<integrator type="path"><integer name="max_depth" value="12"/></integrator>
<bsdf type="twosided" id="mat-itu_concrete">\
<bsdf type="diffuse"><rgb value="0.5 0.25 0.125" name="reflectance"/></bsdf></bsdf>
<bsdf type="itu-radio-material" id="glass">\
<string name="type" value="glass"/><float name="thickness" value="0.02"/>
<float name="scattering_coefficient" value="0.2"/><rgb name="color" value="0.3, 0.4, 0.5"/></bsdf>
<bsdf type="radio-material" id="foam">\
<float name="relative_permittivity" value="1.2"/><float name="conductivity" value="1e-3"/></bsdf>
<emitter type="constant" id="World"><rgb value="1 1 1" name="radiance"/></emitter>
<shape type="ply" id="mesh-wall"><string name="filename" value="meshes/wall.ply"/>\
<boolean name="face_normals" value="true"/>
<ref id="mat-itu_concrete" name="bsdf"/>
<transform name="to_world">\
<rotate z="1" angle="30"/><scale value="2"/><translate x="1" y="2" z="3"/></transform></shape>
<shape type="merge"><shape type="ply" id="mesh-pane">\
<string name="filename" value="meshes/pane.ply"/><ref id="glass" name="bsdf"/>
<transform name="to_world"><matrix value="1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1"/></transform></shape></shape>
<shape type="ply" id="mesh-foam">\
<string name="filename" value="meshes/foam.ply"/><ref id="foam" name="bsdf"/></shape>
</scene>
"""


def mitsuba() -> list[Case]:
    wall, pane, foam = plys()
    files = {
        "scene.xml": Entry(data=XML.encode()),
        "meshes/wall.ply": wall,
        "meshes/pane.ply": pane,
        "meshes/foam.ply": foam,
    }
    plain = ["scene", "import", "scene.xml", "-o", "out/scene.glb"]
    return [
        Case("mitsuba", plain, files),
        Case("mitsuba", plain + ["--radio-materials", "out/radio.yaml", "--thickness", "0.2"], files),
    ]


def waypoints(csv: str) -> dict:
    return {"name": "uav", "trajectory": {"type": "waypoints", "csv": csv, "interpolation": "smooth"}}


def pattern(complex_: bool) -> str:
    lines = ["theta_deg,phi_deg," + ("f_theta_re,f_theta_im,f_phi_re,f_phi_im" if complex_ else "gain_dbi")]
    for theta in range(0, 181, 60):
        for phi in range(-180, 180, 90):
            gain = 1.5 if 0 < theta < 180 else 0.5
            lines.append(f"{theta},{phi}," + (f"{gain},0.1,0,0" if complex_ else f"{gain}"))
    return "\n".join(lines) + "\n"


def cuts() -> str:
    """Returns an antenna pattern in the format of MSI Planet."""
    lines = ["NAME antenna", "FREQUENCY 2100", "GAIN 8.5 dBi", "TILT ELECTRICAL"]
    for name in ("HORIZONTAL", "VERTICAL"):
        lines.append(f"{name} 8")
        lines += [f"{45 * i}.0\t{min(i, 8 - i) * 5}.0" for i in range(8)]
    return "\n".join(lines) + "\n"


def far_field() -> str:
    """Returns an antenna pattern as HFSS exports it."""
    lines = ["0 180 5", "-180 180 5", "Frequencies 1", "Frequency 3.5e9"]
    for theta in range(5):
        lines += [f"{1 if theta % 4 else 0.5} 0.1 0 {0.2 if theta % 4 else 0}"] * 5
    return "\n".join(lines) + "\n"


def csv() -> list[Case]:
    flight = (
        "# a flight\nt_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg\n"
        "0,0,0,10,0,0,0\n0.5,5,0,12,0,-10,0\n1,10,2,12.5,5,-5,1\n"
    )
    plain = "0,0,0,10\n0.5,5,0,12\n1.0,10,2,12.5\n"
    shots = (
        "t_s,azimuth_deg,elevation_deg,channel\n"
        "0,10,-5,0\n0,10,5,1\n# a turn\n0.001,9.5,-5,0\n0.001,9.5,5,1\n"
    )
    points = "# street level\nx_m,y_m,z_m\n0,0,1.5\n-20,-4,1.5\n"

    def scenario(trajectory: str, pattern_: str, shots_: str) -> Entry:
        return Entry(
            tree={
                "greatx": 1,
                "name": "tables",
                "ticks": 2,
                "tick_rate_hz": 10,
                "nodes": [
                    {
                        "name": "bs",
                        "trajectory": {"type": "static", "position_m": [0, 0, 30]},
                        "sensors": [{"name": "panel", "type": "antenna", "pattern_file": pattern_}],
                    },
                    {
                        **waypoints(trajectory),
                        "sensors": [
                            {"name": "antenna", "type": "antenna"},
                            {"name": "lidar", "type": "lidar", "rate_hz": 10, "shots_file": shots_},
                        ],
                    },
                ],
                "channels": [
                    {"name": "csi", "tx": "bs/panel", "rx": ["uav/antenna"], "rate_hz": 10, "subcarriers": 4}
                ],
            },
            pack="yaml",
        )

    files = {
        "flight.csv": Entry(data=flight.encode()),
        "plain.csv": Entry(data=plain.encode()),
        "gain.csv": Entry(data=pattern(False).encode()),
        "field.csv": Entry(data=pattern(True).encode()),
        "cuts.msi": Entry(data=cuts().encode()),
        "far.ffd": Entry(data=far_field().encode()),
        "shots.csv": Entry(data=shots.encode()),
        "points.csv": Entry(data=points.encode()),
    }

    def pick(*names: str) -> dict[str, Entry]:
        return {name: files[name] for name in names}

    return [
        Case(
            "csv",
            ["explain", "tables.yaml"],
            {
                "tables.yaml": scenario("flight.csv", "gain.csv", "shots.csv"),
                **pick("flight.csv", "gain.csv", "shots.csv"),
            },
        ),
        Case(
            "csv",
            ["explain", "tables.yaml"],
            {
                "tables.yaml": scenario("plain.csv", "field.csv", "shots.csv"),
                **pick("plain.csv", "field.csv", "shots.csv"),
            },
        ),
        Case(
            "csv",
            ["paths", "tables.yaml", "--brief", "--receivers", "points.csv"],
            {
                "tables.yaml": scenario("plain.csv", "gain.csv", "shots.csv"),
                **pick("plain.csv", "gain.csv", "shots.csv", "points.csv"),
            },
        ),
        Case(
            "csv",
            ["explain", "tables.yaml"],
            {
                "tables.yaml": scenario("plain.csv", "cuts.msi", "shots.csv"),
                **pick("plain.csv", "cuts.msi", "shots.csv"),
            },
        ),
        Case(
            "csv",
            ["explain", "tables.yaml"],
            {
                "tables.yaml": scenario("plain.csv", "far.ffd", "shots.csv"),
                **pick("plain.csv", "far.ffd", "shots.csv"),
            },
        ),
    ]


def sensors() -> list[dict]:
    """Returns sensors as small as possible that have every output."""
    return [
        {
            "name": "cam",
            "type": "camera",
            "rate_hz": 10,
            "width": 16,
            "height": 12,
            "fov_deg": 80,
            "mount": {"rotation_deg": [0, 20, 0]},
            "outputs": [
                "rgb",
                "depth",
                "ids",
                "hdr",
                "depth_png24",
                "depth_log",
                "depth_ray",
                "normals",
                "flow",
                "boxes",
            ],
        },
        {
            "name": "events",
            "type": "event_camera",
            "rate_hz": 10,
            "width": 16,
            "height": 12,
            "fov_deg": 80,
            "steps": 1,
            "mount": {"rotation_deg": [0, 20, 0]},
            "outputs": ["events", "differences", "instance", "hdf5", "text"],
        },
        {
            "name": "lidar",
            "type": "lidar",
            "rate_hz": 10,
            "channels": 4,
            "elevation_min_deg": -40,
            "elevation_max_deg": -10,
            "azimuth_steps": 12,
            "outputs": ["points", "ply", "pcd", "kitti"],
        },
        {
            "name": "radar",
            "type": "radar",
            "rate_hz": 10,
            "waveform": {"samples": 16, "chirps": 4, "carrier_hz": 77e9},
            "transmit": {"columns": 1},
            "receive": {"columns": 2},
            "echoes": {"tubes": 256, "max_bounces": 1},
            "processing": {"azimuths": 5, "cfar": {"guard": [1, 0], "train": [2, 1]}},
        },
        {"name": "antenna", "type": "antenna"},
    ]


def data_scenario(ticks: int) -> dict:
    return {
        "greatx": 1,
        "name": "tiny",
        "seed": 3,
        "sequences": 2,
        "ticks": ticks,
        "tick_rate_hz": 10,
        "scene": {"file": "scene.gltf"},
        "environment": {"clouds": 0},
        "nodes": [
            {
                "name": "bs",
                "trajectory": {"type": "static", "position_m": [3, 8, 12]},
                "sensors": [{"name": "panel", "type": "antenna", "columns": 2}],
            },
            {
                "name": "uav",
                "trajectory": {
                    "type": "waypoints",
                    "points": [{"t_s": 0, "position_m": [-9, 0, 6]}, {"t_s": 1, "position_m": [-6, 1, 6]}],
                },
                "sensors": sensors(),
            },
        ],
        "channels": [
            {
                "name": "csi",
                "tx": "bs/panel",
                "rx": ["uav/antenna"],
                "rate_hz": 10,
                "subcarriers": 4,
                "max_depth": 1,
                "taps": {"count": 4},
                "power_dbm": 20,
            }
        ],
    }


def scene_with_bottom() -> dict[str, Entry]:
    """Returns the walls of gltf_files, of which every sensor sees a part."""
    return gltf_files([("color.png", pictures.png(8, 4))])


def scenario() -> list[Case]:
    data = {"data.yaml": Entry(tree=data_scenario(2), pack="yaml"), **scene_with_bottom()}
    moving = {
        "greatx": 1,
        "name": "moves",
        "duration_s": 2,
        "tick_rate_hz": "30000/1001",
        "scene": {
            "generate": {"kind": "room"},
            "objects": [
                {
                    "name": "van",
                    "generate": {"kind": "car", "variant": "van"},
                    "position_m": [1, 1, 0],
                    "scale": 0.2,
                    "class": "vehicle",
                }
            ],
            "origin_m": [0, 0, 0],
        },
        "environment": {
            "place": {"latitude_deg": 48.1, "longitude_deg": 11.5},
            "time": "2026-06-21T12:00:00+02:00",
            "temperature_k": 290,
            "pressure_hpa": 1000,
            "rain_mm_h": 5,
            "fog_g_m3": 0.05,
        },
        "nodes": [
            {
                "name": "bs",
                "trajectory": {"type": "static", "position_m": [0.5, 0.5, 2], "rotation_deg": [45, 10, 0]},
                "sensors": [
                    {
                        "name": "panel",
                        "type": "antenna",
                        "pattern": "tr38901",
                        "polarization": "slant",
                        "rows": 2,
                        "row_spacing_wl": 0.7,
                        "mount": {"rotation_deg": [0, 5, 0]},
                    }
                ],
            },
            {
                "name": "uav",
                "trajectory": {
                    "type": "bezier",
                    "box": {"min_m": [-1, -1, 1], "max_m": [1, 1, 2]},
                    "distance": {"node": "bs", "min_m": 0, "max_m": 5},
                    "offset_m": [0.1, 0.1, 0.1],
                },
                "model": {
                    "generate": {"kind": "quadrotor", "variant": "small"},
                    "parts": [
                        {"nodes": ["rotor_0", "rotor_2"], "rpm": 5400},
                        {"nodes": "rotor_[13]", "axis": [0, 0, 2], "rate_hz": "-1000/7"},
                    ],
                },
                "sensors": [{"name": "free", "type": "antenna", "elements_wl": [[0, 0, 0], [0.5, 0, 0.25]]}],
            },
            {
                "name": "bus",
                "trajectory": {
                    "type": "corridor",
                    "center_line_m": [[0, 0, 1], [1, 0, 1], [1, 1, 1]],
                    "width_m": 0.2,
                    "height_m": 0,
                    "legs": 4,
                },
            },
        ],
        "channels": [
            {
                "name": "csi",
                "tx": "bs/panel",
                "rx": ["uav/free"],
                "rate_hz": 5,
                "carrier_hz": 28e9,
                "bandwidth_hz": 100e6,
                "subcarriers": 8,
                "time_samples": 2,
                "time_spacing_s": 1e-4,
                "max_depth": 2,
                "search": "once",
                "outputs": ["cfr", "paths", "coherence"],
                "taps": {"count": 4, "first": -1, "bandwidth_hz": 50e6},
                "power_dbm": 23,
                "resistance_ohm": 73,
            }
        ],
        "effects": {"gas": "on", "rain": "auto", "scattering": "off"},
        "tolerance_db": 0.05,
    }
    empty = {
        "greatx": 1,
        "name": "empty",
        "ticks": 3,
        "tick_rate_hz": 10,
        "nodes": [
            {
                "name": "a",
                "trajectory": {"type": "static", "position_m": [0, 0, 1]},
                "sensors": [{"name": "x", "type": "antenna"}],
            },
            {
                "name": "b",
                "trajectory": {"type": "static", "position_m": [9, 0, 1]},
                "sensors": [{"name": "x", "type": "antenna"}],
            },
        ],
        "channels": [
            {"name": "csi", "tx": "a/x", "rx": ["b/x"], "rate_hz": 10, "subcarriers": 4, "max_depth": 1}
        ],
    }
    return [
        Case("scenario", ["explain", "data.yaml"], data),
        Case("scenario", ["explain", "moves.yaml"], {"moves.yaml": Entry(tree=moving, pack="yaml")}),
        Case("scenario", ["explain", "empty.yaml", "--json"], {"empty.yaml": Entry(tree=empty, pack="yaml")}),
        Case("scenario", ["paths", "empty.yaml", "--brief"], {"empty.yaml": Entry(tree=empty, pack="yaml")}),
        Case(
            "scenario",
            INFO + ["--radio-materials", "radio.yaml"],
            {"radio.yaml": Entry(tree=RADIO, pack="yaml"), **scene_with_bottom()},
        ),
        Case(
            "scenario",
            INFO + ["--radio-materials", "radio.yaml"],
            {"radio.yaml": Entry(tree=RADIO, pack="yaml"), **scene_with_bottom()},
        ),
    ]


def read_folder(folder: pathlib.Path, name: str) -> dict[str, Entry]:
    files = {}
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            files[f"{name}/{file.relative_to(folder)}"] = Entry(data=file.read_bytes())
    return files


def interrupt(program: str, folder: pathlib.Path, env: dict) -> None:
    """Leaves `cut`: one finished sequence and the first packets of another, as after Ctrl-C. The time of the
    signal is random, so the journal is shortened to the part that always exists."""
    journal, whole, kept = folder / "cut/journal.txt", 12 + 1, 12 + 1 + 3
    process = subprocess.Popen(
        [program, "generate", "long.yaml", "-o", "cut", "-q"], cwd=folder, env=env, stderr=subprocess.DEVNULL
    )
    while process.poll() is None:
        if journal.is_file() and journal.read_bytes().count(b"\n") >= kept:
            process.send_signal(signal.SIGINT)
            break
        time.sleep(0.001)
    process.wait()
    lines = journal.read_bytes().splitlines(keepends=True) if journal.is_file() else []
    if len(lines) < kept or b'"end"' not in lines[whole - 1]:
        raise RuntimeError(
            f"the unfinished seed of kind dataset: exit {process.returncode}, {len(lines)} packets"
        )
    journal.write_bytes(b"".join(lines[:kept]))
    for file in folder.glob("cut/sequence_0001/**/0*.*"):
        if file.stem.isdigit() and int(file.stem) >= kept - whole:
            file.unlink()


def dataset(program: str, folder: pathlib.Path, env: dict) -> list[Case]:
    """Returns cases of a finished data set and of an interrupted one, which `--resume` can continue."""
    Case(
        "",
        [],
        {
            "data.yaml": Entry(tree=data_scenario(2), pack="yaml"),
            "long.yaml": Entry(tree=data_scenario(12), pack="yaml"),
            **scene_with_bottom(),
        },
    ).lay_out(folder, folder)
    arguments = {"cwd": folder, "env": env, "capture_output": True, "text": True, "check": False}
    for name, compression in (("data", "none"), ("packed", "small")):
        command = [program, "generate", "data.yaml", "-o", name, "--compression", compression, "-q"]
        run = subprocess.run(command, **arguments)
        if run.returncode != 0:
            raise RuntimeError(
                f"the seed of kind dataset: greatx generate ends with {run.returncode}: {run.stderr}"
            )

    interrupt(program, folder, env)
    scene = {
        name: Entry(data=(folder / name).read_bytes()) for name in ("scene.gltf", "scene.bin", "color.png")
    }
    whole, packed = read_folder(folder / "data", "data"), read_folder(folder / "packed", "data")
    cut = {
        **read_folder(folder / "cut", "data"),
        "long.yaml": Entry(data=(folder / "long.yaml").read_bytes()),
        **scene,
    }
    shutil.rmtree(folder)
    os.makedirs(folder)
    sheet = ["--picture", "out/sheet.png"]
    resume = ["generate", "long.yaml", "-o", "data", "--resume", "-q"]
    return (
        [Case("dataset", ["verify", "data"], whole)] * 5
        + [Case("dataset", ["verify", "data"], packed)] * 4
        + [Case("dataset", ["inspect", "data", *sheet], packed)] * 2
        + [
            Case("dataset", ["verify", "data", "--json"], whole),
            Case("dataset", ["inspect", "data", "--json", *sheet], whole),
        ]
        + [Case("dataset", ["inspect", "data", *sheet], whole)] * 3
        + [Case("dataset", ["inspect", "data", *sheet, "--animation", "out/a.webp", "--frames", "2"], whole)]
        * 2
        + [
            Case("dataset", ["inspect", "data", *sheet, "--html", "out/r.html"], files)
            for files in (whole, packed)
        ]
        * 2
        + [Case("dataset", resume, cut, keeps_files=False)] * 3
    )


MAKERS = {"gltf": gltf, "picture": picture, "scenario": scenario, "mitsuba": mitsuba, "csv": csv}
KINDS = ["dataset", "gltf", "picture", "scenario", "mitsuba", "ply", "csv", "python"]


def seeds_of(kind: str, program: str, folder: pathlib.Path, env: dict) -> list[Case]:
    if kind == "dataset":
        return dataset(program, folder, env)
    if kind == "python":
        made = dataset(program, folder, env)
        return [
            Case("python", ["data"], made[0].files),
            Case("python", ["data"], made[5].files),
            Case("python", ["data", "incomplete"], made[-1].files),
        ]
    if kind == "ply":
        cases = mitsuba()
        for case in cases:
            case.kind = "ply"
        return cases
    return MAKERS[kind]()
