# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The configuration of the task; config.yaml says what each field means."""
from __future__ import annotations

import dataclasses
from typing import Dict, List, Tuple

from tasks.common.config import positive, shares
from tasks.street.settings import Network, Training, check_networks

MODALITIES = ("power", "csi", "events", "radar")


@dataclasses.dataclass(frozen=True)
class Sensors:
    events: str
    radar: str
    channel: str


@dataclasses.dataclass(frozen=True)
class Inputs:
    events_px: Tuple[int, int]
    radar_cells: Tuple[int, int]
    radar_span_db: float
    csi_beams: int

    def __post_init__(self) -> None:
        positive(
            events_px=min(self.events_px),
            radar_cells=min(self.radar_cells),
            radar_span_db=self.radar_span_db,
            csi_beams=self.csi_beams,
        )


@dataclasses.dataclass(frozen=True)
class Settings:
    sensors: Sensors
    shares: Dict[str, float]
    past: int
    horizons: List[int]
    shown: int
    false_alarms: float
    inputs: Inputs
    networks: List[List[str]]
    network: Network
    training: Training
    mirror: bool
    draws: int

    def __post_init__(self) -> None:
        shares(self.shares)
        check_networks(self.networks, MODALITIES)
        positive(past=self.past, horizons=min(self.horizons, default=0), draws=self.draws)
        if self.horizons != sorted(set(self.horizons)):
            raise ValueError(f"horizons: expected different ticks in ascending order, found {self.horizons}")
        if self.shown not in self.horizons:
            raise ValueError(f"shown: expected one of the horizons {self.horizons}, found {self.shown}")
        if not 0 < self.false_alarms < 1:
            raise ValueError(f"false_alarms: expected a share between 0 and 1, found {self.false_alarms}")
