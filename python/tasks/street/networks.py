# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Networks that keep where in the picture something is.

The direction of the car is its place in the picture. A ResNet ends with a mean over all places, which forgets
it; these encoders end with all places of a coarse grid.
"""
from __future__ import annotations

from typing import Dict, List, Sequence, Tuple

import torch
from torch import nn


class Encoder(nn.Module):
    """Turns [n, channels, rows, columns] into [n, features]: a convolution and a stage of residual blocks for
    each of `widths`, each of which halves rows and columns, except for the columns of the last stage; then
    a linear layer over all places."""

    def __init__(
        self, shape: Sequence[int], widths: Sequence[int], blocks: int, features: int, dropout: float
    ):
        super().__init__()
        from torchvision.models.resnet import BasicBlock

        before = shape[0]
        layers: List[nn.Module] = [
            nn.BatchNorm2d(before),  # inputs have units of their own
            nn.Conv2d(before, widths[0], 5, stride=2, padding=2, bias=False),
            nn.BatchNorm2d(widths[0]),
            nn.ReLU(inplace=True),
        ]
        before = widths[0]
        for stage, now in enumerate(widths):
            stride = (2, 1) if stage == len(widths) - 1 else 2
            for block in range(blocks):
                step = stride if block == 0 else 1
                down = None
                if block == 0:
                    down = nn.Sequential(nn.Conv2d(before, now, 1, step, bias=False), nn.BatchNorm2d(now))
                layers.append(BasicBlock(before, now, step, down))
                before = now
        self.layers = nn.Sequential(*layers)
        self.layers.eval()
        with torch.no_grad():
            places = self.layers(torch.zeros(1, *shape)).numel()
        self.layers.train()
        self.head = nn.Sequential(
            nn.Flatten(), nn.Dropout(dropout), nn.Linear(places, features), nn.ReLU(inplace=True)
        )

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.head(self.layers(x))


class Dense(nn.Module):
    """Turns vectors [n, values] into [n, features] by two layers."""

    def __init__(self, values: int, features: int, dropout: float):
        super().__init__()
        self.layers = nn.Sequential(
            nn.BatchNorm1d(values),
            nn.Linear(values, features),
            nn.ReLU(inplace=True),
            nn.Dropout(dropout),
            nn.Linear(features, features),
            nn.ReLU(inplace=True),
        )

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.layers(x)


class Fused(nn.Module):
    """Encodes each modality by itself, joins the features, and gives logits [n, classes].

    shapes  of an item of each modality: [channels, rows, columns], or [values]
    """

    def __init__(
        self,
        shapes: Dict[str, Tuple[int, ...]],
        classes: int,
        widths: Sequence[int],
        blocks: int,
        features: int,
        dropout: float,
    ):
        super().__init__()
        self.encoders = nn.ModuleDict(
            {
                name: (
                    Encoder(shape, widths, blocks, features, dropout)
                    if len(shape) == 3
                    else Dense(shape[0], features, dropout)
                )
                for name, shape in shapes.items()
            }
        )
        joined = features * len(shapes)
        self.head = nn.Sequential(
            nn.Dropout(dropout),
            nn.Linear(joined, features),
            nn.ReLU(inplace=True),
            nn.Linear(features, classes),
        )

    def forward(self, batch: Dict[str, torch.Tensor]) -> torch.Tensor:
        return self.head(torch.cat([encode(batch[name]) for name, encode in self.encoders.items()], 1))
