# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What the teacher and the student learn from.

The student has CSI alone. With distillation, its loss is the weighted sum of three mean squares: its position
and the truth, its features and the teacher's fused features (A. Romero et al., "FitNets: Hints for Thin Deep
Nets", ICLR 2015, eq. 3, with features of one size and thus without a regressor), its position and the
teacher's (G. Hinton et al., "Distilling the Knowledge in a Neural Network", 2015, for a regression).
"""
from __future__ import annotations

import dataclasses
from typing import Dict, NamedTuple, Optional, Tuple

import torch
from torch.nn.functional import mse_loss

from .models import Estimate, Positioner
from .settings import Distillation


class Targets(NamedTuple):
    """What the teacher says of n records: constants for the student."""

    position: torch.Tensor  #: [n, 3], standardised
    fused: torch.Tensor  #: [n, features]


def student_loss(
    estimate: Estimate, truth: torch.Tensor, targets: Optional[Targets], weights: Distillation
) -> Tuple[torch.Tensor, Dict[str, float]]:
    """Returns the loss and its parts, unweighted. Without targets it is that of the truth alone."""
    position = mse_loss(estimate.position, truth)
    if targets is None:
        return position, {}
    feature = mse_loss(estimate.fused, targets.fused)
    output = mse_loss(estimate.position, targets.position)
    loss = weights.truth * position + weights.feature * feature + weights.output * output
    parts = {"truth": position, "feature": feature, "output": output}
    return loss, {name: float(value.detach()) for name, value in parts.items()}


def teacher_loss(
    model: Positioner,
    inputs: Dict[str, torch.Tensor],
    present: torch.Tensor,
    truth: torch.Tensor,
    alone: float,
) -> Tuple[torch.Tensor, Dict[str, float]]:
    """Returns the loss of a teacher and its parts: the mean square of its positions with all modalities that
    are present, plus `alone` times the mean of those with each of them alone. The second part costs no
    further encoding, and teaches an encoder at full strength that the attention does not heed yet.
    """
    features = model.encode(inputs, present)
    fused = mse_loss(model.fuse(features, present).position, truth)
    if alone == 0:
        return fused, {}
    squares = (model.head(features) - truth.unsqueeze(1)).pow(2).mean(2)
    each = squares[present].mean()
    return fused + alone * each, {"fused": float(fused.detach()), "alone": float(each.detach())}


def random_phase(csi: torch.Tensor, phase: torch.Tensor) -> torch.Tensor:
    """Returns maps [n, 4, beams, delays] of channels times e^{j phase}, phase [n] in radians: the real and
    imaginary parts turn, the level stays, the phase over pi is shifted modulo 2.
    """
    angle = phase.reshape(-1, 1, 1)
    real = csi[:, 0] * torch.cos(angle) - csi[:, 1] * torch.sin(angle)
    imag = csi[:, 0] * torch.sin(angle) + csi[:, 1] * torch.cos(angle)
    turned = torch.remainder(csi[:, 3] + angle / torch.pi + 1, 2) - 1
    return torch.stack([real, imag, csi[:, 2], turned], 1)


@dataclasses.dataclass(frozen=True)
class Frame:
    """Standardised coordinates: metres from the mean of the training positions, over one scale for all axes.
    A mean square of them is therefore that of metres up to a factor, and no axis counts more than another.
    """

    mean_m: torch.Tensor  #: [3]
    scale_m: float

    @classmethod
    def of(cls, position_m: torch.Tensor) -> "Frame":
        """Returns the frame of training positions [n, 3]."""
        mean = position_m.mean(0)
        scale = float((position_m - mean).pow(2).mean().sqrt())
        return cls(mean, scale if scale > 0 else 1.0)

    def standardised(self, position_m: torch.Tensor) -> torch.Tensor:
        return ((position_m - self.mean_m) / self.scale_m).float()

    def metres(self, position: torch.Tensor) -> torch.Tensor:
        return position.double().cpu() * self.scale_m + self.mean_m
