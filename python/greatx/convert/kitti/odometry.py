# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the layout of KITTI's odometry benchmark, which pykitti.odometry and most SLAM programs read.

    OUT/sequences/00/calib.txt  times.txt  velodyne/000000.bin
    OUT/sequences/00/image_2/000000.png         image_3 with a stereo pair
    OUT/poses/00.txt     a line a frame: [R | t], 3 x 4, of camera 0 in the frame of the first camera 0

Camera 0 is the left camera (see source.py). Positions are relative to the first frame, so the places of a
scene at UTM coordinates lose no digits.
"""

from __future__ import annotations

import os
from typing import Any, Dict, Union

from ...dataset import Dataset, Sequence
from ..common import Command
from ..folders import Progress, new_folder
from ..rig import Track, time_ns
from . import calibration as files
from .calibration import rows
from .source import Source, check_numbers, choice, choose, numbers, source_arguments


def write_kitti_odometry(
    dataset: Dataset, out: Union[str, "os.PathLike[str]"], **chosen: Any
) -> Dict[str, Any]:
    """Writes sequences of the odometry benchmark. Returns counts of the written objects. The arguments are
    those of source.choose(). Raises DatasetError, or FileExistsError if `out` is not empty."""
    source = choose(dataset, **chosen)
    check_numbers(source.sequences, 99, "odometry sequences")
    counts: Dict[str, Any] = {"sequences": 0, "frames": 0, "points": 0}
    progress = Progress(sum(len(source.ticks(s)) for s in source.sequences), "frames")
    with new_folder(out) as root:
        (root / "poses").mkdir()
        for sequence in source.sequences:
            name = f"{sequence.number:02d}"
            folder = root / "sequences" / name
            folder.mkdir(parents=True)
            (folder / "calib.txt").write_text(files.odometry(source.calibration))
            times = [time_ns(sequence, int(tick)) for tick in source.ticks(sequence)]
            (folder / "times.txt").write_text("".join(f"{1e-9 * (ns - times[0]):.9e}\n" for ns in times))
            (root / f"poses/{name}.txt").write_text(_poses(source, sequence))
            track = Track(sequence)
            for frame, tick in enumerate(int(tick) for tick in source.ticks(sequence)):
                for camera in source.cameras():
                    source.picture(sequence, camera, tick, folder / f"image_{camera}/{frame:06d}.png")
                if source.lidar:
                    target = folder / f"velodyne/{frame:06d}.bin"
                    counts["points"] += source.velodyne(sequence, tick, track, target)
                counts["frames"] += 1
                progress.step()
            counts["sequences"] += 1
    progress.end()
    return counts


def _poses(source: Source, sequence: Sequence) -> str:
    track = Track(sequence)
    node = track.nodes.index(source.rig.node)
    body_from_camera = source.calibration.camera_from_body.inverse()
    poses = [track.pose(node, int(tick)) @ body_from_camera for tick in source.ticks(sequence)]
    first = poses[0].inverse()
    return "".join(numbers(rows(first @ pose)) + "\n" for pose in poses)


COMMAND = Command(
    "kitti-odometry",
    "KITTI's odometry benchmark, for pykitti.odometry and SLAM programs",
    lambda dataset, given: write_kitti_odometry(dataset, given.OUT, **choice(given)),
    source_arguments,
)
