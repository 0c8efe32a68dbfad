# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a data set as nuScenes' tables and files, which nuscenes-devkit reads.

    OUT/v1.0-mini/scene.json sample.json sample_data.json ...   thirteen tables, and lidarseg.json
    OUT/v1.0-mini/splits.json                                   a split "all" of all scenes
    OUT/samples/CAM_FRONT/...  LIDAR_TOP/...  RADAR_FRONT/...   files of keyframes
    OUT/sweeps/CAM_FRONT/...                                    files of all other ticks
    OUT/lidarseg/v1.0-mini/TOKEN_lidarseg.bin                   classes of the points of keyframes
    OUT/maps/empty.png                                          a map on which nothing is known

Data flow: rig -> channels -> for each sequence: keyframes -> samples; records of each sensor -> files and
sample_data; objects at keyframes -> annotations -> tables. A sequence is a scene. A keyframe is a tick at
which all sensors of the rig fire. The ego frame is that of the node's body; "global" is the world less
`origin`, a place 200 m south-west of the carrier's track, because nuScenes' maps have no negative
coordinates.
"""

from __future__ import annotations

import datetime
import json
import os
import pathlib
from typing import Any, Dict, List, Optional, Union

import numpy as np

from ...dataset import Dataset, Record, Sequence
from ...errors import DatasetError
from ..clouds import Cloud, cloud, untwisted
from ..folders import Progress, new_folder, place
from ..objects import Inventory, class_arguments, has_boxes, require_boxes
from ..png import write_png
from ..poses import OPTICAL_FROM_BODY, Pose, mount
from ..rig import (
    Rig,
    Track,
    common_ticks,
    optics,
    pick_rig,
    picture_file,
    sequences_of,
    time_ns,
)
from .annotations import annotate
from .categories import ANNOTATED, CATEGORIES, POINTS
from .channels import assign
from .points import BODY_FROM_LIDAR, Detections, detections, lidar_bytes, radar_bytes
from .tables import Row, Tables, chain

#: Microseconds from 1970 to the beginning of each sequence, 2000-01-01 00:00 UTC.
EPOCH_US = int(datetime.datetime(2000, 1, 1, tzinfo=datetime.timezone.utc).timestamp()) * 1_000_000
MARGIN_M = 200.0  #: of the map around the carrier's track
MAP_PIXELS_PER_M = 10  #: the development kit's finest resolution
LARGEST_MAP_M = 3000.0


def write_nuscenes(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    node: Optional[str] = None,
    sequence: Optional[int] = None,
    keyframes_hz: float = 2.0,
    range_m: float = 100.0,
    channels: Optional[List[str]] = None,
    categories: Optional[List[str]] = None,
    without_annotations: bool = False,
    version: str = "v1.0-mini",
    link: bool = False,
    untwist: bool = False,
    scene_names: Optional[List[str]] = None,
) -> Dict[str, Any]:
    """Writes the sequences of a data set as nuScenes' scenes. Returns counts of the written objects.

    A sample comes every 1 / keyframes_hz s, or at every common tick if it is 0. Objects up to `range_m` from
    the carrier are annotated, if any camera of the node ever has a box for them. `channels` are
    SENSOR=CHANNEL (see channels.py) and `categories` CLASS=CATEGORY, which change categories.ANNOTATED.
    `scene_names` are the names of the sequences, in their order (default: scene-0000, scene-0001, ...).
    Raises DatasetError, or FileExistsError if `out` is not empty.
    """
    return Writer(
        dataset,
        pick_rig(dataset, node, needs_camera=False, needs_lidar=False),
        sequences_of(dataset, sequence),
        keyframes_hz,
        range_m,
        channels,
        class_arguments(categories, ANNOTATED, "--category"),
        without_annotations,
        version,
        link,
        untwist,
        scene_names,
    ).write(out)


def keyframes(sequence: Sequence, rig: Rig, rate_hz: float) -> List[int]:
    """Returns the ticks of the samples: every common tick of the rig's sensors that is not earlier than the
    period after the sample before it. An eighth of a period is allowed for, so that ticks of a rate that is
    no multiple do not slip by a whole tick."""
    ticks = [int(tick) for tick in common_ticks(sequence, rig.sensors)]
    if rate_hz == 0:
        return ticks
    least = 0.875e9 / rate_hz
    out = [ticks[0]]
    for tick in ticks[1:]:
        if time_ns(sequence, tick) - time_ns(sequence, out[-1]) >= least:
            out.append(tick)
    return out


class Writer:
    """Holds what is written, and the tables while they grow. Checks all arguments before it writes."""

    def __init__(
        self,
        dataset: Dataset,
        rig: Rig,
        sequences: List[Sequence],
        keyframes_hz: float,
        range_m: float,
        channels: Optional[List[str]],
        categories: Dict[str, str],
        without_annotations: bool,
        version: str,
        link: bool,
        untwist: bool,
        scene_names: Optional[List[str]],
    ):
        if not 0 <= keyframes_hz <= 1e6:
            raise DatasetError(f"--keyframes: expected a rate from 0 to 1e6 Hz, found {keyframes_hz}")
        if not 0 < range_m <= 1e6:
            raise DatasetError(f"--range: expected a range up to 1e6 m, found {range_m}")
        if not version or "/" in version or version.startswith("."):
            raise DatasetError(f"--version: expected the name of a folder, found {version!r}")
        names = scene_names if scene_names is not None else [f"scene-{s.number:04d}" for s in sequences]
        if len(set(names)) != len(sequences) or len(names) != len(sequences):
            raise DatasetError(
                f"--scene-name: expected {len(sequences)} different names, one for each sequence, found "
                f"{', '.join(names)}"
            )
        self.scene_names = {s.number: name for s, name in zip(sequences, names)}
        self.dataset, self.rig, self.sequences = dataset, rig, sequences
        self.categories, self.range_m, self.version = categories, range_m, version
        self.link, self.untwist = link, untwist
        self.boxes = [c for c in rig.cameras if has_boxes(sequences[0], c)]
        if not self.boxes and not without_annotations:
            if not rig.cameras:
                raise DatasetError(
                    f"{dataset.path}: {rig.node}: expected a camera with boxes of objects, found no camera; "
                    "--without-annotations writes sensors alone"
                )
            require_boxes(sequences[0], rig.cameras[0], "--without-annotations writes sensors alone")
        if without_annotations:
            self.boxes = []
        self.samples = {s.number: keyframes(s, rig, keyframes_hz) for s in sequences}
        self.channels = assign(sequences[0], rig, channels)
        self.tables = Tables(dataset)
        self.origin = self._origin()
        self.counts: Dict[str, Any] = {"scenes": 0, "samples": 0, "files": 0, "annotations": 0}
        self._class_index = np.array(
            [
                0,
                *(
                    CATEGORIES.index(POINTS.get(i.get("class", ""), "static.other"))
                    for i in dataset.instances
                ),
            ],
            np.uint8,
        )

    def _extent(self) -> np.ndarray:
        """Returns the least and the largest x and y of the carrier, [2, 2]."""
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for sequence in self.sequences:
            node = Track(sequence).nodes.index(self.rig.node)
            places = np.asarray(sequence.poses["position"])[:, node, :2]
            low, high = np.minimum(low, places.min(axis=0)), np.maximum(high, places.max(axis=0))
        return np.stack([low, high])

    def _origin(self) -> np.ndarray:
        return np.array([*np.floor(self._extent()[0] - MARGIN_M), 0.0])

    def write(self, out: Union[str, "os.PathLike[str]"]) -> Dict[str, Any]:
        progress = Progress(sum(len(s[n]) for s in self.sequences for n in self.rig.sensors), "records")
        with new_folder(out) as root:
            self.tables.taxonomy(list(self.categories.values()))
            self._sensors()
            for sequence in self.sequences:
                self._scene(root, sequence, progress)
            self._map(root)
            self.tables.write(root / self.version)
            splits = {"all": [row["name"] for row in self.tables.rows["scene"]]}
            (root / self.version / "splits.json").write_text(json.dumps(splits) + "\n")
        progress.end()
        return self.counts

    def _sensors(self) -> None:
        for name, channel in self.channels.items():
            kind = "camera" if name in self.rig.cameras else "lidar" if name in self.rig.lidars else "radar"
            sensor = self.tables.add(
                "sensor", self.tables.token("sensor", channel), channel=channel, modality=kind
            )
            pose = mount(self.sequences[0][name].record(0))
            intrinsic: List[List[float]] = []
            if kind == "camera":
                pose = pose @ Pose(np.zeros(3), OPTICAL_FROM_BODY.T)
                intrinsic = optics(self.sequences[0][name]).matrix().tolist()
            elif kind == "lidar":
                pose = pose @ BODY_FROM_LIDAR
            self.tables.add(
                "calibrated_sensor",
                self.tables.token("calibrated_sensor", channel),
                sensor_token=sensor["token"],
                translation=pose.position.tolist(),
                rotation=pose.quaternion.tolist(),
                camera_intrinsic=intrinsic,
            )

    def _scene(self, root: pathlib.Path, sequence: Sequence, progress: Progress) -> None:
        token = self.tables.token
        number = sequence.number
        log = self.tables.add(
            "log",
            token("log", number),
            logfile=f"greatx-{number:04d}",
            vehicle=self.rig.node,
            date_captured="2000-01-01",
            location=str(self.dataset.run.get("scenario", "greatx")),
            greatx_origin_m=self.origin.tolist(),
        )
        samples = [
            self.tables.add(
                "sample",
                token("sample", number, tick),
                timestamp=self._time_us(sequence, tick),
                scene_token=token("scene", number),
            )
            for tick in self.samples[number]
        ]
        chain(samples)
        self.tables.add(
            "scene",
            token("scene", number),
            log_token=log["token"],
            nbr_samples=len(samples),
            first_sample_token=samples[0]["token"],
            last_sample_token=samples[-1]["token"],
            name=self.scene_names[number],
            description=f"sequence {number} of the scenario {self.dataset.run.get('scenario', '')}",
        )
        track = Track(sequence)
        clouds: Dict[int, Cloud] = {}  # of keyframes, in the frame of the first LiDAR of greatx
        echoes: Dict[int, Dict[str, Detections]] = {}
        for name in self.rig.sensors:
            self._records(root, sequence, name, track, clouds, echoes, progress)
        if self.boxes:
            things = Inventory(sequence, self.boxes, self.categories, track)
            self.counts["annotations"] += annotate(self, sequence, track, things, clouds, echoes)
        self.counts["scenes"] += 1
        self.counts["samples"] += len(samples)

    def _time_us(self, sequence: Sequence, tick: int) -> int:
        return EPOCH_US + (time_ns(sequence, tick) + 500) // 1000

    def _records(
        self,
        root: pathlib.Path,
        sequence: Sequence,
        name: str,
        track: Track,
        clouds: Dict[int, Cloud],
        echoes: Dict[int, Dict[str, Detections]],
        progress: Progress,
    ) -> None:
        """Writes all records of a sensor and their rows of sample_data and ego_pose."""
        channel, rows = self.channels[name], []
        key_ticks = np.array(self.samples[sequence.number])
        for record in sequence[name]:
            key = bool(np.isin(record.tick, key_ticks))
            # A sweep belongs to the next keyframe, between which and the one before boxes are interpolated.
            sample = int(key_ticks[min(np.searchsorted(key_ticks, record.tick), len(key_ticks) - 1)])
            row = self._sample_data(sequence, record, channel, key, sample, track)
            target = root / row["filename"]
            target.parent.mkdir(parents=True, exist_ok=True)
            if name in self.rig.cameras:
                place(picture_file(record), target, self.link)
            elif name in self.rig.lidars:
                there = self._lidar(record, track, target)
                if key and self.channels[name] == self.first_lidar():
                    clouds[record.tick] = there
                    self._lidarseg(root, row, there)
            else:
                found = detections(record, track)
                target.write_bytes(radar_bytes(found))
                if key:
                    echoes.setdefault(record.tick, {})[name] = found
            rows.append(row)
            self.counts["files"] += 1
            progress.step()
        chain(rows)

    def first_lidar(self) -> str:
        channels = [self.channels[name] for name in self.rig.lidars]
        return "LIDAR_TOP" if "LIDAR_TOP" in channels else channels[0]

    def _sample_data(
        self, sequence: Sequence, record: Record, channel: str, key: bool, sample: int, track: Track
    ) -> Row:
        token = self.tables.token("sample_data", sequence.number, channel, record.tick)
        time_us = self._time_us(sequence, record.tick)
        pose = track.pose(track.nodes.index(self.rig.node), record.tick)
        self.tables.add(
            "ego_pose",
            token,
            timestamp=time_us,
            rotation=pose.quaternion.tolist(),
            translation=(pose.position - self.origin).tolist(),
        )
        camera = channel.startswith("CAM_")
        suffix = "png" if camera else "pcd.bin" if channel.startswith("LIDAR_") else "pcd"
        size = optics(record.sensor) if camera else None
        folder = "samples" if key else "sweeps"
        return self.tables.add(
            "sample_data",
            token,
            sample_token=self.tables.token("sample", sequence.number, sample),
            ego_pose_token=token,
            calibrated_sensor_token=self.tables.token("calibrated_sensor", channel),
            timestamp=time_us,
            fileformat="png" if camera else "pcd",
            is_key_frame=key,
            height=size.height if size else 0,
            width=size.width if size else 0,
            filename=f"{folder}/{channel}/greatx-{sequence.number:04d}__{channel}__{time_us}.{suffix}",
        )

    def _lidar(self, record: Record, track: Track, target: pathlib.Path) -> Cloud:
        there = untwisted(record, track) if self.untwist else cloud(record)
        if there.ring is None:
            raise DatasetError(
                f"{self.dataset.path}: {record.sensor.name}: expected an array 'ring', which nuScenes' "
                "points have, found none; the LiDAR's outputs need ply or pcd"
            )
        target.write_bytes(lidar_bytes(there.points, there.ring))
        return there

    def _lidarseg(self, root: pathlib.Path, row: Row, there: Cloud) -> None:
        """Writes the class of each point of a keyframe, if the data set has the instance of each point."""
        if there.instance is None:
            return
        if len(there.instance) and int(there.instance.max()) >= len(self._class_index):
            raise DatasetError(
                f"{self.dataset.path}: expected instances of points up to {len(self._class_index) - 1}, "
                f"found {int(there.instance.max())}"
            )
        name = f"lidarseg/{self.version}/{row['token']}_lidarseg.bin"
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_bytes(self._class_index[there.instance].tobytes())
        self.tables.add("lidarseg", row["token"], sample_data_token=row["token"], filename=name)

    def _map(self, root: pathlib.Path) -> None:
        """Writes a map mask without content, which covers the track and MARGIN_M around it."""
        side = np.minimum(np.ceil(self._extent()[1] - self.origin[:2]) + MARGIN_M, LARGEST_MAP_M)
        width, height = (int(extent * MAP_PIXELS_PER_M) for extent in side)
        (root / "maps").mkdir()
        line = np.zeros(width, np.uint8)
        write_png(root / "maps/empty.png", width, height, 1, (line for _ in range(height)))
        self.tables.add(
            "map",
            self.tables.token("map"),
            category="semantic_prior",
            filename="maps/empty.png",
            log_tokens=[log["token"] for log in self.tables.rows["log"]],
        )
