# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data sets in the formats of other tools (docs/exports.md). Nothing is normalised.

`python3 -m greatx.convert TOOL DIR OUT` does the same from a shell.
"""

from .coco import write_coco
from .deepmimo import write_deepmimo
from .kitti import write_kitti_object, write_kitti_odometry, write_kitti_raw, write_kitti_tracking
from .nuscenes import write_nuscenes
from .sionna import SionnaPaths, sionna_paths, write_sionna

__all__ = [
    "SionnaPaths",
    "sionna_paths",
    "write_coco",
    "write_deepmimo",
    "write_kitti_object",
    "write_kitti_odometry",
    "write_kitti_raw",
    "write_kitti_tracking",
    "write_nuscenes",
    "write_sionna",
]
