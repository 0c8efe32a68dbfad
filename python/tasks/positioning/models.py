# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The network: an encoder for each modality, attention over those that are there, a head to coordinates."""
from __future__ import annotations

from typing import Dict, NamedTuple, Optional

import torch
from torch import nn

from tasks.common.models import resnet

from .settings import Network


class Estimate(NamedTuple):
    """What the network says of n records."""

    position: torch.Tensor  #: [n, 3], standardised
    fused: torch.Tensor  #: [n, features]
    weights: torch.Tensor  #: [n, modalities], 0 for those that are absent; each row sums to 1


def attention(scores: torch.Tensor, present: torch.Tensor) -> torch.Tensor:
    """Returns the softmax of scores [n, modalities] over the modalities that are present (bool, same shape).
    An absent one gets 0. Raises ValueError if a record has none.
    """
    if not bool(present.any(1).all()):
        raise ValueError("present: expected a modality in every record, found a record without any")
    return torch.softmax(scores.masked_fill(~present, float("-inf")), dim=1)


def with_coordinates(inputs: torch.Tensor) -> torch.Tensor:
    """Returns inputs [n, channels, height, width] with two more channels: the row and the column of each
    pixel, from -1 to 1 (R. Liu et al., "An Intriguing Failing of Convolutional Neural Networks and the
    CoordConv Solution", NeurIPS 2018). The axes of maps are angles, delays and ranges, which convolutions and
    the mean over all places would forget.
    """
    n, _, height, width = inputs.shape
    rows = torch.linspace(-1, 1, height, device=inputs.device).reshape(1, 1, height, 1)
    columns = torch.linspace(-1, 1, width, device=inputs.device).reshape(1, 1, 1, width)
    return torch.cat([inputs, rows.expand(n, 1, height, width), columns.expand(n, 1, height, width)], 1)


class Positioner(nn.Module):
    """Estimates positions from any subset of its modalities. The student is one with a single modality.

    channels  of the input of each modality, by name, in the order of all arrays "modalities"
    """

    def __init__(self, channels: Dict[str, int], network: Network):
        super().__init__()
        self.modalities = list(channels)
        self.features = network.features
        self.coordinates = network.coordinates
        self.encoders = nn.ModuleDict(
            {
                name: nn.Sequential(
                    resnet(
                        network.depth,
                        network.width,
                        count + (2 if network.coordinates else 0),
                        network.features,
                    ),
                    nn.LayerNorm(network.features),
                )
                for name, count in channels.items()
            }
        )
        self.scores = nn.ModuleDict({name: nn.Linear(network.features, 1) for name in channels})
        self.head = nn.Sequential(
            nn.Linear(network.features, network.features), nn.ReLU(), nn.Linear(network.features, 3)
        )

    def encode(self, inputs: Dict[str, torch.Tensor], present: torch.Tensor) -> torch.Tensor:
        """Returns features [n, modalities, features], 0 for a modality that is absent. An encoder sees the
        records that have its modality alone: this saves time in training, where some are left out, and keeps
        the zeros of absent inputs from its batch normalisation.
        """
        out = []
        for i, name in enumerate(self.modalities):
            rows = torch.nonzero(present[:, i]).squeeze(1)
            full = inputs[name].new_zeros((len(present), self.features))
            if len(rows):
                full = full.index_copy(0, rows, self._encode(name, inputs[name][rows]))
            out.append(full)
        return torch.stack(out, 1)

    def _encode(self, name: str, inputs: torch.Tensor) -> torch.Tensor:
        encoder = self.encoders[name]
        if self.coordinates:
            inputs = with_coordinates(inputs)
        if len(inputs) > 1 or not self.training:
            return encoder(inputs)
        encoder.eval()  # a single record has no variance: it takes the running means
        try:
            return encoder(inputs)
        finally:
            encoder.train()

    def fuse(self, features: torch.Tensor, present: torch.Tensor) -> Estimate:
        """Returns the estimate from features [n, modalities, features] of encode()."""
        scores = torch.cat([self.scores[name](features[:, i]) for i, name in enumerate(self.modalities)], 1)
        weights = attention(scores, present)
        fused = (weights.unsqueeze(2) * features).sum(1)
        return Estimate(self.head(fused), fused, weights)

    def forward(self, inputs: Dict[str, torch.Tensor], present: Optional[torch.Tensor] = None) -> Estimate:
        """Returns the estimate from inputs [n, channels, height, width] by modality. `present` is bool [n,
        modalities]; without it, all are there.
        """
        if present is None:
            first = inputs[self.modalities[0]]
            present = torch.ones(len(first), len(self.modalities), dtype=torch.bool, device=first.device)
        return self.fuse(self.encode(inputs, present), present)


def drop_modalities(present: torch.Tensor, probability: float) -> torch.Tensor:
    """Returns `present` (bool [n, modalities]) with each modality left out of each record with a
    probability; where all would be left out, one that was there stays, each equally often. Draws from torch's
    generator of the CPU.
    """
    draw = torch.rand(present.shape)
    kept = present.cpu() & (draw >= probability)
    lost = ~kept.any(1)
    if bool(lost.any()):
        # Of equal chances: the largest of independent draws among those that are there.
        chosen = torch.rand(present.shape).masked_fill(~present.cpu(), -1.0).argmax(1)
        kept[lost] = nn.functional.one_hot(chosen[lost], present.shape[1]).bool()
    return kept.to(present.device)
