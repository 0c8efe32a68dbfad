# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the layout of KITTI's raw recordings (synchronized and rectified), which pykitti.raw reads.

    OUT/2000_01_01/calib_cam_to_cam.txt  calib_velo_to_cam.txt  calib_imu_to_velo.txt
    OUT/2000_01_01/2000_01_01_drive_0000_sync/
      image_02/data/0000000000.png  image_02/timestamps.txt     image_03 with a stereo pair
      velodyne_points/data/0000000000.bin  timestamps.txt  timestamps_start.txt  timestamps_end.txt
      oxts/data/0000000000.txt  oxts/timestamps.txt  oxts/dataformat.txt
      tracklet_labels.xml                                       if the camera has boxes

A sequence is a drive of the same number. A frame is a tick at which all written sensors fire.
"""

from __future__ import annotations

import argparse
import datetime
import os
import pathlib
import re
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np

from ...dataset import Dataset, Sequence
from ...errors import DatasetError
from ...geodesy import LocalFrame
from ..common import Command
from ..folders import Progress, new_folder
from ..objects import class_arguments, has_boxes
from ..rig import Track, time_ns
from . import calibration as files
from .labels import TYPES, type_argument
from .oxts import DEFAULT_PLACE, Places, dataformat, line, local_frame, packet
from .source import Source, check_numbers, choice, choose, source_arguments
from .tracklets import Tracklets

DEFAULT_DATE = "2000_01_01"


def write_kitti_raw(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    date: str = DEFAULT_DATE,
    origin: Optional[Tuple[float, float, float]] = None,
    places: str = "mercator",
    types: Optional[List[str]] = None,
    **chosen: Any,
) -> Dict[str, Any]:
    """Writes drives of KITTI's raw layout. Returns counts of the written objects.

    `date` (YYYY_MM_DD) is the day on which each sequence begins at midnight. `origin` is latitude and
    longitude in degrees and height in m of the first frame of the first sequence, for a scene without
    georeference. `places` says what latitudes and longitudes are for (see oxts.py): "mercator" or "geodetic".
    `types` are CLASS=TYPE, which change or add to labels.TYPES for tracklets. The other arguments are those
    of source.choose(). Raises DatasetError, or FileExistsError if `out` is not empty.
    """
    day = _day(date)
    if places not in ("mercator", "geodetic"):
        raise DatasetError(f"--places: expected mercator or geodetic, found {places!r}")
    source = choose(dataset, **chosen)
    named = class_arguments(types, TYPES, "--type")
    check_numbers(source.sequences, 9999, "drives")
    frame = local_frame(dataset, origin)
    anchor = np.zeros(3)
    if frame is None:
        frame = LocalFrame(*(origin or DEFAULT_PLACE))
        anchor = _Drive(source, source.sequences[0], pathlib.Path(), day, named).first_position()
    counts: Dict[str, Any] = {"drives": 0, "frames": 0, "points": 0, "tracklets": 0}
    progress = Progress(sum(len(source.ticks(s)) for s in source.sequences), "frames")
    with new_folder(out) as root:
        folder = root / date
        folder.mkdir()
        (folder / "calib_cam_to_cam.txt").write_text(files.cam_to_cam(source.calibration))
        (folder / "calib_velo_to_cam.txt").write_text(files.velo_to_cam(source.calibration))
        (folder / "calib_imu_to_velo.txt").write_text(files.imu_to_velo(source.calibration))
        for sequence in source.sequences:
            name = f"{date}_drive_{sequence.number:04d}_sync"
            drive = _Drive(source, sequence, folder / name, day, named)
            drive.write(Places(frame, anchor, drive.first_position(), places), counts, progress)
            counts["drives"] += 1
    progress.end()
    return counts


def _day(date: str) -> datetime.datetime:
    try:
        if not re.fullmatch(r"[0-9]{4}_[0-9]{2}_[0-9]{2}", date, re.ASCII):
            raise ValueError
        return datetime.datetime.strptime(date, "%Y_%m_%d")
    except ValueError:
        raise DatasetError(f"--date: expected a day as YYYY_MM_DD, found {date!r}") from None


def stamp(day: datetime.datetime, nanoseconds: int) -> str:
    """Returns a time as KITTI writes it, with nine digits after the point."""
    seconds, rest = divmod(nanoseconds, 10**9)
    moment = day + datetime.timedelta(seconds=seconds)
    return f"{moment:%Y-%m-%d %H:%M:%S}.{rest:09d}\n"


class _Drive:
    """Writes one sequence."""

    def __init__(
        self,
        source: Source,
        sequence: Sequence,
        folder: pathlib.Path,
        day: datetime.datetime,
        types: Dict[str, str],
    ):
        self._source, self._sequence, self._folder, self._day = source, sequence, folder, day
        self._types = types
        self._track = Track(sequence)
        self._node = self._track.nodes.index(source.rig.node)
        self._ticks = [int(tick) for tick in source.ticks(sequence)]

    def first_position(self) -> np.ndarray:
        """Returns the position of the carrier in the first frame, [3] m in the world."""
        return self._track.pose(self._node, self._ticks[0]).position

    def write(self, places: Places, counts: Dict[str, Any], progress: Progress) -> None:
        source, sequence, folder = self._source, self._sequence, self._folder
        left = sequence[source.left]
        tracklets = Tracklets(self._types, source.calibration) if has_boxes(sequence, source.left) else None
        oxts = folder / "oxts"
        (oxts / "data").mkdir(parents=True)
        (oxts / "dataformat.txt").write_text(dataformat())
        for frame, tick in enumerate(self._ticks):
            name = f"{frame:010d}"
            for camera in source.cameras():
                source.picture(sequence, camera, tick, folder / f"image_{camera:02d}/data/{name}.png")
            if source.lidar:
                target = folder / f"velodyne_points/data/{name}.bin"
                counts["points"] += source.velodyne(sequence, tick, self._track, target)
            pose = self._track.pose(self._node, tick)
            values = packet(pose, places.of(pose.position), self._track, self._node, tick)
            (oxts / f"data/{name}.txt").write_text(line(values))
            if tracklets is not None:
                tracklets.add(frame, left.at(tick))
            counts["frames"] += 1
            progress.step()
        self._timestamps()
        if tracklets is not None:
            (folder / "tracklet_labels.xml").write_text(tracklets.xml())
            counts["tracklets"] += len(tracklets.all)

    def _timestamps(self) -> None:
        """Writes the times of all sensors. Poses, pictures and points of a frame belong to its tick, at which
        a sweep begins."""
        times = [time_ns(self._sequence, tick) for tick in self._ticks]

        def write(path: str, later_ns: int = 0) -> None:
            lines = "".join(stamp(self._day, ns + later_ns) for ns in times)
            (self._folder / path).write_text(lines)

        write("oxts/timestamps.txt")
        for camera in self._source.cameras():
            write(f"image_{camera:02d}/timestamps.txt")
        if self._source.lidar:
            write("velodyne_points/timestamps.txt")
            write("velodyne_points/timestamps_start.txt")
            write("velodyne_points/timestamps_end.txt", round(self._source.sweep_s(self._sequence) * 1e9))


def _arguments(parser: argparse.ArgumentParser) -> None:
    source_arguments(parser)
    type_argument(parser)
    parser.add_argument("--date", default=DEFAULT_DATE, help="day of the drives, YYYY_MM_DD (%(default)s)")
    parser.add_argument(
        "--origin",
        type=float,
        nargs=3,
        metavar=("LATITUDE", "LONGITUDE", "HEIGHT"),
        help="place of the first frame, for a scene without georeference "
        f"({', '.join(f'{value:g}' for value in DEFAULT_PLACE)})",
    )
    parser.add_argument(
        "--places",
        default="mercator",
        choices=("mercator", "geodetic"),
        help="what oxts' places are for: the readers' projection gives back the true poses, or true places "
        "(default: %(default)s)",
    )


COMMAND = Command(
    "kitti-raw",
    "KITTI's raw recordings, for pykitti.raw",
    lambda dataset, given: write_kitti_raw(
        dataset,
        given.OUT,
        date=given.date,
        origin=tuple(given.origin) if given.origin else None,
        places=given.places,
        types=given.type,
        **choice(given),
    ),
    _arguments,
)
