# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data sets in the format of nuScenes (docs/exports.md)."""

from .command import COMMAND
from .write import write_nuscenes

__all__ = ["COMMAND", "write_nuscenes"]
