# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Antennas to be placed, and where they look."""
from __future__ import annotations

import dataclasses
import math
import os
from typing import Any, Dict, Optional, Sequence, Tuple, Union


@dataclasses.dataclass(frozen=True)
class Array:
    """An array of equal elements that all look along +x (boresight), as a scenario's `type: antenna`
    (docs/scenario.md).

    Lengths are in wavelengths at the channel's carrier. Port p = element * polarizations + polarization,
    element = row * columns + column. What is not given is the scenario format's default, and that checks
    everything when the array is placed: no array is silently made of what it is not.

    pattern             of one element: "isotropic" (default), "short_dipole", "half_wave_dipole", "tr38901"
    pattern_file        a CSV in place of `pattern`
    polarization        "v" (default), "h": one port an element; "vh", "slant" (+45, -45 degrees): two
    slant_deg           one port of this slant, in place of `polarization`
    polarization_model  1 or 2 (default) of 3GPP TR 38.901, 7.3.2
    plane               "yz" (default): rows along +z, columns along +y; "xz", "xy"
    rows, columns       default 1
    row_spacing_wl, column_spacing_wl   wavelengths, default 0.5
    elements_wl         [[x, y, z], ...] wavelengths: elements wherever they are, in place of the five above
    """

    rows: Optional[int] = None
    columns: Optional[int] = None
    pattern: Optional[str] = None
    polarization: Optional[str] = None
    slant_deg: Optional[float] = None
    polarization_model: Optional[int] = None
    plane: Optional[str] = None
    row_spacing_wl: Optional[float] = None
    column_spacing_wl: Optional[float] = None
    elements_wl: Optional[Sequence[Sequence[float]]] = None
    pattern_file: Optional[Union[str, "os.PathLike[str]"]] = None

    def as_sensor(self, name: str, orientation_deg: Any = None) -> Dict[str, Any]:
        """The scenario's item of `sensors`."""
        sensor: Dict[str, Any] = {"name": name, "type": "antenna"}
        if orientation_deg is not None:
            sensor["mount"] = {"rotation_deg": orientation_deg}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                sensor[field.name] = os.path.abspath(value) if field.name == "pattern_file" else value
        return sensor


def look_from_to(position_m: Any, target_m: Any) -> Tuple[float, float, float]:
    """Yaw, pitch, roll in degrees of what is at `position_m` and has its +x towards `target_m`; positive
    pitch is down."""
    x, y, z = (float(b) - float(a) for a, b in zip(position_m, target_m))
    return math.degrees(math.atan2(y, x)), -math.degrees(math.atan2(z, math.hypot(x, y))), 0.0
