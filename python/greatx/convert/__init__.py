# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a data set's channels in the conventions of other tools (docs/converters.md). Nothing is normalised.

`python3 -m greatx.convert deepmimo|sionna DIR OUT` does the same from a shell.
"""

from .deepmimo import write_deepmimo
from .sionna import SionnaPaths, sionna_paths, write_sionna

__all__ = ["SionnaPaths", "sionna_paths", "write_deepmimo", "write_sionna"]
