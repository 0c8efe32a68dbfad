# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lists the converters in the order in which --help shows them."""

from __future__ import annotations

from . import deepmimo, kitti, sionna

COMMANDS = (
    deepmimo.COMMAND,
    sionna.COMMAND,
    *kitti.COMMANDS,
)
