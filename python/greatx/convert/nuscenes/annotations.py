# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the rows of nuScenes' tables instance and sample_annotation.

An object that any camera of the node ever has a box for is annotated at every keyframe at which it is in
range, whether a camera or the LiDAR sees it or not: nuScenes' evaluation leaves out objects without points,
and trackers want whole tracks. Its visibility is the largest of all cameras at that tick, and the lowest
level if no camera has a box for it then. Points are counted in the keyframe's own files: LiDAR points of the
first LiDAR within the box; detections of all radars above and below its base, because most radars do not
resolve elevation. Velocities have no field: the development kit takes the difference of positions
(box_velocity).
"""

from __future__ import annotations

from typing import Dict, List, Protocol, Sequence as SequenceOf

import numpy as np

from ...dataset import Dataset, Sequence
from ..clouds import Cloud
from ..objects import Inventory, Thing, instance_name, points_inside, seen
from ..poses import Pose, mount
from ..rig import Rig, Track
from .categories import attributes, visibility_token
from .points import Detections
from .tables import Row, Tables, chain


class Export(Protocol):
    """Lists what the annotations take from an export. write.Writer is one."""

    dataset: Dataset
    rig: Rig
    tables: Tables
    samples: Dict[int, SequenceOf[int]]  #: ticks of the keyframes, by number of the sequence
    boxes: List[str]  #: cameras with boxes
    channels: Dict[str, str]  #: nuScenes' channels of sensors
    categories: Dict[str, str]  #: nuScenes' categories of classes
    range_m: float
    origin: np.ndarray  #: [3] m, of nuScenes' global frame in the world

    def first_lidar(self) -> str: ...


def annotate(
    writer: Export,
    sequence: Sequence,
    track: Track,
    things: Inventory,
    clouds: Dict[int, Cloud],
    echoes: Dict[int, Dict[str, Detections]],
) -> int:
    """Adds the annotations of a sequence. Returns their number."""
    rows: Dict[int, List[Row]] = {}
    for tick in writer.samples[sequence.number]:
        frame = _Keyframe(writer, sequence, track, tick, clouds, echoes)
        for thing in things:
            pose = things.world_from_box(thing, tick)
            if np.linalg.norm((pose.position - frame.world_from_body.position)[:2]) > writer.range_m:
                continue
            if thing.node == frame.node:
                continue  # the carrier itself
            rows.setdefault(thing.instance, []).append(frame.row(thing, pose, things.speed(thing, tick)))
    for thing in things:
        _instance(writer, sequence, thing, rows.get(thing.instance, []))
    return sum(len(each) for each in rows.values())


def _instance(writer: Export, sequence: Sequence, thing: Thing, rows: List[Row]) -> None:
    """Links the annotations of an object, and adds its instance if it has any."""
    if not rows:
        return
    chain(rows)
    writer.tables.add(
        "instance",
        writer.tables.token("instance", sequence.number, thing.instance),
        category_token=writer.tables.token("category", writer.categories[thing.kind]),
        nbr_annotations=len(rows),
        first_annotation_token=rows[0]["token"],
        last_annotation_token=rows[-1]["token"],
        greatx_name=instance_name(writer.dataset, thing.instance),
        greatx_class=thing.kind,
    )


class _Keyframe:
    """Makes the annotations of one tick."""

    def __init__(
        self,
        writer: Export,
        sequence: Sequence,
        track: Track,
        tick: int,
        clouds: Dict[int, Cloud],
        echoes: Dict[int, Dict[str, Detections]],
    ):
        self._writer, self._sequence, self._tick = writer, sequence, tick
        self.node = track.nodes.index(writer.rig.node)
        self.world_from_body = track.pose(self.node, tick)
        self._visible: Dict[int, float] = {}
        for camera in writer.boxes:
            for each in seen(sequence[camera].at(tick)):
                share = max(each.visibility, self._visible.get(each.instance, 0.0))
                self._visible[each.instance] = share
        self._lidar = np.empty((0, 3))
        if tick in clouds:
            name = next(n for n, c in writer.channels.items() if c == writer.first_lidar())
            world_from_lidar = self.world_from_body @ mount(sequence[name].record(0))
            self._lidar = world_from_lidar.apply(clouds[tick].points[:, :3])
        radar = [
            (self.world_from_body @ mount(sequence[name].record(0))).apply(found.points)
            for name, found in echoes.get(tick, {}).items()
        ]
        self._radar = np.concatenate(radar) if radar else np.empty((0, 3))

    def row(self, thing: Thing, pose: Pose, speed: float) -> Row:
        writer, number = self._writer, self._sequence.number
        category = writer.categories[thing.kind]
        length, width, height = thing.size.tolist()
        return writer.tables.add(
            "sample_annotation",
            writer.tables.token("sample_annotation", number, thing.instance, self._tick),
            sample_token=writer.tables.token("sample", number, self._tick),
            instance_token=writer.tables.token("instance", number, thing.instance),
            visibility_token=visibility_token(self._visible.get(thing.instance, 0.0)),
            attribute_tokens=[
                writer.tables.token("attribute", name) for name in attributes(category, thing.node, speed)
            ],
            translation=(pose.position - writer.origin).tolist(),
            size=[width, length, height],
            rotation=pose.quaternion.tolist(),
            num_lidar_pts=int(points_inside(self._lidar, pose, thing.size).sum()),
            num_radar_pts=int(points_inside(self._radar, pose, thing.size, axes=2).sum()),
        )
