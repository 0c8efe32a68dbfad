# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Chooses a radar and the sensors beside it, and reads its detections."""

from __future__ import annotations

import argparse
import dataclasses
import io
import pathlib
from typing import List, Optional

import numpy as np

from ...dataset import Dataset, Record
from ...errors import DatasetError
from ..common import sequence_argument
from ..files import need
from ..objects import class_name
from ..poses import node_of, nodes_of

JPEG_QUALITY = 95


def pick(
    dataset: Dataset, kind: str, name: Optional[str], option: str, node: Optional[str] = None
) -> Optional[str]:
    """Returns the sensor of this kind and name. Without a name: the only one (of the node); None if there is
    none of them. Raises DatasetError for an unknown name or if there are several."""
    nodes = nodes_of(dataset.sequences[0])
    found = [
        n
        for n, info in dataset.sensors.items()
        if info.kind == kind and (node is None or node_of(n, nodes) == node)
    ]
    if name is not None:
        if name not in found:
            raise DatasetError(
                f"{dataset.path}: expected a {kind} ({option}), found {name!r}; there are "
                + (", ".join(found) or "none")
            )
        return name
    if len(found) > 1:
        raise DatasetError(
            f"{dataset.path}: has several {kind}s: say which one ({option}): {', '.join(found)}"
        )
    return found[0] if found else None


def pick_radar(dataset: Dataset, name: Optional[str]) -> str:
    radar = pick(dataset, "radar", name, "--radar")
    if radar is None:
        raise DatasetError(f"{dataset.path}: expected a radar, found {', '.join(dataset.sensors)}")
    return radar


@dataclasses.dataclass(frozen=True)
class Detection:
    """Describes a detection of a radar's record."""

    place: np.ndarray  #: float64 [3] m in the radar's frame: x forward, y left, z up
    range_m: float
    velocity_m_s: float  #: positive receding
    azimuth_rad: float  #: positive to the left
    elevation_rad: float
    power_dbm: float
    instance: int  #: index + 1 of the instance; 0: a false alarm


def detections(record: Record) -> List[Detection]:
    """Returns the detections of a record, in their order."""
    sensor = record.sensor
    for name in ("detections", "range", "velocity", "azimuth", "elevation", "power", "instance"):
        if name not in sensor.arrays:
            raise DatasetError(
                f"{sensor.sequence.dataset.path}: {sensor.name}: expected an array {name!r} (output "
                "detections of the radar), found none"
            )
    columns = [
        np.asarray(record[n]) for n in ("detections", "range", "velocity", "azimuth", "elevation", "power")
    ]
    instance = np.asarray(record["instance"])
    return [
        Detection(p[:3].astype(float), float(r), float(v), float(a), float(e), float(w), int(i))
        for p, r, v, a, e, w, i in zip(*columns, instance)
    ]


def class_of_instance(dataset: Dataset, instance: int) -> str:
    """Returns the semantic class of an instance by its id (index + 1)."""
    instances = dataset.instances
    if not 1 <= instance <= len(instances):
        raise DatasetError(
            f"{dataset.path}: expected an instance from 1 to {len(instances)}, found {instance}"
        )
    kind = instances[instance - 1].get("class")
    return kind if isinstance(kind, str) else class_name(dataset, 0)


class Pictures:
    """Writes a camera's pictures as JPEG, which both layouts have, by Pillow."""

    def __init__(self, wanted: bool):
        self.wanted = wanted
        self._image = need("radar", "PIL.Image")[0] if wanted else None

    def write(self, path: pathlib.Path, picture: np.ndarray) -> None:
        out = io.BytesIO()
        self._image.fromarray(picture).save(out, "JPEG", quality=JPEG_QUALITY, subsampling=0)  # type: ignore
        path.write_bytes(out.getvalue())


def arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument("--radar", metavar="SENSOR", help="needed if there are several radars")
    parser.add_argument("--camera", metavar="SENSOR", help="needed if the radar's node has several cameras")
    parser.add_argument("--no-pictures", action="store_true", help="write no pictures, which need Pillow")
    parser.add_argument(
        "--window",
        choices=("rectangular", "hann", "hamming", "blackman"),
        default="hann",
        help="of the transforms of samples; default: hann",
    )
