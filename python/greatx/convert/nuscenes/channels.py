# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Gives the sensors of a node nuScenes' channels: CAM_FRONT, LIDAR_TOP, RADAR_FRONT_LEFT, ...

nuScenes' carrier has six cameras and five radars, which look to fixed directions. A sensor gets the channel
whose direction is nearest to that of its own axis, by the azimuth of its mount. If several sensors are
nearest to one channel, the nearest of them gets it, and the others become CAM_ or RADAR_ with their own names
in capitals. So does a camera that looks within 15 degrees of straight up or down. The first LiDAR is
LIDAR_TOP. Arguments SENSOR=CHANNEL come before all this.
"""

from __future__ import annotations

import math
import re
from typing import Dict, List, Optional, Tuple

import numpy as np

from ...dataset import Sequence
from ...errors import DatasetError
from ..poses import mount
from ..rig import Rig

#: Azimuths of the axes, degrees from forward to the left (H. Caesar et al., CVPR 2020, figure 4: a front
#: camera every 55 degrees, the back camera opposite).
CAMERAS = {
    "CAM_FRONT": 0.0,
    "CAM_FRONT_LEFT": 55.0,
    "CAM_FRONT_RIGHT": -55.0,
    "CAM_BACK_LEFT": 110.0,
    "CAM_BACK_RIGHT": -110.0,
    "CAM_BACK": 180.0,
}
#: The side radars look across, and the two at the back backwards, a little to their sides.
RADARS = {
    "RADAR_FRONT": 0.0,
    "RADAR_FRONT_LEFT": 90.0,
    "RADAR_FRONT_RIGHT": -90.0,
    "RADAR_BACK_LEFT": 175.0,
    "RADAR_BACK_RIGHT": -175.0,
}
LIDAR = "LIDAR_TOP"
#: A camera whose axis is nearer to the vertical than this has no azimuth, degrees.
STEEP = 15.0


def azimuth_deg(axis: np.ndarray) -> Optional[float]:
    """Returns the azimuth of a direction [3] of the body, or None if it is nearly vertical."""
    if math.hypot(axis[0], axis[1]) < math.sin(math.radians(STEEP)) * float(np.linalg.norm(axis)):
        return None
    return math.degrees(math.atan2(axis[1], axis[0]))


def _by_direction(azimuths: Dict[str, Optional[float]], channels: Dict[str, float]) -> Dict[str, str]:
    """Returns channels of the sensors that are nearest to one."""
    best: Dict[str, Tuple[float, str]] = {}
    for name, azimuth in azimuths.items():
        if azimuth is None:
            continue
        off = {c: abs(math.remainder(azimuth - a, 360.0)) for c, a in channels.items()}
        channel = min(off, key=lambda c: (round(off[c], 6), list(channels).index(c)))
        if channel not in best or off[channel] < best[channel][0]:
            best[channel] = (off[channel], name)
    return {name: channel for channel, (_, name) in best.items()}


def _own(prefix: str, name: str) -> str:
    return prefix + re.sub(r"[^A-Z0-9]+", "_", name.upper()).strip("_")


def assign(sequence: Sequence, rig: Rig, given: Optional[List[str]] = None) -> Dict[str, str]:
    """Returns the channel of each sensor of a rig. `given` holds SENSOR=CHANNEL, where the sensor's name may
    lack its node. Raises DatasetError for arguments of another form, for unknown sensors, and for channels
    that are given twice or whose kind does not fit."""
    prefixes = {
        **{name: "CAM_" for name in rig.cameras},
        **{name: "LIDAR_" for name in rig.lidars},
        **{name: "RADAR_" for name in rig.radars},
    }
    out = _given(rig, given or [], prefixes)
    free = [name for name in rig.sensors if name not in out]
    for names, channels in ((rig.cameras, CAMERAS), (rig.radars, RADARS)):
        left = {c: a for c, a in channels.items() if c not in out.values()}
        azimuths = {n: azimuth_deg(mount(sequence[n].record(0)).rotation[:, 0]) for n in names if n in free}
        out.update(_by_direction(azimuths, left))
    for name in rig.lidars:
        if name in free and LIDAR not in out.values():
            out[name] = LIDAR
    for name in free:
        if name not in out:
            own = _own(prefixes[name], name[len(rig.node) + 1 :])
            while own in out.values():
                own += "_2"
            out[name] = own
    return {name: out[name] for name in rig.sensors}


def _given(rig: Rig, given: List[str], prefixes: Dict[str, str]) -> Dict[str, str]:
    out: Dict[str, str] = {}
    for pair in given:
        sensor, separator, channel = pair.partition("=")
        name = sensor if sensor in prefixes else f"{rig.node}/{sensor}"
        if not separator or name not in prefixes:
            raise DatasetError(
                f"--channel: expected SENSOR=CHANNEL with one of {', '.join(rig.sensors)}, found {pair!r}"
            )
        if not re.fullmatch(prefixes[name] + "[A-Z0-9_]+", channel):
            raise DatasetError(
                f"--channel: expected {prefixes[name]}... in capitals for {name}, found {channel!r}"
            )
        if channel in out.values():
            raise DatasetError(f"--channel: {channel} is given to two sensors")
        out[name] = channel
    return out
