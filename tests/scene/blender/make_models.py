# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Models a drone and a small car in Blender and writes them as glTF, as docs/models.md describes.

    blender -b --factory-startup --python tests/scene/blender/make_models.py -- FOLDER

writes drone.glb and car.glb into FOLDER. The files beside this script were written by Blender 3.4.1 (Debian
12: blender, python3-numpy). This script is not part of ./test.sh; test_scene_blender loads the files.

Lengths are metres, x is forward, y left, z up. Everything is made of closed bodies. Rotors and wheels are
objects of their own, with their origin on their axis.
"""

import math
import sys

import bmesh
import bpy
from mathutils import Matrix, Vector

# ---- Materials --------------------------------------------------------------------------------------------


# Table 3 of P.2040-4 has acrylic from 110 GHz on; its permittivity hardly depends on the frequency.
ACRYLIC = "relative_permittivity: 2.58, conductivity: 0.001, thickness_m: 0.003"


def material(name, color, roughness, metallic=0.0, radio=None, emission=None):
    """Makes a material. `radio` becomes the custom property greatx_radio: a text of YAML, or a dictionary."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    if emission is not None:
        shader.inputs["Emission"].default_value = (*emission, 1.0)
    if radio is not None:
        made["greatx_radio"] = radio
    return made


# ---- Meshes -----------------------------------------------------------------------------------------------


class Builder:
    """Collects closed bodies with their materials and makes an object of them."""

    def __init__(self):
        self.mesh = bmesh.new()
        self.materials = []

    def index(self, made):
        if made not in self.materials:
            self.materials.append(made)
        return self.materials.index(made)

    def loft(self, made, rings, closed=False):
        """Joins rings of points, each a list of Vectors of equal length. The ends get caps, unless
        `closed`, when the last ring joins the first one. Rings turn counter-clockwise about the direction of
        the loft."""
        index = self.index(made)
        rows = [[self.mesh.verts.new(p) for p in ring] for ring in rings]
        n = len(rows[0])
        pairs = list(zip(rows, rows[1:])) + ([(rows[-1], rows[0])] if closed else [])
        for low, high in pairs:
            for i in range(n):
                j = (i + 1) % n
                self.face([low[i], low[j], high[j], high[i]], index)
        if not closed:
            self.face(rows[0][::-1], index)
            self.face(rows[-1], index)

    def face(self, corners, index):
        made = self.mesh.faces.new(corners)
        made.material_index = index
        made.smooth = True

    def box(self, made, low, high, bevel=0.0, segments=1):
        """A box with rounded edges."""
        index = self.index(made)
        part = bmesh.new()
        bmesh.ops.create_cube(part, size=1.0)
        low, high = Vector(low), Vector(high)
        for corner in part.verts:
            corner.co = (low + high) / 2 + Vector(c * s for c, s in zip(corner.co, high - low))
        if bevel > 0.0:
            bmesh.ops.bevel(
                part,
                geom=part.edges[:],
                offset=bevel,
                segments=segments,
                profile=0.5,
                affect="EDGES",
                clamp_overlap=True,
            )
        self.append(part, index)

    def lathe(self, made, profile, sides, matrix=Matrix()):
        """Turns (radius, height) points, from bottom to top, about z. Both ends get flat caps."""
        rings = []
        for radius, height in profile:
            ring = []
            for i in range(sides):
                angle = 2 * math.pi * i / sides
                ring.append(matrix @ Vector((radius * math.cos(angle), radius * math.sin(angle), height)))
            rings.append(ring)
        self.loft(made, rings)

    def append(self, part, index):
        """Adds another mesh."""
        for f in part.faces:
            f.material_index = index
            f.smooth = True
        mesh = bpy.data.meshes.new("part")
        part.to_mesh(mesh)
        part.free()
        self.mesh.from_mesh(mesh)
        bpy.data.meshes.remove(mesh)

    def object(self, name, semantic_class=None, origin=(0, 0, 0), parent=None, angle_deg=35.0):
        """Makes the object. Edges sharper than the angle stay sharp."""
        mesh = bpy.data.meshes.new(name)
        bmesh.ops.recalc_face_normals(self.mesh, faces=self.mesh.faces[:])
        self.mesh.to_mesh(mesh)
        self.mesh.free()
        for made in self.materials:
            mesh.materials.append(made)
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = math.radians(angle_deg)
        made = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(made)
        made.location = origin
        made.parent = parent
        if semantic_class:
            made["greatx_class"] = semantic_class
        return made


def copy_or_make(mesh, builder, name, semantic_class, origin, parent, yaw=0.0):
    """Makes an object, with the given mesh if there is one, and returns its mesh."""
    if mesh is None:
        made = builder().object(name, semantic_class, origin, parent)
    else:
        made = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(made)
        made.location = origin
        made.parent = parent
        made["greatx_class"] = semantic_class
    made.rotation_euler = (0, 0, yaw)
    return made.data


def superellipse(center, half_width, half_height, power, sides, axis="x"):
    """A ring across an axis between an ellipse (power 2) and a rectangle, seen from the axis' end."""
    ring = []
    for i in range(sides):
        angle = 2 * math.pi * (i + 0.5) / sides
        c, s = math.cos(angle), math.sin(angle)
        u = half_width * math.copysign(abs(c) ** (2 / power), c)
        v = half_height * math.copysign(abs(s) ** (2 / power), s)
        ring.append(Vector(center) + (Vector((0, u, v)) if axis == "x" else Vector((-u, 0, v))))
    return ring


def tube(builder, made, path, radius, sides):
    """A bent tube along a path of points."""
    rings = []
    for i, point in enumerate(path):
        before, after = Vector(path[max(i - 1, 0)]), Vector(path[min(i + 1, len(path) - 1)])
        along = (after - before).normalized()
        side = along.cross(Vector((0, 0, 1))) if abs(along.z) < 0.95 else along.cross(Vector((1, 0, 0)))
        side.normalize()
        up = side.cross(along)
        rings.append(
            [
                Vector(point)
                + radius * (math.cos(2 * math.pi * k / sides) * side + math.sin(2 * math.pi * k / sides) * up)
                for k in range(sides)
            ]
        )
    builder.loft(made, rings)


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def export(file):
    bpy.ops.export_scene.gltf(
        filepath=file,
        export_format="GLB",
        export_yup=True,  # Blender's z becomes glTF's y
        export_apply=True,  # modifiers
        export_extras=True,  # custom properties
        export_texcoords=False,  # these models have no textures
        export_animations=False,
    )


# ---- The drone --------------------------------------------------------------------------------------------

# 450 mm between opposite motors; rotors of 9.4 inches.
MOTOR = 0.225
ROTOR_RADIUS = 0.12


def drone_materials():
    return {
        "shell": material(
            "drone_shell",
            (0.72, 0.73, 0.75),
            0.35,
            radio="relative_permittivity: 2.8, conductivity: 0.005, thickness_m: 0.002",
        ),
        "dark": material(
            "drone_dark",
            (0.03, 0.03, 0.035),
            0.5,
            radio="{relative_permittivity: 2.8, conductivity: 0.005, thickness_m: 0.002}",
        ),
        "carbon": material(
            "carbon_fibre",
            (0.018, 0.018, 0.02),
            0.3,
            radio={"relative_permittivity": 10.0, "conductivity": 1.0e4, "thickness_m": 0.002},
        ),
        "motor": material("motor", (0.55, 0.56, 0.58), 0.25, 1.0, radio={"conductor": "aluminium"}),
        "battery": material("itu_metal", (0.09, 0.1, 0.12), 0.55),
        "lens": material("lens", (0.01, 0.012, 0.03), 0.05, radio={"itu": "glass", "thickness_m": 0.003}),
        "red": material(
            "light_red",
            (0.5, 0.02, 0.02),
            0.4,
            radio=ACRYLIC,
            emission=(1, 0.03, 0.02),
        ),
        "green": material(
            "light_green",
            (0.02, 0.4, 0.08),
            0.4,
            radio=ACRYLIC,
            emission=(0.02, 1, 0.1),
        ),
    }


def drone_hull(b, m):
    sections = [  # x, half width, half height, height of the middle, power
        (-0.150, 0.012, 0.008, 0.006, 2.4),
        (-0.143, 0.032, 0.019, 0.004, 2.6),
        (-0.118, 0.047, 0.029, 0.002, 3.0),
        (-0.060, 0.056, 0.036, 0.000, 3.2),
        (0.010, 0.058, 0.038, -0.001, 3.2),
        (0.075, 0.052, 0.034, -0.002, 3.0),
        (0.120, 0.042, 0.026, -0.003, 2.8),
        (0.150, 0.028, 0.017, -0.005, 2.6),
        (0.161, 0.010, 0.007, -0.006, 2.4),
    ]
    b.loft(m["shell"], [superellipse((x, 0, z), w, h, p, 18) for x, w, h, z, p in sections])
    # The battery behind the top, and a dark canopy in front of it.
    b.box(m["battery"], (-0.105, -0.031, 0.018), (-0.005, 0.031, 0.056), 0.006)
    b.box(m["dark"], (-0.112, -0.022, 0.026), (-0.100, 0.022, 0.050), 0.003)
    canopy = [
        (0.006, 0.020, 0.006),
        (0.014, 0.034, 0.015),
        (0.050, 0.038, 0.018),
        (0.092, 0.030, 0.012),
        (0.112, 0.012, 0.004),
    ]
    b.loft(m["dark"], [superellipse((x, 0, 0.025), w, h, 2.6, 12) for x, w, h in canopy])
    # The satellite antenna, on a stalk.
    b.lathe(m["dark"], [(0.004, 0.03), (0.004, 0.075)], 8, Matrix.Translation((-0.055, 0, 0)))
    b.lathe(
        m["dark"],
        [(0.017, 0.072), (0.021, 0.075), (0.021, 0.081), (0.015, 0.086), (0.005, 0.0875)],
        12,
        Matrix.Translation((-0.055, 0, 0)),
    )
    # Eyes for stereo in front.
    for y in (-0.016, 0.016):
        b.lathe(
            m["lens"],
            [(0.0065, 0.0), (0.0065, 0.008), (0.004, 0.0095)],
            12,
            Matrix.Translation((0.150, y, -0.004)) @ Matrix.Rotation(math.pi / 2, 4, "Y"),
        )


def drone_arms(b, m):
    for i in range(4):
        yaw = math.pi / 4 - math.pi / 2 * i  # front left, front right, rear right, rear left
        turn = Matrix.Rotation(yaw, 4, "Z")
        sections = [
            (0.035, 0.017, 0.012, -0.004),
            (0.070, 0.014, 0.011, 0.000),
            (0.150, 0.0095, 0.0085, 0.010),
            (0.2265, 0.0085, 0.0075, 0.014),
        ]
        b.loft(
            m["carbon"],
            [[turn @ p for p in superellipse((x, 0, z), w, h, 2.4, 12)] for x, w, h, z in sections],
        )
        place = Matrix.Translation((MOTOR * math.cos(yaw), MOTOR * math.sin(yaw), 0.0))
        b.lathe(m["dark"], [(0.010, -0.001), (0.0165, 0.003), (0.0165, 0.023), (0.0135, 0.026)], 14, place)
        b.lathe(
            m["motor"],
            [(0.0132, 0.024), (0.0148, 0.0262), (0.0148, 0.0385), (0.0125, 0.041), (0.0045, 0.0425)],
            14,
            place,
        )
        light = m["red"] if i in (0, 3) else m["green"]  # red to the left
        b.lathe(light, [(0.004, -0.007), (0.0085, -0.0045), (0.0095, 0.001)], 12, place)


def drone_gear(b, m):
    for side in (-1, 1):
        y = side * 0.092
        tube(
            b,
            m["carbon"],
            [(-0.115, y, -0.128), (-0.100, y, -0.135), (0.100, y, -0.135), (0.115, y, -0.128)],
            0.0045,
            8,
        )
        for x in (-0.062, 0.066):
            tube(
                b,
                m["carbon"],
                [
                    (x * 0.7, side * 0.036, -0.022),
                    (x * 0.9, side * 0.070, -0.085),
                    (x, side * 0.0905, -0.1345),
                ],
                0.004,
                8,
            )


def drone_camera(b, m):
    """The gimbal and its camera, below the nose."""
    b.lathe(
        m["dark"],
        [(0.022, -0.048), (0.026, -0.045), (0.026, -0.030), (0.018, -0.026)],
        14,
        Matrix.Translation((0.088, 0, 0)),
    )
    b.box(m["motor"], (0.080, -0.036, -0.054), (0.096, 0.036, -0.046), 0.003)
    for side in (-1, 1):
        b.box(
            m["motor"],
            (0.080, side * 0.0325 - 0.0035, -0.088),
            (0.096, side * 0.0325 + 0.0035, -0.047),
            0.003,
        )
    b.box(m["dark"], (0.066, -0.0275, -0.098), (0.112, 0.0275, -0.060), 0.010, 3)
    across = Matrix.Translation((0.106, 0, -0.079)) @ Matrix.Rotation(math.pi / 2, 4, "Y")
    b.lathe(m["motor"], [(0.0155, 0.0), (0.0155, 0.014), (0.0135, 0.016)], 14, across)
    b.lathe(m["lens"], [(0.0115, 0.004), (0.0115, 0.0165), (0.008, 0.0185), (0.003, 0.0193)], 14, across)


def rotor(m, counter_clockwise):
    """Two twisted blades on a hub, which turn about z. The leading edge is on the side to which they turn."""
    b = Builder()
    b.lathe(
        m["motor"], [(0.007, -0.002), (0.0085, 0.000), (0.0085, 0.008), (0.005, 0.0125), (0.002, 0.0132)], 16
    )
    turn = 1.0 if counter_clockwise else -1.0
    sections = [  # radius, chord, twist in degrees, thickness by chord
        (0.004, 0.0090, 30, 0.40),
        (0.014, 0.0130, 28, 0.26),
        (0.030, 0.0215, 22, 0.14),
        (0.055, 0.0205, 16, 0.11),
        (0.085, 0.0160, 11, 0.10),
        (0.110, 0.0115, 8, 0.10),
        (0.120, 0.0050, 7, 0.16),
    ]
    # Points of the section: (along the chord from the leading edge, height by half the thickness).
    outline = [
        (0.0, 0.0),
        (0.06, 0.75),
        (0.30, 1.3),
        (0.65, 0.9),
        (1.0, 0.05),
        (0.65, -0.35),
        (0.30, -0.7),
        (0.06, -0.55),
    ]
    for half in (0, 1):
        rings = []
        for radius, chord, twist, thickness in sections:
            angle = math.radians(twist)
            ring = []
            for along, height in outline:
                back = (along - 0.35) * chord
                up = 0.5 * height * thickness * chord
                # Behind the leading edge is away from the direction of turning; the trailing edge is lower.
                y = -back * math.cos(angle) + up * math.sin(angle)
                z = -back * math.sin(angle) - 0.0 + up * math.cos(angle) + 0.004
                ring.append(Vector((radius, turn * y, z)))
            rings.append([Matrix.Rotation(math.pi * half, 4, "Z") @ p for p in ring])
        b.loft(m["carbon"], rings)
    return b


def make_drone(file):
    clear()
    m = drone_materials()
    b = Builder()
    drone_hull(b, m)
    drone_arms(b, m)
    drone_gear(b, m)
    drone_camera(b, m)
    body = b.object("drone", "uav")
    turned = [None, None]
    for i in range(4):
        yaw = math.pi / 4 - math.pi / 2 * i
        hub = (MOTOR * math.cos(yaw), MOTOR * math.sin(yaw), 0.0455)
        turned[i % 2] = copy_or_make(
            turned[i % 2], lambda: rotor(m, i % 2 == 0), f"rotor_{i}", "uav", hub, body, 0.7 * i
        )
    export(file)


# ---- The car ----------------------------------------------------------------------------------------------


def car_materials():
    return {
        "paint": material("paint", (0.045, 0.16, 0.36), 0.25, 0.1, radio={"itu": "metal"}),
        "glass": material("car_glass", (0.015, 0.02, 0.024), 0.05, radio="itu: glass, thickness_m: 0.005"),
        "trim": material(
            "trim",
            (0.02, 0.02, 0.02),
            0.6,
            radio="relative_permittivity: 2.8, conductivity: 0.005, thickness_m: 0.004",
        ),
        "tyre": material(
            "tyre", (0.015, 0.015, 0.016), 0.9, radio={"relative_permittivity": 6.0, "conductivity": 0.5}
        ),
        "rim": material("rim", (0.62, 0.63, 0.65), 0.3, 1.0, radio={"conductor": "aluminium"}),
        "lamp": material("head_lamp", (0.85, 0.87, 0.9), 0.1, radio=ACRYLIC),
        "tail": material("tail_lamp", (0.45, 0.01, 0.01), 0.2, radio=ACRYLIC),
        "plate": material("itu_metal", (0.8, 0.8, 0.78), 0.5),
    }


AXLES = (1.19, -1.16)  # x of the front and rear wheels
WHEEL_RADIUS = 0.305
TRACK = 0.735  # half


def car_profile():
    """The outline of the lower body from the side, with wheel arches, counter-clockwise seen from the left
    (x to the left, so that it runs from the front sill around)."""
    points = []
    arch = WHEEL_RADIUS + 0.055
    sill = 0.20

    def add_arch(x):
        start = math.asin((sill - WHEEL_RADIUS) / arch)
        n = 8
        for i in range(n + 1):
            angle = start + (math.pi - 2 * start) * i / n
            points.append((x + arch * math.cos(angle), WHEEL_RADIUS + arch * math.sin(angle)))

    points += [(1.84, 0.26), (1.80, 0.205)]
    add_arch(AXLES[0])
    add_arch(AXLES[1])
    points += [(-1.66, 0.215), (-1.765, 0.29), (-1.80, 0.46), (-1.785, 0.70), (-1.74, 0.90)]
    points += [
        (-1.55, 0.965),
        (-0.90, 0.975),
        (0.0, 0.965),
        (0.72, 0.945),
        (1.05, 0.905),
        (1.45, 0.825),
        (1.70, 0.735),
        (1.81, 0.63),
        (1.855, 0.45),
    ]
    return points


def half_width(x, z):
    """Half the width of the body: it narrows to both ends, to the sill and above the waist."""
    ends = 1.0 - 0.10 * max(0.0, (abs(x - 0.02) - 1.15) / 0.7) ** 2
    height = 1.0 - 0.05 * max(0.0, (z - 0.55) / 0.42) ** 2 - 0.04 * max(0.0, (0.5 - z) / 0.3) ** 2
    return 0.835 * ends * height


def car_body(b, m):
    profile = car_profile()
    rings = []
    # Rings of the outline from the right to the left; the outer ones are smaller: edges are round.
    for share, inset in (
        (-1.0, 0.030),
        (-0.985, 0.010),
        (-0.95, 0.0),
        (-0.6, 0.0),
        (0.0, 0.0),
        (0.6, 0.0),
        (0.95, 0.0),
        (0.985, 0.010),
        (1.0, 0.030),
    ):
        ring = []
        for x, z in profile:
            cx, cz = 0.0, 0.60
            # The upper edge sinks towards the sides; arches and sills stay.
            bow = 0.022 * abs(share) ** 3 if z > 0.7 else 0.0
            shrink = inset if z > 0.62 or abs(x) > 1.62 else 0.0
            length = math.hypot(x - cx, (z - cz) * 2.5)
            ring.append(
                Vector(
                    (
                        x - shrink * (x - cx) / length,
                        share * half_width(x, z),
                        z - bow - shrink * 2.5 * (z - cz) / length,
                    )
                )
            )
        rings.append(ring)
    b.loft(m["paint"], rings)
    # The floor between the wheels and the wheel wells, dark.
    b.box(m["trim"], (-1.70, -0.60, 0.19), (1.74, 0.60, 0.55), 0.03)


def car_cabin(b, m):
    """The greenhouse: glass, with the roof and pillars of sheet metal over it."""
    low = [(0.83, 0.775), (0.30, 0.785), (-0.40, 0.785), (-1.10, 0.770), (-1.66, 0.690)]
    top = [(0.10, 0.575), (-0.12, 0.590), (-0.50, 0.592), (-1.00, 0.580), (-1.38, 0.545)]

    def ring(points, z):
        left = [Vector((x, y, h)) for (x, y), h in zip(points, z)]
        return [Vector((p.x, -p.y, p.z)) for p in left] + left[::-1]

    z_low = [0.915, 0.93, 0.935, 0.935, 0.92]
    z_top = [1.390, 1.415, 1.425, 1.410, 1.365]
    lower, upper = ring(low, z_low), ring(top, z_top)
    b.loft(m["glass"], [r[::-1] for r in (lower, upper)])
    # Roof: a shell over the upper ring, slightly larger and bowed.
    middle = sum(upper, Vector()) / len(upper)
    rings = []
    for scale, dz in ((1.012, -0.030), (1.022, -0.004), (1.008, 0.010), (0.85, 0.022), (0.55, 0.029)):
        rings.append(
            [
                middle + scale * (p - middle) + Vector((0, 0, dz + (1 - scale) * (middle.z - p.z)))
                for p in upper
            ][::-1]
        )
    b.loft(m["paint"], rings)
    # Pillars along the edges between the panes, from below the waist to the roof.
    for i, width, made in ((0, 0.030, "paint"), (2, 0.035, "trim"), (3, 0.030, "trim"), (4, 0.045, "paint")):
        for side in (-1, 1):
            a = Vector((low[i][0], side * low[i][1], z_low[i] - 0.004))
            c = Vector((top[i][0], side * top[i][1], z_top[i] + 0.01))
            along = Vector((width, 0, 0))
            out = Vector((0, side * 0.010, 0.004))
            back = Vector((0, -side * 0.02, -0.008))
            quad = [p for p in (out - along, out + along, back + along, back - along)]
            if side < 0:
                quad = quad[::-1]
            b.loft(m[made], [[a + p for p in quad], [c + p for p in quad]])


def car_details(b, m):
    for side in (-1, 1):
        # Lamps, set into the corners: an outline from the side, from the middle of the car outwards.
        outline = [(1.66, 0.56), (1.845, 0.565), (1.832, 0.640), (1.716, 0.750), (1.60, 0.790), (1.58, 0.70)]
        rings = []
        for y, back, shrink in (
            (0.36, 0.015, 0.75),
            (0.43, 0.004, 1.0),
            (0.66, 0.012, 1.0),
            (0.735, 0.05, 0.9),
        ):
            rings.append(
                [
                    Vector((1.70 + shrink * (x - 1.70) - back, side * y, 0.67 + shrink * (z - 0.67)))
                    for x, z in outline
                ]
            )
        b.loft(m["lamp"], rings if side < 0 else [ring[::-1] for ring in rings])
        b.box(m["tail"], (-1.80, side * 0.60 - 0.10, 0.62), (-1.66, side * 0.60 + 0.10, 0.86), 0.025)
        # Mirrors.
        b.box(m["paint"], (0.56, side * 0.90 - 0.085, 0.93), (0.66, side * 0.90 + 0.085, 1.04), 0.03)
        b.box(m["trim"], (0.59, side * 0.79 - 0.06, 0.93), (0.63, side * 0.79 + 0.06, 0.96), 0.008)
        # Seams of the doors.
        for x, low in ((0.62, 0.50), (-0.16, 0.27), (-0.86, 0.60)):
            heights = [low + (0.925 - low) * i / 6 for i in range(7)]
            tube(b, m["trim"], [(x, side * (half_width(x, z) - 0.001), z) for z in heights], 0.005, 6)
        # Door handles and the line of the sill.
        b.box(m["trim"], (-0.42, side * 0.826 - 0.012, 0.79), (-0.26, side * 0.826 + 0.012, 0.815), 0.006)
        b.box(m["trim"], (-0.75, side * 0.80 - 0.035, 0.185), (0.78, side * 0.80 + 0.035, 0.255), 0.015)
    # Grille, bumpers, plates, wipers.
    b.box(m["trim"], (1.70, -0.48, 0.33), (1.865, 0.48, 0.47), 0.03)
    b.box(m["trim"], (1.70, -0.34, 0.575), (1.845, 0.34, 0.64), 0.02)
    b.box(m["trim"], (-1.815, -0.52, 0.27), (-1.66, 0.52, 0.40), 0.03)
    b.box(m["plate"], (1.83, -0.26, 0.485), (1.872, 0.26, 0.555), 0.006)
    b.box(m["plate"], (-1.812, -0.26, 0.52), (-1.74, 0.26, 0.60), 0.006)


def wheel(m):
    """A wheel about y (the axle)."""
    b = Builder()
    side = Matrix.Rotation(math.pi / 2, 4, "X")  # z of the profile becomes -y
    tyre = [
        (0.205, -0.082),
        (0.262, -0.097),
        (0.288, -0.090),
        (0.3045, -0.068),
        (0.305, 0.0),
        (0.3045, 0.068),
        (0.288, 0.090),
        (0.262, 0.097),
        (0.205, 0.082),
    ]
    # The tyre is a ring: its profile runs outside and returns inside.
    rings = []
    for radius, height in tyre:
        rings.append(
            [
                side
                @ Vector(
                    (radius * math.cos(2 * math.pi * i / 20), radius * math.sin(2 * math.pi * i / 20), height)
                )
                for i in range(20)
            ]
        )
    b.loft(m["tyre"], rings, closed=True)
    rim = [(0.190, -0.060), (0.212, -0.086), (0.212, 0.086), (0.190, 0.060)]
    rings = []
    for radius, height in rim:
        rings.append(
            [
                side
                @ Vector(
                    (radius * math.cos(2 * math.pi * i / 20), radius * math.sin(2 * math.pi * i / 20), height)
                )
                for i in range(20)
            ]
        )
    b.loft(m["rim"], rings, closed=True)
    b.lathe(m["rim"], [(0.048, -0.075), (0.052, -0.070), (0.052, 0.070), (0.048, 0.075)], 16, side)
    b.lathe(m["trim"], [(0.185, -0.022), (0.185, 0.022)], 24, side)  # brake and backing, dark
    for k in range(10):
        turn = Matrix.Rotation(2 * math.pi * (k // 2) / 5 + (0.21 if k % 2 else -0.21), 4, "Y")
        corners = ((1, -0.068), (1, 0.068), (-1, 0.068), (-1, -0.068))
        spoke = [[Vector((sx * w, y, r)) for sx, y in corners] for r, w in ((0.044, 0.007), (0.200, 0.016))]
        b.loft(m["rim"], [[turn @ p for p in ring] for ring in spoke])
    return b


def make_car(file):
    clear()
    m = car_materials()
    b = Builder()
    car_body(b, m)
    car_cabin(b, m)
    car_details(b, m)
    body = b.object("car", "vehicle", angle_deg=30.0)
    first = None
    for x, end in zip(AXLES, ("front", "rear")):
        for side, name in ((1, "left"), (-1, "right")):
            place = (x, side * TRACK, WHEEL_RADIUS)
            first = copy_or_make(first, lambda: wheel(m), f"wheel_{end}_{name}", "vehicle", place, body)
    export(file)


if __name__ == "__main__":
    folder = sys.argv[sys.argv.index("--") + 1]
    make_drone(folder + "/drone.glb")
    make_car(folder + "/car.glb")
