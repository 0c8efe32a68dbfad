# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the messages of boxes and of radio paths, and the table of a channel's statistics."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Tuple

import numpy as np

from ...dataset import Record
from ...links import antenna_pose, paths_of, receivers, transmitters
from ..objects import instance_name, seen
from .messages import WORLD, Named
from .output import Foxglove, plain, table

#: Colours of boxes by class, red, green, blue; others are grey.
COLOURS = {"vehicle": (0.12, 0.47, 0.71), "person": (0.84, 0.15, 0.16), "uav": (0.58, 0.40, 0.74)}
#: Lines of paths fade over this range of power below the strongest path of a record, dB.
FADE_DB = 40.0


def _update(fox: Foxglove, time: Any, entities: List[Any]) -> Any:
    """Returns an update that replaces all entities of its topic."""
    from foxglove_schemas_protobuf.SceneEntityDeletion_pb2 import SceneEntityDeletion

    clear = SceneEntityDeletion(timestamp=time, type=SceneEntityDeletion.ALL)
    return fox.SceneUpdate(deletions=[clear], entities=entities)


def box_messages(fox: Foxglove, record: Record, time: Any) -> Iterator[Named]:
    """Gives the boxes of the objects in a camera's picture, in the world. Hidden ones are faint."""
    if "box_instance" not in record.sensor.arrays:
        return
    dataset = record.sensor.sequence.dataset
    entities = []
    for each in seen(record):
        red, green, blue = COLOURS.get(each.kind, (0.6, 0.6, 0.6))
        cube = fox.CubePrimitive(
            pose=fox.pose(each.world_from_box),
            size=fox.vector(each.size),
            color=fox.Color(r=red, g=green, b=blue, a=0.15 + 0.45 * each.visibility),
        )
        entity = fox.SceneEntity(
            timestamp=time, frame_id=WORLD, id=instance_name(dataset, each.instance), cubes=[cube]
        )
        for key, value in (
            ("class", each.kind),
            ("instance", str(each.instance)),
            ("visibility", repr(each.visibility)),
        ):
            entity.metadata.add(key=key, value=value)
        entities.append(entity)
    yield f"/{record.sensor.name}/boxes", _update(fox, time, entities)


def path_lines(record: Record, most: int) -> Tuple[List[Tuple[np.ndarray, float]], int]:
    """Returns the points [k, 3] of the strongest paths, from the transmitter to the receiver, with their
    power below the strongest one in dB (0 or less), and the number of paths that are left out."""
    paths = paths_of(record)
    count = len(paths["delay"])
    power = (
        np.mean(np.abs(paths["amplitude"].reshape(count, -1).astype(complex)) ** 2, axis=1) if count else []
    )
    order = np.argsort(-np.asarray(power), kind="stable")[:most]
    starts = [antenna_pose(record, end)[0] for end in transmitters(record.sensor)]
    ends = [antenna_pose(record, end)[0] for end in receivers(record.sensor)]
    lines = []
    for i in order:
        vertices = np.asarray(paths["vertex"][i])
        vertices = vertices[np.all(np.isfinite(vertices), axis=1)]
        tx = int(paths["tx"][i]) if "tx" in paths else 0
        points = np.vstack([starts[tx], vertices, ends[int(paths["rx"][i])]])
        with np.errstate(divide="ignore"):
            lines.append(
                (points, float(10 * np.log10(power[i] / power[order[0]])) if power[order[0]] else 0.0)
            )
    return lines, count - len(order)


def path_messages(
    fox: Foxglove, record: Record, time: Any, most: int, left_out: Dict[str, int]
) -> Iterator[Named]:
    arrays = record.sensor.arrays
    if not {"delay", "vertex", "amplitude", "rx"} <= set(arrays):
        return
    lines, more = path_lines(record, most)
    if more:
        key = f"{record.sensor.name}/paths (weakest)"
        left_out[key] = left_out.get(key, 0) + more
    entities = []
    for number, (points, below_db) in enumerate(lines):
        strength = float(np.clip(1 + below_db / FADE_DB, 0.0, 1.0))
        line = fox.LinePrimitive(
            type=fox.LinePrimitive.LINE_STRIP,
            thickness=1.5,
            scale_invariant=True,
            points=[fox.point(p) for p in points],
            color=fox.Color(r=1.0, g=0.85 * strength, b=0.1, a=0.15 + 0.85 * strength),
        )
        entity = fox.SceneEntity(timestamp=time, frame_id=WORLD, id=f"path {number}", lines=[line])
        entity.metadata.add(key="below the strongest, dB", value=repr(below_db))
        entities.append(entity)
    yield f"/{record.sensor.name}/paths", _update(fox, time, entities)


#: Names of the statistics' columns that are powers or ratios, in dB.
_IN_DB = {"path_gain": "path_gain_db", "k_factor": "k_factor_db"}


def statistics(record: Record) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """Returns the JSON schema and the value of all arrays [rx, tx] of a channel's record."""
    arrays = {
        name: np.asarray(record[name])
        for name, info in record.sensor.arrays.items()
        if len(info.shape) == 2 and -1 not in info.shape and info.dtype.kind in "iuf"
    }
    names = ["rx", "tx", *(_IN_DB.get(name, name) for name in arrays)]
    schema = table(
        names, {n: "string" if n in ("rx", "tx") else "number" for n in names}, "links of a channel"
    )
    links = []
    for i, rx in enumerate(receivers(record.sensor)):
        for j, tx in enumerate(transmitters(record.sensor)):
            row: Dict[str, Any] = {"rx": rx["name"], "tx": tx["name"]}
            for name, values in arrays.items():
                value = values[i, j]
                if name in _IN_DB:
                    with np.errstate(divide="ignore", invalid="ignore"):
                        value = 10 * np.log10(value)
                row[_IN_DB.get(name, name)] = plain(value)
            links.append(row)
    return schema, {"links": links}
