# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Describes antennas that a simulation places, and their orientations."""
from __future__ import annotations

import dataclasses
import math
import os
from typing import Any, Dict, Optional, Sequence, Tuple, Union


@dataclasses.dataclass(frozen=True)
class Array:
    """Describes an array of equal elements whose boresight is +x, like `type: antenna` in a scenario
    (docs/scenario.md).

    Lengths are in wavelengths at the channel's carrier. Ports are numbered p = element * polarizations +
    polarization, elements are numbered row * columns + column. A field that is not given has the default of
    the scenario format. The scenario's parser checks all fields when the array is placed.

    pattern             pattern of one element: "isotropic" (default), "short_dipole", "half_wave_dipole",
                        "tr38901"
    pattern_file        file with a pattern, in place of `pattern`: CSV, MSI Planet (.msi, .pln), HFSS (.ffd)
    pattern_frequency_hz, pattern_power_w   frequency of the .ffd file, power in W that makes its fields
    pattern_vertical    "down" (default) or "up": how the vertical angles of an MSI Planet file grow
    polarization        "v" (default) or "h": one port per element; "vh" or "slant" (+45 and -45 degrees):
                        two ports
    slant_deg           one port per element with this slant, in place of `polarization`
    polarization_model  1 or 2 (default) of 3GPP TR 38.901, 7.3.2
    plane               "yz" (default): rows along +z, columns along +y; "xz"; "xy"
    rows, columns       default 1
    row_spacing_wl, column_spacing_wl   wavelengths, default 0.5
    elements_wl         [[x, y, z], ...] positions of the elements in wavelengths, in place of `plane`, the
                        rows, the columns and their spacings
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
    pattern_frequency_hz: Optional[float] = None
    pattern_power_w: Optional[float] = None
    pattern_vertical: Optional[str] = None

    def as_sensor(self, name: str, orientation_deg: Any = None) -> Dict[str, Any]:
        """Returns the array as an item of a scenario's `sensors`."""
        sensor: Dict[str, Any] = {"name": name, "type": "antenna"}
        if orientation_deg is not None:
            sensor["mount"] = {"rotation_deg": orientation_deg}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                sensor[field.name] = os.path.abspath(value) if field.name == "pattern_file" else value
        return sensor


def look_from_to(position_m: Any, target_m: Any) -> Tuple[float, float, float]:
    """Returns yaw, pitch and roll in degrees of an object at `position_m` whose +x axis points to `target_m`.
    Positive pitch is down."""
    x, y, z = (float(b) - float(a) for a, b in zip(position_m, target_m))
    return math.degrees(math.atan2(y, x)), -math.degrees(math.atan2(z, math.hypot(x, y))), 0.0
