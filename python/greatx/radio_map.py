# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What Simulation.radio_map() gives."""
from __future__ import annotations

import json
from typing import Any, Dict, List, Tuple

from .tables import Arrays


class RadioMap(Arrays):
    """Arrays [tx, row, column] by name: path_gain, rss (dBm), sinr (dB), mean_delay, delay_spread (s),
    k_factor, angle spreads
    (rad), line_of_sight, paths; best_server [row, column] (-1: none). Row 0 is the southernmost, column 0 the
    westernmost: x [column], y [row], z [row, column] (m, world) are the cells' middles, `placement` [row,
    column] where they stand (0: free, 1: inside a solid, ...); cells without values are NaN.
    transmitter_position [tx, xyz]."""

    def __init__(self, facts: str, named: Any):
        super().__init__(named)
        #: channel, carrier_hz, power_dbm, bandwidth_hz, noise_w, cell_m, height (the rule, in words)
        self.facts: Dict[str, Any] = json.loads(facts)
        self.transmitters: List[str] = self.facts["transmitters"]

    @property
    def extent(self) -> Tuple[float, float, float, float]:
        """West, east, south, north edges in metres: matplotlib's imshow(rss[0], origin="lower",
        extent=map.extent)."""
        half = self.facts["cell_m"] / 2
        return self["x"][0] - half, self["x"][-1] + half, self["y"][0] - half, self["y"][-1] + half
