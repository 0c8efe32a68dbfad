# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes trajectories as lines `timestamp tx ty tz qx qy qz qw` of TUM RGB-D, which evo and most SLAM
programs read (docs/exports.md, "Trajectories").

Data flow: the poses of a node at every record, turned by the mount of a sensor if one is asked for -> lines.
"""

from __future__ import annotations

import argparse
import os
from typing import Dict, Optional, Sequence as SequenceOf, Union

from ..dataset import Dataset
from ..errors import DatasetError
from .common import Command, sequence_argument
from .folders import new_folder
from .motion import Motion, continuous, decimal_seconds, frame_of, number
from .poses import nodes_of
from .rig import sequences_of


def write_tum(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    frames: Optional[SequenceOf[str]] = None,
    sequence: Optional[int] = None,
) -> Dict[str, int]:
    """Writes OUT/sequence_0000/NAME.txt with lines `timestamp tx ty tz qx qy qz qw`: the pose in the world of
    each node or sensor in `frames`, by default of every node. A `/` in a name becomes `_`. A node has x
    forward, y left, z up; a camera has optical axes. Returns counts of the written objects. Raises
    DatasetError, or FileExistsError if OUT is not empty.
    """
    sequences = sequences_of(dataset, sequence)
    counts = {"sequences": len(sequences), "trajectories": 0, "poses": 0}
    with new_folder(out) as root:
        for each in sequences:
            folder = root / each.path.name
            folder.mkdir()
            for name in nodes_of(each) if frames is None else frames:
                node, pose = frame_of(each, name)
                motion = Motion(each, node)
                path = folder / (name.replace("/", "_") + ".txt")
                if path.exists():
                    raise DatasetError(
                        f"{dataset.path}: {name}: another trajectory is written to {path.name}"
                    )
                poses = motion.poses(pose)
                lines = [f"# world from {name}, m\n# timestamp tx ty tz qx qy qz qw\n"]
                for time_ns, at, q in zip(motion.time_ns, poses, continuous([p.quaternion for p in poses])):
                    values = " ".join(number(v) for v in (*at.position, *q[[1, 2, 3, 0]]))
                    lines.append(f"{decimal_seconds(int(time_ns))} {values}\n")
                path.write_text("".join(lines), encoding="utf-8")
                counts["trajectories"] += 1
                counts["poses"] += len(poses)
    return counts


def _tum_arguments(parser: argparse.ArgumentParser) -> None:
    sequence_argument(parser)
    parser.add_argument(
        "--frame",
        action="append",
        metavar="NAME",
        help="a node or sensor; may be repeated; default: every node",
    )


COMMAND = Command(
    "tum",
    "trajectories of nodes and sensors, TUM RGB-D",
    lambda dataset, given: write_tum(dataset, given.OUT, given.frame, given.sequence),
    _tum_arguments,
)
