# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the boxes of a camera's record (docs/truth.md, "Boxes") as objects with names and classes, and knows
where an object is at ticks at which no camera sees it.

An object is identified by its first instance, which is the same in all records of a sequence. The box of an
object that follows a node never changes in the node's frame, and that of a static object never changes in
the world. `Inventory` uses this: it collects the objects that any camera of a sequence has a box for, and
gives their boxes at every tick.
"""

from __future__ import annotations

import argparse
import dataclasses
from typing import Dict, Iterable, Iterator, List, Optional

import numpy as np

from ..dataset import Dataset, Record, Sequence
from ..errors import DatasetError
from ..links import rotation
from .poses import Pose
from .rig import Track

#: Boxes touch their objects, so that points on a face lie in or out by their rounding. Points this near count
#: as inside, m.
ON_FACE = 1e-3


@dataclasses.dataclass(frozen=True)
class Seen:
    """Describes an object in a camera's picture. Pixel i reaches from i to i + 1."""

    instance: int  #: first id in `instance` pictures
    count: int  #: number of ids, which follow one another
    kind: str  #: semantic class
    node: int  #: index into the nodes of the poses; -1: never moves
    world_from_box: Pose
    sensor_from_box: Pose  #: in the frame of the camera with the axes of a body (x forward, y left, z up)
    size: np.ndarray  #: float64 [3] m: extent along the box's own x, y, z
    amodal: np.ndarray  #: float64 [4]: u_min, v_min, u_max, v_max
    modal: np.ndarray  #: int64 [4]
    visible_pixels: int
    visibility: float  #: 0 to 1
    truncation: float  #: 0 to 1


def has_boxes(sequence: Sequence, camera: str) -> bool:
    return "box_instance" in sequence[camera].arrays


def require_boxes(sequence: Sequence, camera: str, otherwise: str) -> None:
    """Raises DatasetError if the camera has no boxes; `otherwise` says what else a user may do."""
    if not has_boxes(sequence, camera):
        raise DatasetError(
            f"{sequence.dataset.path}: {camera}: expected boxes of objects (output boxes of the camera), "
            f"found none; {otherwise}"
        )


def class_name(dataset: Dataset, number: int) -> str:
    """Returns the name of a semantic class by its number in `semantic` arrays."""
    names = dataset.semantic_classes
    if not 0 <= number < len(names):
        raise DatasetError(f"{dataset.path}: expected a semantic class below {len(names)}, found {number}")
    return names[number]


def seen(record: Record) -> List[Seen]:
    """Returns all objects of a camera's record that has boxes, in their order."""
    dataset = record.sensor.sequence.dataset
    keys = "instance instance_count semantic node center size orientation sensor_center sensor_orientation"
    keys += " amodal modal visible_pixels visibility truncation"
    a = {key: np.array(record["box_" + key]) for key in keys.split()}
    lengths = {len(value) for value in a.values()}
    if len(lengths) != 1:
        raise DatasetError(f"{record.sensor.sequence.path / record.sensor.name}: boxes differ in number")
    out = []
    for i in range(lengths.pop()):
        out.append(
            Seen(
                int(a["instance"][i]),
                int(a["instance_count"][i]),
                class_name(dataset, int(a["semantic"][i])),
                int(a["node"][i]),
                Pose(a["center"][i].astype(np.float64), rotation(a["orientation"][i])),
                Pose(a["sensor_center"][i].astype(np.float64), rotation(a["sensor_orientation"][i])),
                a["size"][i].astype(np.float64),
                a["amodal"][i].astype(np.float64),
                a["modal"][i].astype(np.int64),
                int(a["visible_pixels"][i]),
                float(a["visibility"][i]),
                float(a["truncation"][i]),
            )
        )
    return out


def instance_name(dataset: Dataset, instance: int) -> str:
    """Returns the name of an instance by its id in `instance` pictures."""
    instances = dataset.instances
    if not 1 <= instance <= len(instances):
        raise DatasetError(
            f"{dataset.path}: expected an instance from 1 to {len(instances)}, found {instance}"
        )
    return str(instances[instance - 1].get("name", instance))


@dataclasses.dataclass(frozen=True)
class Thing:
    """Describes an object of a sequence. `anchor_from_box` is in the frame of its node, or in the world."""

    instance: int
    kind: str
    node: int
    anchor_from_box: Pose
    size: np.ndarray


class Inventory:
    """Holds the objects of some classes that cameras of a sequence have boxes for, in order of instances."""

    def __init__(self, sequence: Sequence, cameras: Iterable[str], classes: Iterable[str], track: Track):
        wanted = set(classes)
        things: Dict[int, Thing] = {}
        for name in cameras:
            if not has_boxes(sequence, name):
                continue
            for record in sequence[name]:
                for each in seen(record):
                    if each.instance in things or each.kind not in wanted:
                        continue
                    pose = each.world_from_box
                    if each.node >= 0:
                        pose = track.pose(each.node, record.tick).inverse() @ pose
                    things[each.instance] = Thing(each.instance, each.kind, each.node, pose, each.size)
        self._track = track
        self.things = [things[key] for key in sorted(things)]

    def __iter__(self) -> Iterator[Thing]:
        return iter(self.things)

    def world_from_box(self, thing: Thing, tick: int) -> Pose:
        if thing.node < 0:
            return thing.anchor_from_box
        return self._track.pose(thing.node, tick) @ thing.anchor_from_box

    def speed(self, thing: Thing, tick: int) -> float:
        """Returns the speed of the object's node, m/s; 0 for a static object."""
        if thing.node < 0:
            return 0.0
        return float(np.linalg.norm(self._track.vector("velocity", thing.node, tick)))


def points_inside(points: np.ndarray, frame_from_box: Pose, size: np.ndarray, axes: int = 3) -> np.ndarray:
    """Returns a mask [n] of the points [n, 3] of a frame that lie in a box or within ON_FACE of it. With
    axes = 2 the box has no bottom and no top."""
    at_box = frame_from_box.inverse().apply(points)
    return np.all(np.abs(at_box[:, :axes]) <= size[:axes] / 2 + ON_FACE, axis=1)


def class_argument(parser: argparse.ArgumentParser, name: str, help: str, default: Dict[str, str]) -> None:
    """Adds the option --NAME CLASS=NAME for class_arguments(). `help`: what the option gives a class."""
    parser.add_argument(
        f"--{name}",
        action="append",
        metavar=f"CLASS={name.upper()}",
        help=f"{help}, for each class that differs from "
        + ", ".join(f"{key}={value}" for key, value in default.items())
        + f"; an empty {name} leaves a class out",
    )


def class_arguments(pairs: Optional[List[str]], default: Dict[str, str], option: str) -> Dict[str, str]:
    """Returns the default map of classes, changed by arguments CLASS=NAME; an empty NAME leaves a class out.
    Raises DatasetError for an argument of another form."""
    out = dict(default)
    for pair in pairs or []:
        name, separator, value = pair.partition("=")
        if not separator or not name or any(c.isspace() for c in pair):
            raise DatasetError(f"{option}: expected CLASS=NAME without spaces, found {pair!r}")
        if value:
            out[name] = value
        else:
            out.pop(name, None)
    return out
