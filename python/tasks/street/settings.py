# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of the configurations of the tasks beside a street."""
from __future__ import annotations

import dataclasses
from typing import List, Sequence

from tasks.common.config import positive


@dataclasses.dataclass(frozen=True)
class Network:
    """The size of tasks.street.networks.Fused."""

    widths: List[int]
    blocks: int
    features: int
    dropout: float

    def __post_init__(self) -> None:
        positive(widths=min(self.widths, default=0), blocks=self.blocks, features=self.features)
        if not 0 <= self.dropout < 1:
            raise ValueError(f"dropout: expected 0 to less than 1, found {self.dropout}")


@dataclasses.dataclass(frozen=True)
class Training:
    """The optimiser of tasks.street.learning."""

    epochs: int
    batch: int
    learning_rate: float
    weight_decay: float
    patience: int

    def __post_init__(self) -> None:
        names = ("epochs", "batch", "learning_rate", "patience")
        positive(**{name: getattr(self, name) for name in names})
        if self.weight_decay < 0:
            raise ValueError(f"weight_decay: expected 0 or more, found {self.weight_decay}")


def check_networks(networks: Sequence[Sequence[str]], known: Sequence[str]) -> None:
    """For the checks of a dataclass: raises ValueError for networks with unknown modalities, or with none."""
    for names in networks:
        if not names or any(name not in known for name in names) or len(set(names)) < len(names):
            raise ValueError(f"networks: expected lists of {', '.join(known)}, found {list(names)}")
