# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The result of Simulation.radio_map()."""
from __future__ import annotations

import json
from typing import Any, Dict, List, Tuple

from .tables import Arrays


class RadioMap(Arrays):
    """Holds the arrays of a radio map by name.

    The arrays [tx, row, column] are path_gain, rss (dBm), sinr (dB), mean_delay and delay_spread (s),
    k_factor, the angle spreads (rad), line_of_sight and paths. best_server is [row, column]; -1 stands for
    none. Cells without values are NaN. Row 0 is the southernmost, column 0 the westernmost. x [column], y
    [row] and z [row, column] (m, world) are the centres of the cells. `placement` [row, column] classifies
    the centres (0: free, 1: inside a solid, ...). transmitter_position is [tx, xyz].
    """

    def __init__(self, facts: str, named: Any):
        super().__init__(named)
        #: channel, carrier_hz, power_dbm, bandwidth_hz, noise_w, cell_m, height (the rule in words), ...
        self.facts: Dict[str, Any] = json.loads(facts)
        self.transmitters: List[str] = self.facts["transmitters"]

    @property
    def extent(self) -> Tuple[float, float, float, float]:
        """Returns the west, east, south and north edges in metres, for matplotlib's imshow(rss[0],
        origin="lower", extent=map.extent).
        """
        half = self.facts["cell_m"] / 2
        return self["x"][0] - half, self["x"][-1] + half, self["y"][0] - half, self["y"][-1] + half
