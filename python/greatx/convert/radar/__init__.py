# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes radar records in the folder layouts of CARRADA and RADIal (docs/exports.md, "Radar folders").

spectrum.py computes spectra and maps from a radar's samples, source.py chooses the radar and reads its
detections and pictures, carrada.py and radial.py write the folders.
"""

from . import carrada, radial
from .carrada import write_carrada
from .radial import write_radial

COMMANDS = (carrada.COMMAND, radial.COMMAND)

__all__ = ["COMMANDS", "write_carrada", "write_radial"]
