# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data sets in four layouts of KITTI (docs/exports.md)."""

from .odometry import COMMAND as _ODOMETRY
from .odometry import write_kitti_odometry
from .raw import COMMAND as _RAW
from .raw import write_kitti_raw
from .training import COMMANDS as _TRAINING
from .training import write_kitti_object, write_kitti_tracking

COMMANDS = (_RAW, _ODOMETRY, *_TRAINING)

__all__ = [
    "COMMANDS",
    "write_kitti_object",
    "write_kitti_odometry",
    "write_kitti_raw",
    "write_kitti_tracking",
]
