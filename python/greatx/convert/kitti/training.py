# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the training folders of KITTI's object and tracking benchmarks.

    object    OUT/training/image_2/000000.png  velodyne/000000.bin  calib/000000.txt  label_2/000000.txt
              OUT/frames.csv: the sequence, tick and time of each frame
    tracking  OUT/training/image_02/0000/000000.png  velodyne/0000/000000.bin  calib/0000.txt  oxts/0000.txt
              label_02/0000.txt

With a stereo pair there are image_3 and image_03, too. The frames of all sequences follow one another in the
object layout; the tracking layout has a number for each sequence. Labels need the camera's boxes.
"""

from __future__ import annotations

import argparse
import math
import os
import pathlib
from typing import Any, Dict, List, Optional, Union

from ...dataset import Dataset, Record, Sequence
from ...geodesy import LocalFrame
from ..common import Command
from ..folders import Progress, new_folder
from ..objects import class_arguments, require_boxes
from ..rig import Track, time_ns
from . import calibration as files
from .labels import TYPES, Label, labels, type_argument
from .oxts import DEFAULT_PLACE, Places, line, local_frame, packet
from .source import Source, check_numbers, choice, choose, source_arguments


class _Labels:
    """Makes the labels of records, and counts them."""

    def __init__(self, source: Source, types: Optional[List[str]], without_labels: bool):
        self._types = class_arguments(types, TYPES, "--type")
        self._source, self._on = source, not without_labels
        self.count, self.tilt = 0, 0.0
        if self._on:
            for sequence in source.sequences:
                require_boxes(sequence, source.left, "--without-labels writes no labels")

    def of(self, record: Record) -> List[Label]:
        found = labels(record if self._on else None, self._types, self._source.calibration)
        self.count += len(found)
        self.tilt = max([self.tilt, *(each.tilt for each in found)])
        return found

    def __bool__(self) -> bool:
        return self._on


def _summary(counts: Dict[str, Any], made: _Labels) -> Dict[str, Any]:
    counts["labels"] = made.count
    counts["degrees of tilt lost at most"] = round(math.degrees(made.tilt), 3)
    return counts


def write_kitti_object(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    types: Optional[List[str]] = None,
    without_labels: bool = False,
    **chosen: Any,
) -> Dict[str, Any]:
    """Writes the training folder of the object benchmark. Returns counts of the written objects and the
    largest tilt of a box in degrees, which labels do not hold (see labels.py).

    `types` are CLASS=TYPE, which add to or change labels.TYPES; an empty TYPE leaves a class out. The other
    arguments are those of source.choose(). Raises DatasetError, for example if the camera has no boxes and
    `without_labels` is not set, or FileExistsError if `out` is not empty.
    """
    source = choose(dataset, **chosen)
    made = _Labels(source, types, without_labels)
    counts: Dict[str, Any] = {"frames": 0, "points": 0}
    progress = Progress(sum(len(source.ticks(s)) for s in source.sequences), "frames")
    table = ["frame,sequence,tick,time_ns\n"]
    with new_folder(out) as root:
        folder = root / "training"
        for name in ["calib"] + ["label_2"] * bool(made):
            (folder / name).mkdir(parents=True)
        for sequence in source.sequences:
            track = Track(sequence)
            for tick in (int(tick) for tick in source.ticks(sequence)):
                name = f"{counts['frames']:06d}"
                for camera in source.cameras():
                    source.picture(sequence, camera, tick, folder / f"image_{camera}/{name}.png")
                if source.lidar:
                    target = folder / f"velodyne/{name}.bin"
                    counts["points"] += source.velodyne(sequence, tick, track, target)
                (folder / f"calib/{name}.txt").write_text(files.object_(source.calibration))
                if made:
                    lines = "".join(each.line() + "\n" for each in made.of(sequence[source.left].at(tick)))
                    (folder / f"label_2/{name}.txt").write_text(lines)
                table.append(f"{name},{sequence.number},{tick},{time_ns(sequence, tick)}\n")
                counts["frames"] += 1
                progress.step()
        (root / "frames.csv").write_text("".join(table))
    progress.end()
    return _summary(counts, made)


def write_kitti_tracking(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    types: Optional[List[str]] = None,
    without_labels: bool = False,
    **chosen: Any,
) -> Dict[str, Any]:
    """Writes the training folder of the tracking benchmark, like write_kitti_object. The number of a track is
    the object's first instance id."""
    source = choose(dataset, **chosen)
    check_numbers(source.sequences, 9999, "tracking sequences")
    made = _Labels(source, types, without_labels)
    counts: Dict[str, Any] = {"sequences": 0, "frames": 0, "points": 0}
    progress = Progress(sum(len(source.ticks(s)) for s in source.sequences), "frames")
    with new_folder(out) as root:
        folder = root / "training"
        for name in ["calib", "oxts"] + ["label_02"] * bool(made):
            (folder / name).mkdir(parents=True)
        for sequence in source.sequences:
            _tracking_sequence(source, sequence, folder, made, counts, progress)
            counts["sequences"] += 1
    progress.end()
    return _summary(counts, made)


def _tracking_sequence(
    source: Source,
    sequence: Sequence,
    folder: pathlib.Path,
    made: _Labels,
    counts: Dict[str, Any],
    progress: Progress,
) -> None:
    number = f"{sequence.number:04d}"
    track = Track(sequence)
    node = track.nodes.index(source.rig.node)
    ticks = [int(tick) for tick in source.ticks(sequence)]
    first = track.pose(node, ticks[0]).position
    frame = local_frame(source.dataset, None)
    anchor = first if frame is None else 0 * first
    places = Places(frame or LocalFrame(*DEFAULT_PLACE), anchor, first, "mercator")
    label_lines, oxts_lines = [], []
    for k, tick in enumerate(ticks):
        for camera in source.cameras():
            source.picture(sequence, camera, tick, folder / f"image_{camera:02d}/{number}/{k:06d}.png")
        if source.lidar:
            target = folder / f"velodyne/{number}/{k:06d}.bin"
            counts["points"] += source.velodyne(sequence, tick, track, target)
        pose = track.pose(node, tick)
        oxts_lines.append(line(packet(pose, places.of(pose.position), track, node, tick)))
        if made:
            found = made.of(sequence[source.left].at(tick))
            label_lines += [each.tracking_line(k) + "\n" for each in found]
        counts["frames"] += 1
        progress.step()
    (folder / f"calib/{number}.txt").write_text(files.tracking(source.calibration))
    (folder / f"oxts/{number}.txt").write_text("".join(oxts_lines))
    if made:
        (folder / f"label_02/{number}.txt").write_text("".join(label_lines))


def _arguments(parser: argparse.ArgumentParser) -> None:
    source_arguments(parser)
    type_argument(parser)
    parser.add_argument("--without-labels", action="store_true", help="write no labels")


COMMANDS = tuple(
    Command(
        name,
        help_,
        lambda dataset, given, write=write: write(
            dataset, given.OUT, types=given.type, without_labels=given.without_labels, **choice(given)
        ),
        _arguments,
    )
    for name, help_, write in (
        ("kitti-object", "KITTI's object benchmark (label_2)", write_kitti_object),
        ("kitti-tracking", "KITTI's tracking benchmark (label_02)", write_kitti_tracking),
    )
)
