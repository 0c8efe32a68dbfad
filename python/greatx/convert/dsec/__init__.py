# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes event cameras in the folder layout of DSEC (docs/exports.md, "DSEC").

rig.py chooses the cameras and computes how they are rectified, events.py writes events and rectify_map,
truth.py disparity and optical flow, and sequence.py puts the folder of a sequence together.
"""

from .sequence import COMMAND, write_dsec

__all__ = ["COMMAND", "write_dsec"]
