# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a radar, a camera and a LiDAR in the "ready to use" layout of RADIal (Rebut et al., "Raw
High-Definition Radar for Multi-Task Learning", CVPR 2022), without its mask of free space.

Conventions of RADIal, after its published code: spectra are [range, Doppler, channel] with Doppler 0 in the
first column; labels have X to the left and Y forward, and angles that grow to the left; radar points have x
forward and y to the right. Data flow: the ticks at which radar, camera and (if there is one) LiDAR have
records -> samples 000000, ... over all sequences -> files and rows of labels.csv.
"""

from __future__ import annotations

import argparse
import os
import pathlib
from typing import Any, Dict, Iterable, List, Optional, Union

import numpy as np

from ...dataset import Dataset, Record, Sequence
from ...errors import DatasetError
from ...files import interpreting
from ..clouds import cloud
from ..common import Command
from ..folders import Progress, new_folder
from ..objects import Seen, require_boxes, seen
from ..poses import mount, node_of, nodes_of
from ..rig import Track, common_ticks, sequences_of
from .source import Detection, Pictures, arguments, detections, pick, pick_radar
from .spectrum import WINDOWS, has_beams, spectrum

COLUMNS = (
    "numSample x1_pix y1_pix x2_pix y2_pix laser_X_m laser_Y_m laser_Z_m radar_X_m radar_Y_m radar_R_m "
    "radar_A_deg radar_D_mps radar_P_db dataset index Difficult"
).split()
NONE = -1
CLASSES = ("vehicle",)


def write_radial(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    radar: Optional[str] = None,
    camera: Optional[str] = None,
    lidar: Optional[str] = None,
    sequence: Optional[int] = None,
    classes: Iterable[str] = CLASSES,
    pictures: bool = True,
    window: str = "hann",
) -> Dict[str, int]:
    """Writes OUT/labels.csv, camera/, radar_FFT/, radar_PCL/ and laser_PCL/. The camera needs boxes and the
    radar its samples (output cube). Returns counts of the written objects. Raises DatasetError,
    FileExistsError, or ImportError without Pillow if pictures are wanted.
    """
    if window not in WINDOWS:
        raise DatasetError(f"window: expected one of {', '.join(WINDOWS)}, found {window!r}")
    radar = pick_radar(dataset, radar)
    node = node_of(radar, nodes_of(dataset.sequences[0]))
    camera = pick(dataset, "camera", camera, "--camera", None if camera else node)
    lidar = pick(dataset, "lidar", lidar, "--lidar", None if lidar else node)
    if camera is None:
        raise DatasetError(f"{dataset.path}: {node}: expected a camera with boxes, found none")
    sequences = sequences_of(dataset, sequence)
    for each in sequences:
        require_boxes(each, camera, "name another camera (--camera)")
        if not has_beams(each[radar]):
            raise DatasetError(
                f"{dataset.path}: {radar}: expected a monostatic radar of ramps with its samples (output "
                "cube), found none"
            )
    names = [name for name in (radar, camera, lidar) if name is not None]
    ticks = {each.number: common_ticks(each, names) for each in sequences}
    counts = {"samples": 0, "labels": 0, "objects without a detection": 0}
    progress = Progress(sum(len(t) for t in ticks.values()), "samples")
    with new_folder(out) as root:
        writer = _Writer(root, radar, camera, lidar, set(classes), Pictures(pictures), window, counts)
        for each in sequences:
            for number, tick in enumerate(ticks[each.number]):
                with interpreting(each.path):
                    writer.sample(each, int(tick), number)
                progress.step()
        writer.finish()
    progress.end()
    return counts


class _Writer:
    def __init__(
        self,
        root: pathlib.Path,
        radar: str,
        camera: str,
        lidar: Optional[str],
        classes: set,
        jpeg: Pictures,
        window: str,
        counts: Dict[str, int],
    ):
        self._root, self._radar, self._camera, self._lidar = root, radar, camera, lidar
        self._classes, self._jpeg, self._window, self._counts = classes, jpeg, window, counts
        self._rows: List[List[Any]] = []
        self._tracks: Dict[int, Track] = {}
        for folder in (
            ["radar_FFT", "radar_PCL"] + ["camera"] * jpeg.wanted + ["laser_PCL"] * (lidar is not None)
        ):
            (root / folder).mkdir()

    def sample(self, sequence: Sequence, tick: int, index: int) -> None:
        number = self._counts["samples"]
        record, picture = sequence[self._radar].at(tick), sequence[self._camera].at(tick)
        values = spectrum(np.asarray(record["cube"]), self._window)  # [rx, tx, range, velocity]
        channels = np.fft.ifftshift(values, axes=3).reshape(-1, *values.shape[2:])
        data = np.ascontiguousarray(np.moveaxis(channels, 0, -1).astype(np.complex64))
        np.save(self._root / "radar_FFT" / f"fft_{number:06d}.npy", data)
        found = detections(record)
        np.save(self._root / "radar_PCL" / f"pcl_{number:06d}.npy", radar_points(found))
        if self._lidar is not None:
            np.save(
                self._root / "laser_PCL" / f"pcl_{number:06d}.npy",
                laser_points(sequence[self._lidar].at(tick)),
            )
        if self._jpeg.wanted:
            self._jpeg.write(self._root / "camera" / f"image_{number:06d}.jpg", np.asarray(picture["rgb"]))
        labels = [
            self._label(each, found, sequence, tick) for each in seen(picture) if each.kind in self._classes
        ]
        for label in labels or [[NONE] * 13 + [0]]:
            self._rows.append([number, *label[:13], sequence.path.name, index, label[13]])
        self._counts["samples"] += 1
        self._counts["labels"] += len(labels)

    def _label(self, each: Seen, found: List[Detection], sequence: Sequence, tick: int) -> List[Any]:
        """Returns the 13 numbers of a label, and 1 if the radar or the camera does not see the object."""
        body_from_box = mount(sequence[self._camera].at(tick)) @ each.sensor_from_box
        to_radar = mount(sequence[self._radar].at(tick)).inverse() @ body_from_box
        x, y = to_radar.position[:2]
        mine = [d for d in found if each.instance <= d.instance < each.instance + each.count]
        self._counts["objects without a detection"] += not mine
        laser: List[float] = [NONE] * 3
        if self._lidar is not None:
            to_laser = mount(sequence[self._lidar].at(tick)).inverse() @ body_from_box
            ends = [to_laser.apply(np.array([side * each.size[0] / 2, 0.0, 0.0])) for side in (-1, 1)]
            laser = min(ends, key=lambda end: float(np.linalg.norm(end))).tolist()
        speed = self._radial_speed(each, to_radar.position, sequence, tick)
        power = max((d.power_dbm for d in mine), default=float(NONE))
        radar = [y, x, np.hypot(x, y), np.degrees(np.arctan2(y, x)), speed, power]
        return [*each.amodal, *laser, *radar, int(not mine or each.visible_pixels == 0)]

    def _radial_speed(self, each: Seen, place: np.ndarray, sequence: Sequence, tick: int) -> float:
        """Returns the rate of the distance from the radar to the box's centre, m/s."""
        track = self._tracks.setdefault(sequence.number, Track(sequence))
        carrier = track.nodes.index(node_of(self._radar, track.nodes))
        world_from_body = track.pose(carrier, tick)
        world_from_radar = world_from_body @ mount(sequence[self._radar].at(tick))
        centre = world_from_radar.apply(place)

        def velocity(node: int, at: np.ndarray) -> np.ndarray:
            if node < 0:
                return np.zeros(3)
            turn = track.vector("angular_velocity", node, tick)
            return track.vector("velocity", node, tick) + np.cross(turn, at - track.pose(node, tick).position)

        apart = centre - world_from_radar.position
        moved = velocity(each.node, centre) - velocity(carrier, world_from_radar.position)
        return float(moved @ apart / max(float(np.linalg.norm(apart)), 1e-12))

    def finish(self) -> None:
        lines = [",".join(COLUMNS)] + [",".join(_text(value) for value in row) for row in self._rows]
        (self._root / "labels.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _text(value: Any) -> str:
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def radar_points(found: List[Detection]) -> np.ndarray:
    """Returns float64 [9, n]: range, azimuth, elevation (rad), power (dBm), Doppler (m/s), x, y, z, v. y and
    the azimuth grow to the right."""
    rows = [
        [d.range_m, -d.azimuth_rad, d.elevation_rad, d.power_dbm, d.velocity_m_s]
        + [d.place[0], -d.place[1], d.place[2], d.velocity_m_s]
        for d in found
    ]
    return np.array(rows, float).reshape(-1, 9).T.copy()


def laser_points(record: Record) -> np.ndarray:
    """Returns float32 [n, 8]: x forward, y left, z up (m), intensity, distance (m), polar angle from the x-y
    plane and azimuth (rad), and the channel, -1 if the data set has it not."""
    there = cloud(record)
    x, y, z, intensity = there.points.T.astype(np.float64)
    distance = np.sqrt(x * x + y * y + z * z)
    ring = np.full(len(x), -1.0) if there.ring is None else there.ring.astype(np.float64)
    polar = np.arctan2(z, np.hypot(x, y))
    return np.stack([x, y, z, intensity, distance, polar, np.arctan2(y, x), ring], -1).astype(np.float32)


def _arguments(parser: argparse.ArgumentParser) -> None:
    arguments(parser)
    parser.add_argument("--lidar", metavar="SENSOR", help="needed if the radar's node has several LiDARs")
    parser.add_argument(
        "--class",
        dest="classes",
        action="append",
        metavar="CLASS",
        help="semantic class that is labelled; may be repeated; default: vehicle",
    )


COMMAND = Command(
    "radial",
    "radar spectra, points and labels in RADIal's layout",
    lambda dataset, given: write_radial(
        dataset,
        given.OUT,
        given.radar,
        given.camera,
        given.lidar,
        given.sequence,
        given.classes or CLASSES,
        not given.no_pictures,
        given.window,
    ),
    _arguments,
)
