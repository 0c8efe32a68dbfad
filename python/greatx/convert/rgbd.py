# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a camera with depth in the folders of the TUM RGB-D benchmark (J. Sturm et al., "A Benchmark for the
Evaluation of RGB-D SLAM Systems", IROS 2012), which RGB-D SLAM programs read (docs/exports.md,
"Trajectories").

Data flow: pictures are copied; depth in metres -> 16-bit PNG; poses of the camera's optical frame at every
record of poses -> groundtruth.txt; the specific force of an inertial sensor -> accelerometer.txt.
"""

from __future__ import annotations

import argparse
import os
import pathlib
from typing import Dict, List, Optional, Tuple, Union

import numpy as np

from ..dataset import Dataset, Sequence
from ..errors import DatasetError
from .common import Command, link_argument, sequence_argument
from .folders import Progress, new_folder, place
from .inertial import pick_imu, read_imu
from .motion import Motion, continuous, decimal_seconds, frame_of, number
from .png import encode_png
from .poses import node_of, nodes_of
from .rig import picture_file, sequences_of

#: Steps of a metre in the depth pictures of the benchmark.
DEPTH_FACTOR = 5000.0


def encode_depth(depth_m: np.ndarray, factor: float) -> Tuple[np.ndarray, int]:
    """Returns depth as uint16 [h, w], `factor` steps a metre, rounded to the nearest; 0 where there is none
    (sky), and where it is farther than 65535 steps. The second value counts the finite depths that are too
    far."""
    steps = np.round(np.where(np.isfinite(depth_m), depth_m, 0.0) * factor)
    far = steps > 65535.0
    return np.where(far | (steps < 0.0), 0.0, steps).astype(np.uint16), int(far.sum())


def _pick_camera(dataset: Dataset, name: Optional[str]) -> str:
    names = [
        n
        for n, info in dataset.sensors.items()
        if info.kind == "camera" and {"rgb", "depth"} <= set(info.arrays)
    ]
    if name is not None:
        if name not in names:
            raise DatasetError(
                f"{dataset.path}: expected a camera with rgb and depth {name!r} (--camera), found "
                f"{', '.join(names) or 'none'}"
            )
        return name
    if len(names) != 1:
        raise DatasetError(
            f"{dataset.path}: expected one camera with rgb and depth, found {', '.join(names) or 'none'}"
            + ("; say which one (--camera)" if names else "")
        )
    return names[0]


def _list(path: pathlib.Path, title: str, columns: str, lines: List[str]) -> None:
    path.write_text(f"# {title}\n# {columns}\n" + "".join(f"{line}\n" for line in lines), encoding="utf-8")


def _write_pictures(
    folder: pathlib.Path, sequence: Sequence, camera: str, factor: float, link: bool
) -> Tuple[int, int]:
    """Returns the number of pictures, and of depths that are too far."""
    (folder / "rgb").mkdir(parents=True)
    (folder / "depth").mkdir()
    lists: Dict[str, List[str]] = {"rgb": [], "depth": [], "associations": []}
    too_far = 0
    for record in sequence[camera]:
        time = decimal_seconds(record.time_ns)
        rgb, depth = f"rgb/{time}.png", f"depth/{time}.png"
        place(picture_file(record), folder / rgb, link)
        steps, far = encode_depth(np.asarray(record["depth"], np.float64), factor)
        too_far += far
        (folder / depth).write_bytes(encode_png(steps))
        lists["rgb"].append(f"{time} {rgb}")
        lists["depth"].append(f"{time} {depth}")
        lists["associations"].append(f"{time} {rgb} {time} {depth}")
    _list(folder / "rgb.txt", f"colour pictures of {camera}", "timestamp filename", lists["rgb"])
    _list(
        folder / "depth.txt",
        f"depth of {camera} along the optical axis, {number(factor)} steps a metre, 0: none",
        "timestamp filename",
        lists["depth"],
    )
    (folder / "associations.txt").write_text(
        "".join(f"{line}\n" for line in lists["associations"]), encoding="utf-8"
    )
    return len(lists["rgb"]), too_far


def _write_truth(folder: pathlib.Path, sequence: Sequence, camera: str) -> int:
    node, node_from_camera = frame_of(sequence, camera)
    motion = Motion(sequence, node)
    poses = motion.poses(node_from_camera)
    lines = [
        f"{decimal_seconds(int(t))} " + " ".join(number(v) for v in (*p.position, *q[[1, 2, 3, 0]]))
        for t, p, q in zip(motion.time_ns, poses, continuous([p.quaternion for p in poses]))
    ]
    title = f"world from the optical frame of {camera}, m"
    _list(folder / "groundtruth.txt", title, "timestamp tx ty tz qx qy qz qw", lines)
    return len(lines)


def _write_accelerometer(folder: pathlib.Path, sequence: Sequence, name: str) -> int:
    imu = read_imu(sequence, name)
    lines = [
        f"{decimal_seconds(int(t))} " + " ".join(number(v) for v in f) for t, f in zip(imu.time_ns, imu.force)
    ]
    title = f"specific force of {name} in its axes, m/s^2"
    _list(folder / "accelerometer.txt", title, "timestamp ax ay az", lines)
    return len(lines)


def write_rgbd(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    camera: Optional[str] = None,
    sequence: Optional[int] = None,
    depth_factor: float = DEPTH_FACTOR,
    imu: Optional[str] = None,
    link: bool = False,
) -> Dict[str, int]:
    """Writes OUT/sequence_0000 with rgb/, depth/, rgb.txt, depth.txt, associations.txt and groundtruth.txt of
    a camera, by default the only one with rgb and depth, and accelerometer.txt if its node has an inertial
    sensor (`imu`, if there are several; none: no file). Depth has `depth_factor` steps a metre in 16 bits:
    what is farther than 65535 / depth_factor is written as none, and counted. Returns counts of the written
    objects. Raises DatasetError, or FileExistsError if OUT is not empty.
    """
    if not (np.isfinite(depth_factor) and depth_factor > 0):
        raise DatasetError(f"expected a depth factor greater than 0, found {depth_factor}")
    camera = _pick_camera(dataset, camera)
    node = node_of(camera, nodes_of(dataset.sequences[0]))
    chosen = pick_imu(dataset, node, imu)
    sequences = sequences_of(dataset, sequence)
    counts = {"sequences": len(sequences), "pictures": 0, "poses": 0, "depths too far": 0}
    if chosen is not None:
        counts["samples"] = 0
    progress = Progress(len(sequences), "sequences")
    with new_folder(out) as root:
        for each in sequences:
            folder = root / each.path.name
            pictures, far = _write_pictures(folder, each, camera, depth_factor, link)
            counts["pictures"] += pictures
            counts["depths too far"] += far
            counts["poses"] += _write_truth(folder, each, camera)
            if chosen is not None:
                counts["samples"] += _write_accelerometer(folder, each, chosen)
            progress.step()
    progress.end()
    return counts


def _arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument(
        "--camera", metavar="NAME", help="camera with rgb and depth; needed if there are several"
    )
    parser.add_argument("--imu", metavar="NAME", help="inertial sensor of the camera's node, or none")
    parser.add_argument(
        "--depth-factor", type=float, default=DEPTH_FACTOR, help="steps a metre, 16 bits; default: 5000"
    )
    link_argument(parser)


COMMAND = Command(
    "tum-rgbd",
    "colour, depth and true poses of a camera, TUM RGB-D",
    lambda dataset, given: write_rgbd(
        dataset, given.OUT, given.camera, given.sequence, given.depth_factor, given.imu, given.link
    ),
    _arguments,
)
