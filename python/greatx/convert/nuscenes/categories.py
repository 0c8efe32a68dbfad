# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Names nuScenes' categories, attributes and visibilities, and maps our semantic classes to them.

nuScenes' taxonomy is closed: the development kit has a colour for each of the 32 categories of
nuScenes-lidarseg and refuses other names when it loads point labels (nuscenes/utils/color_map.py). All
classes are therefore mapped to these names. What has no name of its own, such as a drone, becomes
static.other, which nuScenes defines as what matches no other label.
"""

from __future__ import annotations

from typing import Dict, List, Tuple

#: All categories in the order of their index in nuScenes-lidarseg.
CATEGORIES: Tuple[str, ...] = (
    "noise",
    "animal",
    "human.pedestrian.adult",
    "human.pedestrian.child",
    "human.pedestrian.construction_worker",
    "human.pedestrian.personal_mobility",
    "human.pedestrian.police_officer",
    "human.pedestrian.stroller",
    "human.pedestrian.wheelchair",
    "movable_object.barrier",
    "movable_object.debris",
    "movable_object.pushable_pullable",
    "movable_object.trafficcone",
    "static_object.bicycle_rack",
    "vehicle.bicycle",
    "vehicle.bus.bendy",
    "vehicle.bus.rigid",
    "vehicle.car",
    "vehicle.construction",
    "vehicle.emergency.ambulance",
    "vehicle.emergency.police",
    "vehicle.motorcycle",
    "vehicle.trailer",
    "vehicle.truck",
    "flat.driveable_surface",
    "flat.other",
    "flat.sidewalk",
    "flat.terrain",
    "static.manmade",
    "static.other",
    "static.vegetation",
    "vehicle.ego",
)

#: The category of the annotations of our classes; other classes are not annotated unless --category names
#: one.
ANNOTATED: Dict[str, str] = {
    "vehicle": "vehicle.car",
    "person": "human.pedestrian.adult",
    "uav": "static.other",
}

#: The category of the LiDAR points of our classes.
POINTS: Dict[str, str] = {
    "unlabeled": "static.other",
    "ground": "flat.terrain",
    "road": "flat.driveable_surface",
    "pavement": "flat.sidewalk",
    "lane_marking": "flat.driveable_surface",
    "building": "static.manmade",
    "roof": "static.manmade",
    "window": "static.manmade",
    "vegetation": "static.vegetation",
    "pole": "static.manmade",
    "street_lamp": "static.manmade",
    "mast": "static.manmade",
    "vehicle": "vehicle.car",
    "uav": "static.other",
    "water": "flat.other",
    "furniture": "static.manmade",
    "person": "human.pedestrian.adult",
}

#: Names and meanings of attributes.
ATTRIBUTES: Tuple[Tuple[str, str], ...] = (
    ("vehicle.moving", "The vehicle moves."),
    ("vehicle.stopped", "The vehicle stands and belongs to a node that can move."),
    ("vehicle.parked", "The vehicle is part of the static scene."),
    ("pedestrian.moving", "The person moves."),
    ("pedestrian.standing", "The person stands."),
    ("pedestrian.sitting_lying_down", "Not used."),
    ("cycle.with_rider", "Not used."),
    ("cycle.without_rider", "Not used."),
)

#: Tokens, levels and upper ends (share of visible pixels) of visibilities.
VISIBILITIES: Tuple[Tuple[str, str, float], ...] = (
    ("1", "v0-40", 0.4),
    ("2", "v40-60", 0.6),
    ("3", "v60-80", 0.8),
    ("4", "v80-100", 1.0),
)

#: Speed above which an object moves, m/s.
MOVING_M_S = 0.1


def visibility_token(share: float) -> str:
    """Returns the token of the visibility of an object, of which this share is visible."""
    for token, _, end in VISIBILITIES[:-1]:
        if share < end:
            return token
    return VISIBILITIES[-1][0]


def attributes(category: str, node: int, speed: float) -> List[str]:
    """Returns the names of the attributes of an object: one for vehicles and persons, none for others."""
    moving = speed > MOVING_M_S
    if category.startswith("vehicle.") and category not in ("vehicle.bicycle", "vehicle.motorcycle"):
        return ["vehicle.moving" if moving else "vehicle.parked" if node < 0 else "vehicle.stopped"]
    if category.startswith("human.pedestrian."):
        return ["pedestrian.moving" if moving else "pedestrian.standing"]
    return []
