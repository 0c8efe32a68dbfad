# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the folder of each sequence in DSEC's layout. Times are microseconds from the beginning of the
sequence, rounded down, plus `start_us`.
"""

from __future__ import annotations

import argparse
import os
import pathlib
from typing import Any, Dict, List, Optional, Union

import numpy as np

from ...dataset import Dataset, Sensor, Sequence
from ...files import interpreting
from ..common import Command, sequence_argument
from ..files import need
from ..folders import Progress, new_folder, place
from ..png import encode_png
from ..rig import common_ticks, picture_file, sequences_of
from .events import write_events, write_rectify_map
from .rig import Names, calibration, pick_names, views_of
from .truth import disparity, optical_flow, rectified_picture

SIDES = {0: "left", 1: "left", 2: "right", 3: "right"}


def write_dsec(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    sequence: Optional[int] = None,
    events_left: Optional[str] = None,
    events_right: Optional[str] = None,
    images_left: Optional[str] = None,
    images_right: Optional[str] = None,
    start_us: int = 0,
) -> Dict[str, int]:
    """Writes OUT/sequence_0000, ... with events, rectify_map, rectified pictures, calibration, and, where the
    data set has the truth, disparity and forward optical flow. Returns counts of the written objects. Raises
    DatasetError, FileExistsError if OUT is not empty, or ImportError without h5py.
    """
    (h5py,) = need("hdf5", "h5py")
    names = pick_names(dataset, events_left, events_right, images_left, images_right)
    sequences = sequences_of(dataset, sequence)
    counts = {"sequences": len(sequences), "events": 0, "pictures": 0, "disparities": 0, "flows": 0}
    progress = Progress(len(sequences), "sequences")
    with new_folder(out) as root:
        for each in sequences:
            with interpreting(each.path):
                _Writer(h5py, each, names, root / each.path.name, start_us, counts).write()
            progress.step()
    progress.end()
    return counts


class _Writer:
    def __init__(
        self,
        h5py: Any,
        sequence: Sequence,
        names: Names,
        folder: pathlib.Path,
        start_us: int,
        counts: Dict[str, int],
    ):
        self._h5py, self._sequence, self._names, self._folder = h5py, sequence, names, folder
        self._start_us, self._counts = start_us, counts
        self._views = views_of(sequence, names)

    def write(self) -> None:
        calibrated = self._folder / "calibration"
        calibrated.mkdir(parents=True)
        (calibrated / "cam_to_cam.yaml").write_text(calibration(self._views), encoding="utf-8")
        for i in (0, 3):
            if i in self._views:
                folder = self._folder / "events" / SIDES[i]
                folder.mkdir(parents=True)
                sensor = self._sequence[self._views[i].name]
                self._counts["events"] += write_events(
                    self._h5py, folder / "events.h5", sensor, self._start_us
                )
                write_rectify_map(self._h5py, folder / "rectify_map.h5", self._views[i])
        self._write_pictures()
        self._write_disparities()
        self._write_flow()

    def _time_us(self, sensor: Sensor, tick: int) -> int:
        row = int(np.searchsorted(sensor.ticks, tick))
        return int(sensor.index[row, 1]) // 1000 + self._start_us

    def _write_times(self, path: pathlib.Path, sensor: Sensor, ticks: np.ndarray) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        text = "".join(f"{self._time_us(sensor, int(tick))}\n" for tick in ticks)
        path.write_text(text, encoding="utf-8")

    def _write_pictures(self) -> None:
        frames = {i: self._views[i] for i in (1, 2) if i in self._views}
        if not frames:
            return
        ticks = common_ticks(self._sequence, [view.name for view in frames.values()])
        sensor = self._sequence[frames[1].name]
        self._write_times(self._folder / "images" / "timestamps.txt", sensor, ticks)
        for i, view in frames.items():
            folder = self._folder / "images" / SIDES[i] / "rectified"
            folder.mkdir(parents=True)
            for number, tick in enumerate(ticks):
                record = self._sequence[view.name].at(int(tick))
                target = folder / f"{number:06d}.png"
                if view.is_rectified:
                    place(picture_file(record), target, False)
                else:
                    target.write_bytes(encode_png(rectified_picture(view, np.asarray(record["rgb"]))))
                self._counts["pictures"] += 1

    def _truth_of_events(self, array: str) -> Optional[Sensor]:
        """Returns the camera that has the pixels of the left event camera and this array."""
        shared = self._sequence[self._names.events_left].metadata.get("camera")
        if not isinstance(shared, str) or shared not in self._sequence.sensors:
            return None
        camera = self._sequence[shared]
        return camera if array in camera.arrays and len(camera) else None

    def _write_disparities(self) -> None:
        sources: List[tuple] = []
        events = self._truth_of_events("depth")
        if 3 in self._views and events is not None:
            sources.append(("event", self._views[0], events))
        if 2 in self._views and "depth" in self._sequence[self._views[1].name].arrays:
            sources.append(("image", self._views[1], self._sequence[self._views[1].name]))
        if not sources:
            return
        ticks = common_ticks(self._sequence, [camera.name for _, _, camera in sources])
        self._write_times(self._folder / "disparity" / "timestamps.txt", sources[0][2], ticks)
        for name, view, camera in sources:
            folder = self._folder / "disparity" / name
            folder.mkdir()
            for number, tick in enumerate(ticks):
                depth = np.asarray(camera.at(int(tick))["depth"])
                (folder / f"{number:06d}.png").write_bytes(encode_png(disparity(view, depth)))
                self._counts["disparities"] += 1

    def _write_flow(self) -> None:
        camera = self._truth_of_events("flow")
        if camera is None or len(camera) < 2:
            return
        folder = self._folder / "flow" / "forward"
        folder.mkdir(parents=True)
        lines = ["# from_timestamp_us, to_timestamp_us\n"]
        times = [self._time_us(camera, int(tick)) for tick in camera.ticks]
        # The flow of the last record leads to a picture that the data set has not.
        for row, (begin, end) in enumerate(zip(times, times[1:])):
            data = encode_png(optical_flow(self._views[0], np.asarray(camera.record(row)["flow"])))
            (folder / f"{row:06d}.png").write_bytes(data)
            lines.append(f"{begin}, {end}\n")
            self._counts["flows"] += 1
        (self._folder / "flow" / "forward_timestamps.txt").write_text("".join(lines), encoding="utf-8")


def _arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument(
        "--events-left", metavar="SENSOR", help="event camera cam0; needed if there are several"
    )
    parser.add_argument("--events-right", metavar="SENSOR", help="event camera cam3")
    parser.add_argument(
        "--images-left",
        metavar="SENSOR",
        help="camera cam1; default: that with the pixels of the left events",
    )
    parser.add_argument("--images-right", metavar="SENSOR", help="camera cam2")
    parser.add_argument("--start-us", type=int, default=0, help="time of tick 0, microseconds; default: 0")


COMMAND = Command(
    "dsec",
    "events, pictures, disparity and flow in DSEC's layout",
    lambda dataset, given: write_dsec(
        dataset,
        given.OUT,
        given.sequence,
        given.events_left,
        given.events_right,
        given.images_left,
        given.images_right,
        given.start_us,
    ),
    _arguments,
)
