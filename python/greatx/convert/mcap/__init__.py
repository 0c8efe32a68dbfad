# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a run as an MCAP file with Foxglove's schemas (docs/exports.md, "MCAP").

output.py opens the file and registers schemas and topics, messages.py makes the messages of each kind of
sensor, scene.py those of boxes and radio paths, and run.py goes through the ticks.
"""

from .run import COMMAND, write_mcap

__all__ = ["COMMAND", "write_mcap"]
