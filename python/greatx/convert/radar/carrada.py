# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a radar in the folder layout of CARRADA (Ouaknine et al., "CARRADA Dataset: Camera and Automotive
Radar with Range-Angle-Doppler Annotations", ICPR 2020), which the loaders of CARRADA and MVRSS read.

Conventions of CARRADA, after its published code: range-Doppler and angle-Doppler maps have their first row at
range 0 and at the leftmost angle; range-angle maps have the farthest range in their first row; angles grow to
the right. Data flow: a record's maps, turned to these axes -> .npy files; its detections, by the classes of
their instances -> points -> boxes and masks, as CARRADA's annotation generator makes them.
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np

from ...dataset import Dataset, Record, Sensor, Sequence
from ...errors import DatasetError
from ...files import interpreting
from ..common import Command
from ..folders import Progress, new_folder
from ..objects import class_arguments
from ..poses import node_of, nodes_of
from ..rig import sequences_of
from .source import Pictures, arguments, class_of_instance, detections, pick, pick_radar
from .spectrum import WINDOWS, Axes, axes_of, beams, has_beams, spectrum

#: CARRADA's labels; masks have a plane for each, and plane 0 for the background.
LABELS = {"pedestrian": 1, "cyclist": 2, "car": 3}
#: Labels of semantic classes. Other objects are not annotated.
CLASSES = {"person": "pedestrian", "vehicle": "car"}
SPLITS = ("Train", "Validation", "Test")
VIEWS = ("range_doppler", "range_angle")
#: A dense mask reaches this many cells from a point (generate_annotations.py: distance < 3).
REACH = 3
#: dBm of a cell without power.
FLOOR_DBM = -300.0


def write_carrada(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    radar: Optional[str] = None,
    camera: Optional[str] = None,
    sequence: Optional[int] = None,
    split: str = "Train",
    classes: Optional[Dict[str, str]] = None,
    pictures: bool = True,
    window: str = "hann",
) -> Dict[str, int]:
    """Writes OUT/sequence_0000, ... and the lists of sequences and annotations beside them.

    camera    whose pictures are written, by default the only one of the radar's node
    split     of all sequences: Train, Validation or Test
    classes   labels of semantic classes, by default CLASSES
    pictures  whether to write the camera's pictures, which needs Pillow
    window    of the transforms for angle_doppler, which needs the output `cube`

    Returns counts of the written objects. Raises DatasetError, FileExistsError, or ImportError.
    """
    if split not in SPLITS or window not in WINDOWS:
        raise DatasetError(
            f"expected a split of {', '.join(SPLITS)} and a known window, found {split}, {window}"
        )
    classes = CLASSES if classes is None else classes
    for kind, label in classes.items():
        if label not in LABELS:
            raise DatasetError(f"class {kind}: expected a label of {', '.join(LABELS)}, found {label!r}")
    radar = pick_radar(dataset, radar)
    node = node_of(radar, nodes_of(dataset.sequences[0]))
    camera = (
        pick(dataset, "camera", camera, "--camera", node if camera is None else None) if pictures else None
    )
    jpeg = Pictures(camera is not None)
    sequences = sequences_of(dataset, sequence)
    for each in sequences:
        if len(each[radar]) == 0:
            raise DatasetError(f"{each.path}: {radar}: expected records, found none")
        axes_of(each[radar])
    counts = {"sequences": len(sequences), "frames": 0, "annotated instances": 0, "pictures": 0}
    counts["angle-Doppler maps"] = 0
    progress = Progress(sum(len(s[radar]) for s in sequences), "frames")
    with new_folder(out) as root:
        annotations: Dict[str, Any] = {}
        for each in sequences:
            writer = _Sequence(root / each.path.name, each[radar], classes, window, counts, progress)
            annotations[each.path.name] = writer.write()
            if camera is not None:
                counts["pictures"] += _write_pictures(root / each.path.name, each, radar, camera, jpeg)
        _write_lists(root, annotations, split)
    progress.end()
    return counts


class _Sequence:
    def __init__(
        self,
        folder: pathlib.Path,
        sensor: Sensor,
        classes: Dict[str, str],
        window: str,
        counts: Dict[str, int],
        progress: Progress,
    ):
        self._folder, self._sensor, self._classes, self._window = folder, sensor, classes, window
        self._counts, self._progress = counts, progress
        self._axes = axes_of(sensor)
        self._beams = has_beams(sensor)

    def write(self) -> Dict[str, Any]:
        """Writes the maps, and returns the annotations by frame."""
        names = ["range_doppler", "range_angle"] + ["angle_doppler"] * self._beams
        for name in names:
            for form in ("raw", "processed"):
                (self._folder / f"{name}_{form}").mkdir(parents=True)
        annotations: Dict[str, Any] = {}
        for number, record in enumerate(self._sensor):
            frame = f"{number:06d}"
            with interpreting(self._sensor.sequence.path / self._sensor.name):
                for name, power in self._maps(record).items():
                    np.save(self._folder / f"{name}_raw" / f"{frame}.npy", power.astype(np.float32))
                    np.save(self._folder / f"{name}_processed" / f"{frame}.npy", dbm(power))
                annotations[frame] = self._annotate(record)
            self._write_masks(frame, annotations[frame])
            self._counts["frames"] += 1
            self._counts["angle-Doppler maps"] += self._beams
            self._counts["annotated instances"] += len(annotations[frame])
            self._progress.step()
        self._write_axes()
        return annotations

    def _maps(self, record: Record) -> Dict[str, np.ndarray]:
        maps = {
            "range_doppler": np.asarray(record["range_doppler"], np.float64),
            "range_angle": np.asarray(record["range_azimuth"], np.float64)[::-1, ::-1],
        }
        if self._beams:
            values = spectrum(np.asarray(record["cube"]), self._window)
            power = beams(values, self._sensor, self._axes.azimuth_rad)
            maps["angle_doppler"] = np.sum(power, axis=0)[::-1]
        return maps

    def _annotate(self, record: Record) -> Dict[str, Any]:
        """Returns the annotations of a frame by instance."""
        dataset, axes = record.sensor.sequence.dataset, self._axes
        points: Dict[int, Dict[str, List[Tuple[int, int]]]] = {}
        for each in detections(record):
            if each.instance == 0 or class_of_instance(dataset, each.instance) not in self._classes:
                continue
            cells = points.setdefault(each.instance, {view: [] for view in VIEWS})
            row = _cell(axes.range_m, each.range_m)
            cells["range_doppler"].append((row, _cell(axes.velocity_m_s, each.velocity_m_s)))
            column = len(axes.azimuth_rad) - 1 - _cell(axes.azimuth_rad, each.azimuth_rad)
            cells["range_angle"].append((len(axes.range_m) - 1 - row, column))
        shapes = self._shapes()
        return {
            str(instance): {
                view: annotation(cells[view], shapes[view], self._label(instance)) for view in VIEWS
            }
            for instance, cells in sorted(points.items())
        }

    def _label(self, instance: int) -> int:
        return LABELS[self._classes[class_of_instance(self._sensor.sequence.dataset, instance)]]

    def _shapes(self) -> Dict[str, Tuple[int, int]]:
        ranges = len(self._axes.range_m)
        return {
            "range_doppler": (ranges, len(self._axes.velocity_m_s)),
            "range_angle": (ranges, len(self._axes.azimuth_rad)),
        }

    def _write_masks(self, frame: str, instances: Dict[str, Any]) -> None:
        """Writes the masks of all instances of a frame together: [label, row, column], of 0 and 1."""
        for form in ("sparse", "box", "dense"):
            folder = self._folder / "annotations" / form / frame
            folder.mkdir(parents=True)
            for view, shape in self._shapes().items():
                mask = np.zeros((1 + len(LABELS), *shape), np.uint8)
                for entry in instances.values():
                    part = entry[view]
                    plane = mask[part["label"]]
                    if form == "box":
                        (top, left), (bottom, right) = part["box"]
                        plane[max(top, 0) : bottom + 1, max(left, 0) : right + 1] = 1
                    else:
                        rows, columns = np.array(part[form]).T
                        plane[rows, columns] = 1
                mask[0] = 1 - mask[1:].max(axis=0)
                np.save(folder / f"{view}.npy", mask)

    def _write_axes(self) -> None:
        axes: Axes = self._axes
        left_first = (-axes.azimuth_rad[::-1]).tolist()
        value = {
            "range_doppler": {
                "rows_range_m": axes.range_m.tolist(),
                "columns_velocity_m_s": axes.velocity_m_s.tolist(),
            },
            "range_angle": {
                "rows_range_m": axes.range_m[::-1].tolist(),
                "columns_angle_right_rad": left_first,
            },
            "angle_doppler": {
                "rows_angle_right_rad": left_first,
                "columns_velocity_m_s": axes.velocity_m_s.tolist(),
            },
            "velocity": "positive receding",
            "raw": "W, linear",
            "processed": f"dBm, {FLOOR_DBM} where there is no power",
            "time_ns": self._sensor.index[:, 1].tolist(),
            "ticks": self._sensor.ticks.tolist(),
        }
        (self._folder / "axes.json").write_text(json.dumps(value) + "\n", encoding="utf-8")


def dbm(power_w: np.ndarray) -> np.ndarray:
    """Returns 10 lg(1000 P), float32; FLOOR_DBM where P is 0."""
    with np.errstate(divide="ignore"):
        return np.maximum(10 * np.log10(1000 * power_w), FLOOR_DBM).astype(np.float32)


def _cell(values: np.ndarray, value: float) -> int:
    """Returns the cell of an even axis that is nearest to a value."""
    step = values[1] - values[0] if len(values) > 1 else 1.0
    return int(np.clip(np.rint((value - values[0]) / step), 0, len(values) - 1))


def annotation(points: List[Tuple[int, int]], shape: Tuple[int, int], label: int) -> Dict[str, Any]:
    """Returns sparse points, their box [[row, column], [row, column]] and the cells within REACH of one of
    them. A box of no extent grows by a cell on both sides."""
    cells = np.array(sorted(set(points)))
    low, high = cells.min(axis=0), cells.max(axis=0)
    flat = low == high
    low, high = low - flat, high + flat
    rows, columns = np.mgrid[1 - REACH : REACH, 1 - REACH : REACH]
    near = rows**2 + columns**2 < REACH**2
    disc = np.stack([rows[near], columns[near]], -1)
    dense = np.unique((cells[:, None] + disc[None]).reshape(-1, 2), axis=0)
    dense = dense[np.all((dense >= 0) & (dense < shape), axis=1)]
    return {
        "sparse": cells.tolist(),
        "box": [low.tolist(), high.tolist()],
        "dense": dense.tolist(),
        "label": label,
    }


def _write_pictures(folder: pathlib.Path, sequence: Sequence, radar: str, camera: str, jpeg: Pictures) -> int:
    """Writes the camera's picture at the tick of each radar frame that has one."""
    target = folder / "camera_images"
    target.mkdir()
    rows = {int(tick): row for row, tick in enumerate(sequence[camera].ticks)}
    written = 0
    for number, tick in enumerate(sequence[radar].ticks):
        if int(tick) in rows:
            jpeg.write(target / f"{number:06d}.jpg", np.asarray(sequence[camera]["rgb"][rows[int(tick)]]))
            written += 1
    return written


def _write_lists(root: pathlib.Path, by_frame: Dict[str, Any], split: str) -> None:
    by_instance: Dict[str, Any] = {}
    reference: Dict[str, Any] = {}
    for name, frames in by_frame.items():
        instances: Dict[str, Any] = {}
        for frame, entries in frames.items():
            for instance, entry in entries.items():
                instances.setdefault(instance, {})[frame] = entry
        by_instance[name] = instances
        labels = [next(iter(of.values()))["range_doppler"]["label"] for of in instances.values()]
        reference[name] = {"split": split, "instances": list(instances), "labels": labels}
    annotated = {name: [f for f, entries in frames.items() if entries] for name, frames in by_frame.items()}
    for file, value in (
        ("data_seq_ref.json", reference),
        ("annotations_frame_oriented.json", by_frame),
        ("annotations_instance_oriented.json", by_instance),
        ("light_dataset_frame_oriented.json", annotated),
    ):
        (root / file).write_text(json.dumps(value) + "\n", encoding="utf-8")
    (root / "validated_seqs.txt").write_text("".join(f"{name}\n" for name in by_frame), encoding="utf-8")


def _arguments(parser: argparse.ArgumentParser) -> None:
    arguments(parser)
    parser.add_argument("--split", choices=SPLITS, default="Train", help="of all sequences; default: Train")
    parser.add_argument(
        "--class",
        dest="classes",
        action="append",
        metavar="CLASS=LABEL",
        help="label (pedestrian, cyclist, car) of a semantic class; may be repeated; "
        "default: person=pedestrian vehicle=car",
    )


COMMAND = Command(
    "carrada",
    "radar maps and annotations in CARRADA's layout",
    lambda dataset, given: write_carrada(
        dataset,
        given.OUT,
        given.radar,
        given.camera,
        given.sequence,
        given.split,
        class_arguments(given.classes, CLASSES, "--class"),
        not given.no_pictures,
        given.window,
    ),
    _arguments,
)
