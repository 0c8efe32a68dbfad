# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The configuration of the task; config.yaml says what each field means."""
from __future__ import annotations

import dataclasses
from typing import Dict, List, Tuple

from tasks.common.config import positive, shares
from tasks.street.settings import Network, Training, check_networks

MODALITIES = ("camera", "lidar")


@dataclasses.dataclass(frozen=True)
class Sensors:
    camera: str
    lidar: str
    channel: str


@dataclasses.dataclass(frozen=True)
class Inputs:
    camera_px: Tuple[int, int]
    lidar_cells: Tuple[int, int]

    def __post_init__(self) -> None:
        for name in ("camera_px", "lidar_cells"):
            positive(**{name: min(getattr(self, name))})


@dataclasses.dataclass(frozen=True)
class Settings:
    sensors: Sensors
    oversampling: int
    shares: Dict[str, float]
    inputs: Inputs
    networks: List[List[str]]
    network: Network
    training: Training
    mirror: bool
    delays: List[int]
    neighbours: int
    top: List[int]
    loss_limit_db: float
    draws: int

    def __post_init__(self) -> None:
        shares(self.shares)
        check_networks(self.networks, MODALITIES)
        positive(
            oversampling=self.oversampling,
            neighbours=self.neighbours,
            loss_limit_db=self.loss_limit_db,
            draws=self.draws,
            delays=min(self.delays, default=0),
            top=min(self.top, default=0),
        )
