# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Trains a network on channel matrices, and lets it restore others."""
from __future__ import annotations

import dataclasses
import pathlib
from typing import Any, Dict, Iterable, Optional, Tuple

import numpy as np
import torch
from torch import nn

from ..common.config import positive
from ..common.training import Fit, fit, warmed_cosine
from .floors import unit
from .models import Autoencoder
from .transforms import images, matrices


@dataclasses.dataclass
class Training:
    """How a network is trained (config.yaml explains the fields)."""

    start: str
    epochs: int
    samples: Optional[int]
    batch: int
    rate: float
    final_rate: float
    warm_up: int
    dense_rate: float
    rotate: bool

    def __post_init__(self) -> None:
        if self.start not in ("random", "principal"):
            raise ValueError(f"start: expected random or principal, found {self.start!r}")
        positive(epochs=self.epochs, batch=self.batch, rate=self.rate, dense_rate=self.dense_rate)
        if not 0 <= self.warm_up < self.epochs:
            raise ValueError(f"warm_up: expected 0 to {self.epochs - 1} epochs, found {self.warm_up}")


def train(
    folder: pathlib.Path,
    model: Autoencoder,
    training: Training,
    data: np.ndarray,
    validation: np.ndarray,
    *,
    seed: int,
    device: torch.device,
    title: str,
    tensorboard: bool = False,
) -> Fit:
    """Trains a model on matrices [n, angle, delay], or goes on with its training.

    The loss is the NMSE, which is the papers' mean squared error up to a factor, because all matrices have
    norm 1.
    """
    units = unit(data)
    check = torch.from_numpy(images(validation)).to(device)

    def batches(generator: np.random.Generator) -> Iterable[Dict[str, torch.Tensor]]:
        order = _drawn(len(units), training.samples or len(units), generator)
        for items in np.array_split(order, max(1, len(order) // training.batch)):
            part = units[items]
            if training.rotate:
                phase = generator.uniform(0, 2 * np.pi, (len(part), 1, 1))
                part = (part * np.exp(1j * phase)).astype(np.complex64)
            yield {"picture": torch.from_numpy(images(part))}

    def loss(net: nn.Module, batch: Dict[str, torch.Tensor]) -> Tuple[torch.Tensor, Dict[str, float]]:
        return picture_errors(batch["picture"], net(batch["picture"])).mean(), {}

    def validate(net: nn.Module) -> Dict[str, float]:
        errors = torch.cat([picture_errors(part, net(part)) for part in check.split(256)])
        return {"loss": float(errors.mean())}

    return fit(
        folder,
        model,
        batches,
        loss,
        validate,
        epochs=training.epochs,
        optimizer=lambda _: _optimizer(model, training),
        scheduler=lambda o: warmed_cosine(
            o, training.epochs, training.warm_up, training.final_rate / training.rate
        ),
        seed=seed,
        device=device,
        title=title,
        tensorboard=tensorboard,
    )


def _drawn(users: int, samples: int, generator: np.random.Generator) -> np.ndarray:
    """Returns the users of an epoch in random order. None comes twice before each came once."""
    rounds = -(-samples // users)
    return np.concatenate([generator.permutation(users) for _ in range(rounds)])[:samples]


def picture_errors(true: torch.Tensor, found: torch.Tensor) -> torch.Tensor:
    """Returns ||H - H'||^2 / ||H||^2 of pictures of matrices of norm 1, [n]. Pictures are halves."""
    return 4 * (true - found).square().sum((1, 2, 3))


def _optimizer(model: Autoencoder, training: Training) -> torch.optim.Optimizer:
    """Returns Adam, with a rate of their own for the two dense layers, whose entries are small."""
    dense = [*model.encoder.dense.parameters(), *model.dense.parameters()]
    known = {id(p) for p in dense}
    groups = [
        {"params": [p for p in model.parameters() if id(p) not in known], "lr": training.rate},
        {"params": dense, "lr": training.rate * training.dense_rate},
    ]
    if training.start == "random":
        return torch.optim.Adam(groups)
    return _CentredAdam(groups, model.encoder.dense.weight)


class _CentredAdam(torch.optim.Adam):
    """Adam that keeps the mean of each row of a weight (after H. Yong et al., "Gradient centralization", ECCV
    2020, who take the mean out of the gradient).

    The inputs of the encoder's dense layer have a mean of 0.5 and deviate from it by hundredths. Adam moves
    all weights of a row by steps of equal size, so that a small mean of the steps moves the output more than
    anything that the network learns.
    """

    def __init__(self, groups: Any, weight: nn.Parameter):
        super().__init__(groups)
        self._weight = weight

    @torch.no_grad()
    def step(self, closure: Any = None) -> Any:
        mean = self._weight.mean(dim=1, keepdim=True)
        out = super().step(closure)
        self._weight += mean - self._weight.mean(dim=1, keepdim=True)
        return out


def restore(model: nn.Module, channels: np.ndarray, device: torch.device) -> np.ndarray:
    """Returns matrices after they pass the network, complex64 of about norm 1."""
    model.eval()
    pictures = torch.from_numpy(images(channels)).split(256)
    with torch.no_grad():
        found = torch.cat([model(part.to(device)).cpu() for part in pictures])
    return matrices(found.numpy())
