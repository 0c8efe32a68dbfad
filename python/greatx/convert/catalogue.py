# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lists the converters in the order in which --help shows them."""

from __future__ import annotations

from . import (
    coco,
    deepmimo,
    dsec,
    euroc,
    hdf5,
    kitti,
    mcap,
    nuscenes,
    radar,
    rgbd,
    sionna,
    trajectories,
    webdataset,
)

COMMANDS = (
    deepmimo.COMMAND,
    sionna.COMMAND,
    *kitti.COMMANDS,
    nuscenes.COMMAND,
    coco.COMMAND,
    hdf5.COMMAND,
    webdataset.COMMAND,
    trajectories.COMMAND,
    rgbd.COMMAND,
    euroc.COMMAND,
    dsec.COMMAND,
    mcap.COMMAND,
    *radar.COMMANDS,
)
