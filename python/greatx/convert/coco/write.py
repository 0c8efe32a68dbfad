# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes pictures, masks and boxes in COCO's format, which pycocotools and most training code read.

    OUT/images/sequence_0000/uav/front/000000.png    as in the data set
    OUT/annotations/instances.json                   an entry for each visible object of each picture
    OUT/annotations/panoptic.json, panoptic/...png   all pixels: objects, and classes of what is no object

Data flow: cameras -> pictures -> the picture of instance ids becomes one of objects (a body with all its
parts is one object) -> masks, rectangles, areas. All sequences and cameras are written as one set of
pictures.

Annotations follow the visible pixels alone (COCO has no amodal boxes). Pixel i reaches from i to i + 1, as in
greatx, so the rectangle of the whole picture is [0, 0, w, h].
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
from typing import Any, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np

from ...dataset import Dataset, Record, Sequence
from ...errors import DatasetError
from ..common import Command, link_argument, sequence_argument
from ..folders import Progress, new_folder, place
from ..png import write_rgb
from ..rig import picture_file, sequences_of
from .rle import encode

#: Classes whose instances are no objects: those that have no boxes by default (docs/truth.md).
STUFF = "unlabeled ground road pavement lane_marking building roof window water".split()
#: Added to an object's number in panoptic pictures, below which are classes.
FIRST_OBJECT = 256


def write_coco(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    cameras: Optional[List[str]] = None,
    sequence: Optional[int] = None,
    things: Optional[List[str]] = None,
    panoptic: bool = True,
    link: bool = False,
) -> Dict[str, Any]:
    """Writes the pictures of all cameras that have rgb and ids, or of the given ones. Returns counts of the
    written objects. `things` are the classes whose instances are objects (default: all but STUFF). Raises
    DatasetError, or FileExistsError if `out` is not empty.
    """
    objects = _Objects(dataset, things)
    sequences = sequences_of(dataset, sequence)
    names, left_out = _cameras(dataset, cameras)
    pictures = sum(len(s[name]) for s in sequences for name in names)
    if pictures == 0:
        raise DatasetError(f"{dataset.path}: expected pictures of {', '.join(names)}, found none")
    progress = Progress(pictures, "pictures")
    head = {"description": f"greatx: {dataset.run.get('scenario', '')}", "version": "1"}
    instances = _Json(info=head, licenses=[], categories=objects.categories(False))
    whole = _Json(info=head, licenses=[], categories=objects.categories(True))
    with new_folder(out) as root:
        (root / "annotations").mkdir()
        for record, image in _images(sequences, names):
            place(picture_file(record), root / "images" / image["file_name"], link)
            instances.images.append(image)
            numbers, classes = objects.pictures(record)
            for each in _annotations(numbers, objects, image["id"], len(instances.annotations) + 1):
                instances.annotations.append(each)
            if panoptic:
                whole.images.append(image)
                whole.annotations.append(_panoptic(root, numbers, classes, objects, image))
            progress.step()
        instances.write(root / "annotations/instances.json")
        if panoptic:
            whole.write(root / "annotations/panoptic.json")
    progress.end()
    counts = {"pictures": len(instances.images), "annotations": len(instances.annotations)}
    return {**counts, **({"cameras without ids left out": left_out} if left_out else {})}


class _Json:
    """Holds a file of annotations."""

    def __init__(self, **head: Any):
        self._head = head
        self.images: List[Dict[str, Any]] = []
        self.annotations: List[Dict[str, Any]] = []

    def write(self, path: pathlib.Path) -> None:
        path.write_text(
            json.dumps({**self._head, "images": self.images, "annotations": self.annotations}) + "\n"
        )


def _has_ids(dataset: Dataset, name: str) -> bool:
    info = dataset.sensors[name]
    located = info.locate("rgb")
    return located is not None and located[0].format == "png" and {"instance", "semantic"} <= set(info.arrays)


def _cameras(dataset: Dataset, given: Optional[List[str]]) -> Tuple[List[str], int]:
    """Returns the cameras to write, and the number of those that have pictures but no ids."""
    all_ = [name for name, info in dataset.sensors.items() if info.kind == "camera"]
    for name in given or []:
        if name not in all_:
            raise DatasetError(
                f"{dataset.path}: has no camera {name!r}; cameras are {', '.join(all_) or 'none'}"
            )
    names = [name for name in (given or all_) if _has_ids(dataset, name)]
    if not names or (given and len(names) < len(given)):
        bad = ", ".join(name for name in (given or all_) if name not in names) or "no camera"
        raise DatasetError(
            f"{dataset.path}: expected a camera with the outputs rgb and ids, found {bad} without them"
        )
    return names, len(given or all_) - len(names)


def _images(sequences: List[Sequence], names: List[str]) -> Iterator[Tuple[Record, Dict[str, Any]]]:
    """Gives each picture's record and its entry, numbered from 1."""
    number = 0
    for sequence in sequences:
        for name in names:
            for record in sequence[name]:
                number += 1
                height, width = record.sensor.arrays["instance"].shape
                yield record, {
                    "id": number,
                    "file_name": f"{sequence.path.name}/{name}/{record.sample:06d}.png",
                    "width": width,
                    "height": height,
                    "greatx_sequence": sequence.number,
                    "greatx_camera": name,
                    "greatx_tick": record.tick,
                    "greatx_time_ns": record.time_ns,
                }


class _Objects:
    """Knows which object and which class an instance id belongs to.

    Instances of one node are one object, whose number is its first instance's id and whose class is that of
    this instance; every other instance is an object of its own. Instances of stuff have the number 0.
    """

    def __init__(self, dataset: Dataset, things: Optional[List[str]]):
        self._dataset = dataset
        self._classes = dataset.semantic_classes
        names = [name for name in self._classes if name not in STUFF] if things is None else things
        for name in names:
            if name not in self._classes or name == "unlabeled":
                raise DatasetError(
                    f"{dataset.path}: has no class {name!r} of objects; classes are "
                    f"{', '.join(self._classes[1:])}"
                )
        self._things = set(names)
        instances = dataset.instances
        numbers = np.zeros(len(instances) + 1, np.int64)
        of_class = np.zeros(len(instances) + 1, np.int64)
        first_of_node: Dict[str, int] = {}
        for i, entry in enumerate(instances, 1):
            first = first_of_node.setdefault(entry["node"], i) if "node" in entry else i
            kind = instances[first - 1].get("class", "unlabeled")
            if kind not in self._classes:
                raise DatasetError(
                    f"{dataset.path}: expected a class of instance {first} that is in "
                    f"semantic_classes, found {kind!r}"
                )
            of_class[i] = self._classes.index(kind)
            numbers[i] = first if kind in self._things else 0
        self._numbers, self._of_class = numbers, of_class

    def categories(self, all_: bool) -> List[Dict[str, Any]]:
        """Returns the categories of objects, or of all classes for panoptic pictures. The id is the number of
        the class in `semantic` pictures."""
        out = []
        for number, name in enumerate(self._classes):
            thing = name in self._things
            if number and (thing or all_):
                entry = {"id": number, "name": name, "supercategory": "object" if thing else "stuff"}
                out.append({**entry, "isthing": int(thing)} if all_ else entry)
        return out

    def category(self, number: int) -> int:
        return int(self._of_class[number])

    def name(self, number: int) -> str:
        return str(self._dataset.instances[number - 1].get("name", number))

    def pictures(self, record: Record) -> Tuple[np.ndarray, np.ndarray]:
        """Returns the numbers of objects and the classes of a picture's pixels, [h, w]."""
        instance = np.asarray(record["instance"])
        if instance.size and int(instance.max()) >= len(self._numbers):
            raise DatasetError(
                f"{self._dataset.path}: {record.sensor.name}: expected instances up to "
                f"{len(self._numbers) - 1}, found {int(instance.max())} in picture {record.sample}"
            )
        return self._numbers[instance], np.asarray(record["semantic"])


def _rectangle(mask: np.ndarray) -> List[int]:
    """Returns x, y, width and height of the bounds of a mask."""
    columns, rows = np.flatnonzero(mask.any(axis=0)), np.flatnonzero(mask.any(axis=1))
    return [
        int(columns[0]),
        int(rows[0]),
        int(columns[-1] - columns[0] + 1),
        int(rows[-1] - rows[0] + 1),
    ]


def _annotations(numbers: np.ndarray, objects: _Objects, image: int, first: int) -> Iterator[Dict[str, Any]]:
    """Gives the annotations of a picture of object numbers, from the id `first` on."""
    for k, number in enumerate(int(n) for n in np.unique(numbers) if n > 0):
        mask = numbers == number
        yield {
            "id": first + k,
            "image_id": image,
            "category_id": objects.category(number),
            "segmentation": encode(mask),
            "area": int(np.count_nonzero(mask)),
            "bbox": _rectangle(mask),
            "iscrowd": 0,
            "greatx_instance": number,
            "greatx_name": objects.name(number),
        }


def _panoptic(
    root: pathlib.Path, numbers: np.ndarray, classes: np.ndarray, objects: _Objects, image: Dict[str, Any]
) -> Dict[str, Any]:
    """Writes a panoptic picture, whose colours are R + 256 G + 65536 B = id, and returns its annotation. The
    id 0 is for pixels of no class; classes have their number, objects FIRST_OBJECT + number."""
    ids = np.where(numbers > 0, numbers + FIRST_OBJECT, classes)
    if int(ids.max(initial=0)) >= 1 << 24:
        raise DatasetError(
            f"{image['file_name']}: expected instances below 2^24, which panoptic pictures can hold"
        )
    path = root / "annotations/panoptic" / image["file_name"]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_rgb(path, np.stack([ids & 255, ids >> 8 & 255, ids >> 16], -1).astype(np.uint8))
    segments = []
    for id_ in (int(n) for n in np.unique(ids) if n > 0):
        mask = ids == id_
        thing = id_ > FIRST_OBJECT
        segments.append(
            {
                "id": id_,
                "category_id": objects.category(id_ - FIRST_OBJECT) if thing else id_,
                "area": int(np.count_nonzero(mask)),
                "bbox": _rectangle(mask),
                "iscrowd": 0,
            }
        )
    return {"image_id": image["id"], "file_name": image["file_name"], "segments_info": segments}


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--camera", action="append", help="camera NODE/NAME, once or more; default: all that have rgb and ids"
    )
    sequence_argument(parser)
    parser.add_argument(
        "--things", help="classes of objects, with commas between; default: all but " + ", ".join(STUFF[1:])
    )
    parser.add_argument("--without-panoptic", action="store_true", help="write no panoptic pictures")
    link_argument(parser)


COMMAND = Command(
    "coco",
    "COCO's instances and panoptic pictures, for pycocotools",
    lambda dataset, given: write_coco(
        dataset,
        given.OUT,
        cameras=given.camera,
        sequence=given.sequence,
        things=given.things.split(",") if given.things is not None else None,
        panoptic=not given.without_panoptic,
        link=given.link,
    ),
    _arguments,
)
