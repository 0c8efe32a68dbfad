# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The configuration of the task, and the inputs that it measures."""
from __future__ import annotations

import dataclasses
from typing import Any, Dict, List

from greatx.modalities import CsiMap, EventVoxels, Picture, RadarMap


@dataclasses.dataclass
class Data:
    sequences: int
    ticks: int  #: of a sequence; each is an item
    storage: List[str]  #: `--compression` of greatx generate
    seed: int


@dataclasses.dataclass
class Inputs:
    picture: int  #: pixels of a side, of pictures and of voxel grids
    delays: int
    event_bins: int


@dataclasses.dataclass
class Loader:
    batch: int
    workers: List[int]
    epochs: int


@dataclasses.dataclass
class Stream:
    items: int
    buffer: int
    prefetch: int


@dataclasses.dataclass
class Training:
    depth: int  #: of the ResNet of each modality
    width: float
    features: int
    steps: int
    workers: int


@dataclasses.dataclass
class Config:
    data: Data
    inputs: Inputs
    loader: Loader
    stream: Stream
    training: Training


def modalities(inputs: Inputs) -> Dict[str, Any]:
    """Returns what an item has."""
    return {
        "rgb": Picture("uav/front", inputs.picture),
        "csi": CsiMap("csi", inputs.delays),
        "radar": RadarMap("uav/radar"),
        "events": EventVoxels("uav/events", inputs.event_bins, inputs.picture),
    }
