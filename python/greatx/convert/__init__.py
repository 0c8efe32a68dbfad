# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data sets in the formats of other tools (docs/exports.md). Nothing is normalised.

`python3 -m greatx.convert TOOL DIR OUT` does the same from a shell.
"""

from .coco import write_coco
from .deepmimo import write_deepmimo
from .dsec import write_dsec
from .euroc import write_euroc
from .hdf5 import write_hdf5
from .kitti import write_kitti_object, write_kitti_odometry, write_kitti_raw, write_kitti_tracking
from .mcap import write_mcap
from .nuscenes import write_nuscenes
from .radar import write_carrada, write_radial
from .rgbd import write_rgbd
from .sionna import SionnaPaths, sionna_paths, write_sionna
from .trajectories import write_tum
from .webdataset import write_webdataset

__all__ = [
    "SionnaPaths",
    "sionna_paths",
    "write_carrada",
    "write_coco",
    "write_deepmimo",
    "write_dsec",
    "write_euroc",
    "write_hdf5",
    "write_kitti_object",
    "write_kitti_odometry",
    "write_kitti_raw",
    "write_kitti_tracking",
    "write_mcap",
    "write_nuscenes",
    "write_radial",
    "write_rgbd",
    "write_sionna",
    "write_tum",
    "write_webdataset",
]
