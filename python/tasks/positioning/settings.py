# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The configuration of the task; config.yaml says what each field means."""
from __future__ import annotations

import dataclasses
from typing import Dict, List, Optional

from tasks.common.config import positive, shares

#: The modalities in the order of the network's inputs, and the kinds of sensors that give them.
MODALITIES: Dict[str, str] = {
    "rgb": "camera",
    "depth": "camera",
    "csi": "csi",
    "lidar": "lidar",
    "radar": "radar",
    "events": "event_camera",
}
#: What the student has.
STUDENT = "csi"


@dataclasses.dataclass(frozen=True)
class Inputs:
    picture_px: int
    depth_m: float
    csi_delays: int
    csi_floor_db: float
    csi_power_dbm: Optional[float]
    csi_noise_figure_db: float
    lidar_rows: int
    lidar_columns: int
    radar_rows: int
    radar_columns: int
    event_bins: int
    event_px: int

    def __post_init__(self) -> None:
        names = [f.name for f in dataclasses.fields(self) if f.name not in ("csi_power_dbm",)]
        positive(**{name: getattr(self, name) for name in names if name != "csi_noise_figure_db"})

    def shapes(self, beams: int) -> Dict[str, tuple]:
        """Returns the shape of an item of each modality, for a channel of `beams` ports."""
        picture = (self.picture_px, self.picture_px)
        return {
            "rgb": (3, *picture),
            "depth": (1, *picture),
            "csi": (4, beams, self.csi_delays),
            "lidar": (2, self.lidar_rows, self.lidar_columns),
            "radar": (1, self.radar_rows, self.radar_columns),
            "events": (self.event_bins, self.event_px, self.event_px),
        }


@dataclasses.dataclass(frozen=True)
class Split:
    by: str
    shares: Dict[str, float]
    cell_m: float
    gap_m: float

    def __post_init__(self) -> None:
        if self.by not in ("trajectory", "place"):
            raise ValueError(f"by: expected trajectory or place, found {self.by!r}")
        shares(self.shares)


@dataclasses.dataclass(frozen=True)
class Network:
    depth: int
    width: float
    features: int
    coordinates: bool

    def __post_init__(self) -> None:
        positive(depth=self.depth, width=self.width, features=self.features)


@dataclasses.dataclass(frozen=True)
class Training:
    epochs: int
    batch: int
    learning_rate: float
    weight_decay: float
    warm_up: int

    def __post_init__(self) -> None:
        positive(epochs=self.epochs, batch=self.batch, learning_rate=self.learning_rate)
        if self.batch < 2:
            raise ValueError("batch: expected 2 or more for batch normalisation")


@dataclasses.dataclass(frozen=True)
class Distillation:
    truth: float
    feature: float
    output: float

    def __post_init__(self) -> None:
        weights = dataclasses.astuple(self)
        if min(weights) < 0 or max(weights) == 0:
            raise ValueError(f"truth, feature, output: expected weights >= 0, not all 0, found {weights}")


@dataclasses.dataclass(frozen=True)
class Config:
    modalities: List[str]
    inputs: Inputs
    split: Split
    network: Network
    modality_dropout: float
    alone: float
    random_phase: bool
    teacher: Training
    student: Training
    distillation: Distillation
    most_neighbours: int

    def __post_init__(self) -> None:
        unknown = [m for m in self.modalities if m not in MODALITIES]
        if unknown or len(set(self.modalities)) != len(self.modalities):
            known = ", ".join(MODALITIES)
            raise ValueError(f"modalities: expected different ones of {known}, found {self.modalities}")
        if STUDENT not in self.modalities:
            raise ValueError(f"modalities: expected {STUDENT} among them, which the student has")
        if not 0 <= self.modality_dropout < 1:
            raise ValueError(f"modality_dropout: expected 0 to below 1, found {self.modality_dropout}")
        if self.alone < 0:
            raise ValueError(f"alone: expected a weight of 0 or more, found {self.alone}")
        positive(most_neighbours=self.most_neighbours)
