# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes village.osm, village_terrain.tif, village_ortho.png and village_ortho.pgw: a village that does not
exist, in the formats that real places come in. All of it follows from one plan in metres, x east and y north
of ORIGIN. The same Python gives the same files.

    python3 make_village.py [FOLDER]
"""

import math
import random
import struct
import sys
import zlib
from pathlib import Path

import numpy as np

ORIGIN = (-42.7312, 146.9475)  # degrees, WGS 84
HALF = (225.0, 175.0)  # m, half of the area's width and height
MARGIN = 30.0  # m, of terrain and picture beyond the area
LATITUDE = math.radians(ORIGIN[0])
METRES_PER_DEGREE = (  # of longitude and latitude, from the radii of curvature of WGS 84
    math.pi / 180 * 6378137 * math.cos(LATITUDE) / math.sqrt(1 - 0.00669437999014 * math.sin(LATITUDE) ** 2),
    math.pi
    / 180
    * 6378137
    * (1 - 0.00669437999014)
    / (1 - 0.00669437999014 * math.sin(LATITUDE) ** 2) ** 1.5,
)
RANDOM = random.Random(7)


def degrees(x, y):
    """Returns (latitude, longitude)."""
    return ORIGIN[0] + y / METRES_PER_DEGREE[1], ORIGIN[1] + x / METRES_PER_DEGREE[0]


# ---- terrain -----------------------------------------------------------------------------------------------


def river_y(x):
    return -88 + 13 * np.sin(np.asarray(x) / 68.0)


def smooth(t):
    t = np.clip(t, 0, 1)
    return t * t * (3 - 2 * t)


def height(x, y):
    """Height above the datum, m: a hillside that falls to a river."""
    away = y - river_y(x)
    north, south = np.clip(away, 0, None), np.clip(-away, 0, None)
    hill = 0.055 * north + 9 * smooth((north - 90) / 170) + 0.07 * south
    swell = 0.9 * np.sin(x / 41 + 0.8) * np.cos(y / 53) + 0.35 * np.sin(x / 17 - y / 23)
    banks = 4.2 * smooth((np.abs(away) - 4) / 13)
    return 174.0 - 0.008 * x + hill + banks + swell * smooth((np.abs(away) - 10) / 60)


# ---- plan --------------------------------------------------------------------------------------------------

CELL = 0.4  # m, of the plan's raster and of the picture
COLUMNS, ROWS = (int(round(2 * (half + MARGIN) / CELL)) for half in HALF)
X = -HALF[0] - MARGIN + (np.arange(COLUMNS) + 0.5) * CELL
Y = HALF[1] + MARGIN - (np.arange(ROWS) + 0.5) * CELL


def window(points, by=0.0):
    """Returns the slices of the raster around the points."""
    low, high = np.min(points, axis=0) - by, np.max(points, axis=0) + by
    columns = slice(int(max(0, (low[0] - X[0]) / CELL)), int(max(0, (high[0] - X[0]) / CELL + 2)))
    return slice(int(max(0, (Y[0] - high[1]) / CELL)), int(max(0, (Y[0] - low[1]) / CELL + 2))), columns


def fill(raster, ring, value):
    """Sets the cells whose middles lie in a ring (even and odd crossings)."""
    box = window(ring)
    x, y = np.meshgrid(X[box[1]], Y[box[0]])
    inside = np.zeros(x.shape, bool)
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
    raster[box][inside] = value


def stroke(raster, line, width, value):
    """Sets the cells that are within half the width of a line."""
    for (ax, ay), (bx, by) in zip(line, line[1:]):
        box = window([(ax, ay), (bx, by)], width)
        x, y = np.meshgrid(X[box[1]] - ax, Y[box[0]] - ay)
        dx, dy = bx - ax, by - ay
        t = np.clip((x * dx + y * dy) / (dx * dx + dy * dy), 0, 1)
        raster[box][np.hypot(x - t * dx, y - t * dy) <= width / 2] = value


def rectangle(center, size, turn_deg=0.0):
    """Returns the corners, counter-clockwise; `turn_deg` turns the first side from x towards y."""
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    corners = [(-size[0] / 2, -size[1] / 2), (size[0] / 2, -size[1] / 2)]
    corners += [(size[0] / 2, size[1] / 2), (-size[0] / 2, size[1] / 2)]
    return [(center[0] + c * u - s * v, center[1] + s * u + c * v) for u, v in corners]


def circle(center, radius, corners=16):
    angles = [2 * math.pi * i / corners for i in range(corners)]
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]


def along(line, step, offset, start=0.0):
    """Yields (place, direction in degrees) every `step` metres, `offset` metres to the left of the line."""
    at = start
    for (ax, ay), (bx, by) in zip(line, line[1:]):
        length = math.hypot(bx - ax, by - ay)
        ux, uy = (bx - ax) / length, (by - ay) / length
        while at <= length:
            yield (ax + at * ux - offset * uy, ay + at * uy + offset * ux), math.degrees(math.atan2(uy, ux))
            at += step
        at -= length


class Osm:
    """Collects nodes, ways and relations. Corners at the same place are one node, as mappers draw them."""

    def __init__(self):
        self.nodes, self.tagged, self.ways, self.relations = {}, [], [], []

    def node(self, place):
        key = tuple(f"{value:.7f}" for value in degrees(*place))
        return self.nodes.setdefault(key, 1001 + len(self.nodes))

    def point(self, place, **tags):
        self.tagged.append((self.node(place), tags))

    def way(self, line, closed=False, **tags):
        nodes = [self.node(place) for place in line]
        self.ways.append((len(self.ways) + 101, nodes + nodes[: 1 if closed else 0], tags))
        return self.ways[-1][0]

    def multipolygon(self, outer, inner, **tags):
        members = [("outer", self.way(ring, True)) for ring in outer]
        members += [("inner", self.way(ring, True)) for ring in inner]
        self.relations.append((len(self.relations) + 11, members, {"type": "multipolygon", **tags}))

    def text(self):
        def tags_of(tags):
            # A keyword of Python cannot have a colon: roof__shape is roof:shape.
            pairs = ((key.replace("__", ":"), value) for key, value in tags.items())
            return "".join(f'<tag k="{key}" v="{value}"/>' for key, value in pairs)

        (south, west), (north, east) = degrees(-HALF[0], -HALF[1]), degrees(*HALF)
        lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6" generator="make_village.py">']
        lines += ["<!-- A village that does not exist. Made by greatx; Apache-2.0. -->"]
        lines += [
            f'<bounds minlat="{south:.7f}" minlon="{west:.7f}" maxlat="{north:.7f}" maxlon="{east:.7f}"/>'
        ]
        tagged = {}
        for identifier, tags in self.tagged:
            tagged.setdefault(identifier, {}).update(tags)
        for (latitude, longitude), identifier in self.nodes.items():
            inner = tags_of(tagged.get(identifier, {}))
            end = f">{inner}</node>" if inner else "/>"
            lines.append(f'<node id="{identifier}" lat="{latitude}" lon="{longitude}"{end}')
        for identifier, nodes, tags in self.ways:
            refs = "".join(f'<nd ref="{node}"/>' for node in nodes)
            lines.append(f'<way id="{identifier}">{refs}{tags_of(tags)}</way>')
        for identifier, members, tags in self.relations:
            refs = "".join(f'<member type="way" ref="{way}" role="{role}"/>' for role, way in members)
            lines.append(f'<relation id="{identifier}">{refs}{tags_of(tags)}</relation>')
        return "\n".join(lines + ["</osm>", ""])


# Colours of the picture, sRGB. Each class has four shades, which noise chooses from.
COLOURS = {
    "verge": (112, 122, 78), "grass": (98, 128, 66), "meadow": (128, 134, 80), "field": (164, 146, 96),
    "crop": (104, 124, 58), "wood": (58, 82, 46), "asphalt": (104, 104, 106), "lot": (122, 121, 120),
    "track": (150, 132, 104), "paving": (166, 156, 142), "water": (58, 78, 76), "pitch": (92, 138, 70),
    "garden": (104, 126, 74), "tile": (150, 84, 62), "tile_dark": (116, 70, 58), "slate": (86, 88, 94),
    "gravel": (156, 154, 150), "zinc": (168, 174, 178), "felt": (92, 90, 88), "crown": (66, 96, 50),
    "mark": (214, 212, 204),
}  # fmt: skip
NUMBER = {name: i for i, name in enumerate(COLOURS)}


class Village:
    def __init__(self):
        self.osm = Osm()
        self.picture = np.full((ROWS, COLUMNS), NUMBER["verge"], np.uint8)
        self.taken = np.zeros((ROWS, COLUMNS), bool)  # where no house may stand
        self.roads = {}
        self.plan_roads()
        self.plan_areas()
        self.plan_landmarks()
        self.plan_terrace()
        self.plan_houses()
        self.plan_furniture()

    def area(self, ring, colour, taken=True, **tags):
        fill(self.picture, ring, NUMBER[colour])
        if taken:
            fill(self.taken, ring, True)
        if tags:
            self.osm.way(ring, True, **tags)

    def road(self, name, line, wide, kind, colour="asphalt", **tags):
        self.roads[name] = line
        stroke(self.taken, line, wide + 3, True)
        if "bridge" not in tags:  # the picture is of the ground
            self.later.append((line, wide, colour))
        if kind not in ("footway", "path", "track", "service"):
            tags["name"] = name
        self.osm.way(line, highway=kind, **tags)

    def plan_roads(self):
        self.later = []
        main = [(-265, -40), (-160, -31), (-90, -17), (-20, -9), (36, -13), (66, -30), (82, -50)]
        self.road("Main Road", main, 6.5, "tertiary", lanes="2", width="6.5")
        self.road(
            "Main Road bridge", [(82, -50), (98, -94)], 6.5, "tertiary", width="7.5", bridge="yes", layer="1"
        )
        self.road(
            "Main Road south", [(98, -94), (114, -134), (122, -215)], 6.5, "tertiary", lanes="2", width="6.5"
        )
        self.road("Church Lane", [(-20, -9), (-26, 36), (-34, 92), (-40, 140), (-62, 215)], 5, "residential")
        self.road("Hill Street", [(-34, 92), (58, 98), (140, 88), (265, 99)], 5.5, "residential")
        self.road("School Road", [(36, -13), (50, 38), (58, 98)], 5.5, "residential")
        self.road("Orchard Street", [(50, 38), (120, 32), (196, 42)], 5.5, "residential")
        self.road(
            "Upper Lane", [(-34, 92), (-112, 86), (-196, 104), (-265, 108)], 4.5, "unclassified", width="4.5"
        )
        self.road(
            "Mill Lane", [(-90, -17), (-98, -44), (-58, -62), (10, -54)], 4.5, "residential", width="4.5"
        )
        self.road("parking", [(66, -30), (98, -20), (128, -20)], 4.5, "service", "lot")
        self.road("farm", [(114, -134), (60, -142), (18, -138)], 3, "track", "track")
        self.road("riverside", [(-200, -78), (-120, -79), (-60, -76), (10, -61)], 1.8, "footway", "track")
        self.road("park", [(-26, 36), (-60, 30), (-92, 44), (-112, 86)], 2, "footway", "track")
        self.road("park south", [(-60, 30), (-72, -2), (-90, -17)], 2, "footway", "track")
        self.road("pitch path", [(58, 98), (92, 128), (128, 134)], 1.5, "path", "track")

    def plan_areas(self):
        xs = np.linspace(-HALF[0] - MARGIN, HALF[0] + MARGIN, 52)
        width = 9.0
        banks = [(float(x), float(river_y(x)) - width / 2) for x in xs]
        banks += [(float(x), float(river_y(x)) + width / 2) for x in xs[::-1]]
        self.area([(-250, -70), (250, -70), (250, 170), (-250, 170)], "garden", False, landuse="residential")
        self.area(
            [(-252, -200), (-20, -200), (-14, -112), (-120, -112), (-252, -104)], "crop", landuse="farmland"
        )
        self.area([(-12, -200), (96, -200), (90, -150), (-8, -146)], "field", landuse="farmland")
        self.area([(134, -200), (252, -200), (252, -108), (134, -106)], "meadow", landuse="meadow")
        self.area(
            [(-252, 112), (-196, 112), (-116, 95), (-48, 102), (-70, 200), (-252, 200)],
            "meadow",
            landuse="meadow",
        )
        self.area(banks, "water", natural="water", water="river")
        self.osm.way(
            [(float(x), float(river_y(x))) for x in xs], waterway="river", name="Plenty Brook", width="9"
        )
        park = [(-30, 84), (-108, 78), (-96, 42), (-86, -10), (-32, -4), (-30, 34)]
        self.area(park, "grass", leisure="park", name="Village Park")
        self.area([(-18, -2), (30, -6), (40, 22), (-20, 26)], "paving", place="square", name="Church Square")
        self.area([(96, -16), (142, -16), (142, 8), (96, 8)], "lot", amenity="parking")
        for i in range(17):
            for y in (3.0, -11.0):
                stroke(self.picture, [(98 + 2.6 * i, y), (98 + 2.6 * i, y + 4.5)], 0.4, NUMBER["mark"])
        pitch = rectangle((152, 130), (62, 40), 4)
        self.area(pitch, "pitch", leisure="pitch", sport="soccer")
        stroke(self.picture, pitch + pitch[:1], 0.5, NUMBER["mark"])
        outer = [(-60, 200), (-48, 116), (24, 112), (70, 140), (78, 200)]
        clearing = [(0, 140), (24, 146), (18, 164), (-4, 160)]
        fill(self.picture, outer, NUMBER["wood"])
        fill(self.picture, clearing, NUMBER["meadow"])
        fill(self.taken, outer, True)
        self.osm.multipolygon([outer], [clearing], natural="wood", leaf_type="mixed")
        self.area([(-240, -96), (-214, -96), (-206, -82), (-240, -80)], "wood", natural="scrub")
        for line, width, colour in self.later:
            stroke(self.picture, line, width, NUMBER[colour])

    def building(self, ring, roof, **tags):
        self.area(ring, roof, True, **tags)
        for a, b in zip(ring, ring[1:] + ring[:1]):  # a garden around it stays free
            stroke(self.taken, [a, b], 5.0, True)

    def plan_landmarks(self):
        # The church: nave, tower, choir, and a canopy above its door.
        nave, tower = rectangle((10, 46), (26, 12)), rectangle((-7, 46), (8, 8))
        choir, canopy = rectangle((26.5, 46), (7, 8)), rectangle((10, 38.5), (5, 3))
        outline = [
            (-11, 42),
            (-3, 42),
            (-3, 40),
            (7.5, 40),
            (7.5, 37),
            (12.5, 37),
            (12.5, 40),
            (23, 40),
            (23, 42),
            (30, 42),
            (30, 50),
            (23, 50),
            (23, 52),
            (-3, 52),
        ]
        outline += [(-3, 50), (-11, 50)]
        common = {"building__material": "sandstone", "roof__material": "slate"}
        self.building(
            outline,
            "slate",
            building="church",
            name="St Brendan",
            height="31",
            building__material="sandstone",
        )
        self.building(
            nave, "slate", building__part="yes", height="14", roof__shape="gabled", roof__height="6", **common
        )
        self.building(
            tower,
            "slate",
            building__part="yes",
            height="31",
            roof__shape="pyramidal",
            roof__height="11",
            **common,
        )
        self.building(
            choir,
            "slate",
            building__part="yes",
            height="10",
            roof__shape="hipped",
            roof__height="3.5",
            **common,
        )
        self.building(canopy, "zinc", building__part="roof", height="4", min_height="3.2", roof__shape="flat")
        # The school, around a court.
        outer, court = rectangle((84, 66), (44, 34), -4), rectangle((84, 66), (20, 13), -4)
        fill(self.picture, outer, NUMBER["gravel"])
        fill(self.picture, court, NUMBER["paving"])
        fill(self.taken, rectangle((84, 66), (54, 44), -4), True)
        self.osm.multipolygon([outer], [court], building="school", building__levels="2", roof__shape="flat",
                              building__material="brick", name="Village School")  # fmt: skip
        self.building(
            rectangle((164, 2), (36, 24), 3),
            "gravel",
            building="supermarket",
            height="6.5",
            roof__shape="flat",
        )
        self.building(
            rectangle((66, 6), (26, 13), 0),
            "gravel",
            building="office",
            building__levels="5",
            roof__shape="flat",
        )
        self.building(rectangle((-24, -33), (22, 12), 2), "zinc", building="apartments", building__levels="4",
                      roof__shape="hipped", roof__height="3", roof__material="zinc",
                      building__colour="#d8c8a8")  # fmt: skip
        # The farm.
        self.area([(-6, -146), (34, -146), (34, -112), (-6, -112)], "track", False, landuse="farmyard")
        self.building(
            rectangle((2, -130), (12, 24), 0),
            "felt",
            building="barn",
            height="9",
            roof__shape="gabled",
            roof__height="4.5",
        )
        self.building(
            rectangle((24, -121), (14, 9), 0),
            "tile_dark",
            building="farm",
            building__levels="2",
            roof__shape="half-hipped",
        )
        self.building(
            rectangle((24, -134), (7, 6), 0),
            "zinc",
            building="shed",
            height="3",
            roof__shape="skillion",
            roof__direction="S",
        )
        # The water tower: a shaft, and a tank with a dome on it.
        at = (-150, 140)
        self.building(
            circle(at, 5), "zinc", building="water_tower", height="24", building__material="concrete"
        )
        self.osm.way(
            circle(at, 2.4, 12), True, building__part="yes", height="15", building__material="concrete"
        )
        self.osm.way(circle(at, 5), True, building__part="yes", height="24", min_height="15",
                     roof__shape="dome",
                     roof__height="4", building__material="concrete", roof__material="metal")  # fmt: skip

    def plan_terrace(self):
        """A row of houses with party walls, of unlike heights, along Mill Lane."""
        direction = math.degrees(math.atan2(8, 68))
        c, s = math.cos(math.radians(direction)), math.sin(math.radians(direction))
        heights = [
            ("2", None),
            ("2", None),
            ("2", None),
            (None, "9.2"),
            ("2", None),
            ("3", None),
            ("2", None),
        ]
        for i, (levels, top) in enumerate(heights):
            u, v = 6.0 * i + 9, 9.0
            center = (-58 + c * u - s * v, -62 + s * u + c * v)
            tags = {"building__levels": levels} if levels else {"height": top}
            colour = ["#e8d8b8", "#d9b48f", "#c9d2d4", "#e6c9a8", "#b9c4b0", "#ddd0c0", "#cfa890"][i]
            self.building(rectangle(center, (6, 9), direction), "tile" if i % 2 else "tile_dark",
                          building="terrace", roof__shape="gabled", roof__orientation="across",
                          roof__height="3", building__colour=colour, **tags)  # fmt: skip

    def plan_houses(self):
        kinds = [
            ("tile", dict(building="house", building__levels="1", roof__shape="gabled", roof__levels="1")),
            (
                "tile_dark",
                dict(building="house", building__levels="2", roof__shape="hipped", roof__height="2.8"),
            ),
            (
                "slate",
                dict(
                    building="detached",
                    height="8.4",
                    roof__shape="gabled",
                    roof__height="3.6",
                    roof__material="slate",
                ),
            ),
            ("tile", dict(building="house")),
            (
                "tile_dark",
                dict(building="house", building__levels="1", roof__shape="half-hipped", roof__angle="40"),
            ),
            (
                "zinc",
                dict(
                    building="bungalow",
                    height="5.2",
                    roof__shape="hipped",
                    roof__height="2.2",
                    roof__material="metal",
                ),
            ),
            (
                "tile",
                dict(
                    building="detached",
                    building__levels="2",
                    roof__shape="gabled",
                    building__material="brick",
                ),
            ),
            ("tile_dark", dict(building="house", building__levels="2")),
        ]
        number = 0
        for name in (
            "Main Road",
            "Church Lane",
            "Hill Street",
            "Orchard Street",
            "Upper Lane",
            "School Road",
            "Mill Lane",
        ):
            for side in (1, -1):
                for place, direction in along(self.roads[name], 5.0, side * 13.5, 12.0):
                    if max(abs(place[0]) - HALF[0], abs(place[1]) - HALF[1]) > -10 or number >= 54:
                        continue
                    roof, tags = kinds[number % len(kinds)]
                    size = (RANDOM.choice((10.0, 11.5, 12.5)), RANDOM.choice((7.5, 8.5, 9.0)))
                    ring = rectangle(place, size, direction + RANDOM.choice((0, 0, 0, 3, -2)))
                    if number % 5 == 2:  # a wing towards the back
                        back = 1 if side > 0 else -1
                        ring = self.with_wing(place, size, direction, back)
                    probe = np.zeros_like(self.taken)
                    fill(probe, ring, True)
                    if (probe & self.taken).any():
                        continue
                    self.building(ring, roof, addr__street=name, addr__housenumber=str(number + 1), **tags)
                    if number % 4 == 1:
                        self.beside(place, size, direction, "garage" if number % 8 == 1 else "carport")
                    number += 1
        self.houses = number

    @staticmethod
    def with_wing(center, size, turn_deg, back):
        """Returns an L: a wing of half the length at the back."""
        c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
        u, v, w = size[0] / 2, size[1] / 2, size[1] / 2 + 5.0
        corners = [(-u, -v), (u, -v), (u, w), (u - 5.5, w), (u - 5.5, v), (-u, v)]
        if back < 0:
            corners = [(x, -y) for x, y in corners[::-1]]
        return [(center[0] + c * x - s * y, center[1] + s * x + c * y) for x, y in corners]

    def beside(self, center, size, turn_deg, kind):
        """Puts a garage or a carport beside a house if there is room."""
        c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
        u = size[0] / 2 + 3.2
        ring = rectangle((center[0] + c * u, center[1] + s * u), (3.4, 5.6), turn_deg)
        probe = np.zeros_like(self.taken)
        fill(probe, rectangle((center[0] + c * (u + 1), center[1] + s * (u + 1)), (3, 5), turn_deg), True)
        if (probe & self.taken).sum() > 30:
            return
        tags = dict(height="2.6", roof__shape="flat")
        if kind == "carport":
            tags = dict(height="2.5", min_height="2.3", roof__shape="flat")
        self.building(ring, "felt", building=kind, **tags)

    def free(self, place):
        row, column = int((Y[0] - place[1]) / CELL + 0.5), int((place[0] - X[0]) / CELL + 0.5)
        return 0 <= row < ROWS and 0 <= column < COLUMNS and not self.taken[row, column]

    def tree(self, place, radius=2.4, **tags):
        self.osm.point(place, natural="tree", **tags)
        fill(self.picture, circle(place, radius, 12), NUMBER["crown"])

    def plan_furniture(self):
        genera = ["Quercus", "Acer", "Tilia", "Fagus", "Pinus", "Populus"]
        paths = np.zeros_like(self.taken)
        for name in ("park", "park south", "Church Lane", "Main Road"):
            stroke(paths, self.roads[name], 9.0, True)
        park = np.zeros_like(self.taken)
        fill(park, [(-36, 78), (-102, 72), (-92, 42), (-82, -4), (-36, 0), (-34, 34)], True)
        for i in range(34):
            place = (RANDOM.uniform(-104, -32), RANDOM.uniform(-6, 78))
            row, column = int((Y[0] - place[1]) / CELL), int((place[0] - X[0]) / CELL)
            if park[row, column] and not paths[row, column]:
                stroke(paths, [place, (place[0] + 0.1, place[1])], 9.0, True)
                self.tree(place, genus=genera[i % 6], height=f"{RANDOM.uniform(8, 17):.1f}")
        for place in ((-12, 19), (0, 20), (12, 19), (24, 17)):
            self.tree(place, 2.0, genus="Tilia", height="9")
        for i in range(70):  # gardens
            place = (RANDOM.uniform(-215, 215), RANDOM.uniform(-60, 165))
            if self.free(place):
                self.tree(place, 1.8, height=f"{RANDOM.uniform(4, 9):.1f}")
        row = [(-200, -42.5), (-160, -39), (-110, -29)]
        self.osm.way(row, natural="tree_row", genus="Populus")
        for place, _ in along(row, 8.0, 0.0):
            fill(self.picture, circle(place, 2.0, 12), NUMBER["crown"])
        for line in (
            [(134, -106), (252, -108)],
            [(118, 108), (118, 150)],
            [(-14, -112), (-120, -112)],
            [(60, 84), (104, 88)],
        ):
            self.osm.way(line, barrier="hedge", height="1.6")
            stroke(self.picture, line, 1.2, NUMBER["crown"])
        for name, step in (("Main Road", 28.0), ("Church Lane", 30.0), ("School Road", 30.0),
                           ("Orchard Street", 32.0), ("Hill Street", 34.0), ("Main Road south", 30.0),
                           ("Mill Lane", 36.0)):  # fmt: skip
            for place, direction in along(self.roads[name], step, 4.6, 9.0):
                if abs(place[0]) < HALF[0] and abs(place[1]) < HALF[1]:
                    self.osm.point(place, highway="street_lamp", direction=f"{(180 - direction) % 360:.0f}")
        for place, direction in (
            ((-8, 14), 180),
            ((4, 14), 180),
            ((16, 13), 180),
            ((-58, 33), 0),
            ((-88, 42), 300),
        ):
            self.osm.point(place, amenity="bench", direction=str(direction))
        self.osm.point((-56, 27), amenity="waste_basket")
        self.osm.point((190, 152), man_made="mast", height="30", tower__type="communication")


# ---- files -------------------------------------------------------------------------------------------------


def write_terrain(path, step=2.5):
    """Writes a GeoTIFF 1.1 of float heights: rows from the north, deflated, pixels that stand for areas."""
    columns, rows = (int(round(2 * (half + MARGIN) / step)) for half in HALF)
    west, north = -HALF[0] - MARGIN, HALF[1] + MARGIN
    x, y = np.meshgrid(west + (np.arange(columns) + 0.5) * step, north - (np.arange(rows) + 0.5) * step)
    # Multiples of 1/64 m pack well.
    data = zlib.compress((np.round(height(x, y) * 64) / 64).astype("<f4").tobytes(), 9)
    latitude, longitude = degrees(west, north)
    doubles = lambda *values: (12, len(values), struct.pack(f"<{len(values)}d", *values))
    shorts = lambda *values: (3, len(values), struct.pack(f"<{len(values)}H", *values))
    long = lambda value: (4, 1, struct.pack("<I", value))
    tags = {
        256: long(columns), 257: long(rows), 258: shorts(32), 259: shorts(8), 262: shorts(1), 273: long(8),
        277: shorts(1), 278: long(rows), 279: long(len(data)), 339: shorts(3),
        33550: doubles(step / METRES_PER_DEGREE[0], step / METRES_PER_DEGREE[1], 0.0),
        33922: doubles(0.0, 0.0, 0.0, longitude, latitude, 0.0),
        34735: shorts(1, 1, 1, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326),
    }  # fmt: skip
    start = 8 + len(data) + len(data) % 2
    after = start + 2 + 12 * len(tags) + 4
    entries, extra = b"", b""
    for tag, (kind, count, value) in sorted(tags.items()):
        field = value.ljust(4, b"\0")
        if len(value) > 4:
            field = struct.pack("<I", after + len(extra))
            extra += value + b"\0" * (len(value) % 2)
        entries += struct.pack("<HHI", tag, kind, count) + field
    head = b"II*\0" + struct.pack("<I", start) + data.ljust(start - 8, b"\0")
    path.write_bytes(head + struct.pack("<H", len(tags)) + entries + b"\0\0\0\0" + extra)


def noise(scale_m, seed):
    """Returns smooth noise of the picture's size in 0 to 1: random values on a lattice, interpolated."""

    def value(i, j):
        h = (i * 374761393 + j * 668265263 + seed * 974711) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((h ^ (h >> 16)) & 0xFFFF) / 65535.0

    u, v = np.meshgrid((X + 1000) / scale_m, (Y + 1000) / scale_m)
    i, j = u.astype(np.int64), v.astype(np.int64)
    s, t = smooth(u - i), smooth(v - j)
    low = value(i, j) * (1 - s) + value(i + 1, j) * s
    return low * (1 - t) + (value(i, j + 1) * (1 - s) + value(i + 1, j + 1) * s) * t


def write_picture(path, picture):
    """Writes a PNG with a palette and its world file."""
    mixed = 0.45 * noise(9.0, 1) + 0.35 * noise(2.6, 2) + 0.2 * noise(1.2, 3)
    shade = np.clip((mixed - 0.3) / 0.4 * 4, 0, 3.99).astype(np.uint8)
    rows_of_crops = ((X[None, :] * 0.35 + Y[:, None]) / 3.2 % 1 < 0.5).astype(np.uint8)
    for name in ("field", "crop"):
        where = picture == NUMBER[name]
        shade[where] = (shade // 2 + 2 * rows_of_crops)[where]
    for name in ("mark", "asphalt", "lot", "paving", "tile", "tile_dark", "slate", "zinc", "gravel", "felt"):
        where = picture == NUMBER[name]
        shade[where] = (shade // 2 + 1)[where]
    palette = b"".join(
        bytes(min(255, round(channel * (0.86 + 0.09 * k))) for channel in colour)
        for colour in COLOURS.values()
        for k in range(4)
    )
    indices = picture * 4 + shade

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    raw = b"".join(b"\0" + row.tobytes() for row in indices)
    header = struct.pack(">IIBBBBB", COLUMNS, ROWS, 8, 3, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", palette)
                     + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))  # fmt: skip
    latitude, longitude = degrees(X[0], Y[0])
    world = (CELL / METRES_PER_DEGREE[0], 0.0, 0.0, -CELL / METRES_PER_DEGREE[1], longitude, latitude)
    path.with_suffix(".pgw").write_text("".join(f"{value:.14f}\n" for value in world))


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    village = Village()
    (folder / "village.osm").write_text(village.osm.text())
    write_terrain(folder / "village_terrain.tif")
    write_picture(folder / "village_ortho.png", village.picture)
    print(f"{village.houses} houses; {len(village.osm.ways)} ways, {len(village.osm.tagged)} points")


if __name__ == "__main__":
    main()
