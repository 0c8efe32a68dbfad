# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes data sets in the format of COCO (docs/exports.md)."""

from .write import COMMAND, write_coco

__all__ = ["COMMAND", "write_coco"]
