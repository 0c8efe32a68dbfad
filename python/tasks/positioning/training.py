# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Trains teachers and students on cached inputs, and asks them for positions."""
from __future__ import annotations

import dataclasses
import math
import pathlib
from typing import Dict, Iterable, List, Optional, Tuple

import numpy as np
import torch
from torch.nn.functional import mse_loss

from tasks.common.inputs import tensor
from tasks.common.training import Fit, fit, shuffled, warmed_cosine

from .distillation import Frame, Targets, random_phase, student_loss, teacher_loss
from .models import Positioner, drop_modalities
from .settings import STUDENT, Config, Training

#: Records that are asked at once.
ASKED = 128


@dataclasses.dataclass
class Data:
    """Everything that a training takes."""

    arrays: Dict[str, np.ndarray]  #: by modality: inputs of all records
    present: torch.Tensor  #: bool [n, modalities]
    position_m: torch.Tensor  #: [n, 3]
    parts: Dict[str, np.ndarray]  #: train, validation, test: numbers of records
    frame: Frame
    config: Config
    device: torch.device
    tensorboard: bool = False

    @property
    def modalities(self) -> List[str]:
        return list(self.arrays)

    def channels(self, names: Iterable[str]) -> Dict[str, int]:
        return {name: self.arrays[name].shape[1] for name in names}


def _batches(data: Data, names: List[str], training: Training, targets: Optional[Targets], rows: np.ndarray):
    """Returns the function that fit() takes: the batches of an epoch. `targets` are those of `rows`."""
    columns = [data.modalities.index(name) for name in names]
    truth = data.frame.standardised(data.position_m)

    def batches(generator: np.random.Generator) -> Iterable[Dict[str, torch.Tensor]]:
        for at in shuffled(np.arange(len(rows)), training.batch, generator):
            items = rows[at]
            batch = {name: tensor(data.arrays[name], items) for name in names}
            if data.config.random_phase and STUDENT in names:
                phase = generator.uniform(0, 2 * math.pi, len(items))
                batch[STUDENT] = random_phase(batch[STUDENT], torch.from_numpy(phase).float())
            batch["present"] = data.present[items][:, columns]
            batch["truth"] = truth[items]
            if targets is not None:
                batch["teacher_position"] = targets.position[at]
                batch["teacher_fused"] = targets.fused[at]
            yield batch

    return batches


def encoded(model: Positioner, data: Data, rows: np.ndarray) -> Tuple[torch.Tensor, torch.Tensor]:
    """Returns the features [rows, modalities, features] and which are present, of a model in evaluation."""
    columns = [data.modalities.index(name) for name in model.modalities]
    model.eval()
    out = []
    with torch.no_grad():
        for first in range(0, len(rows), ASKED):
            items = rows[first : first + ASKED]
            inputs = {name: tensor(data.arrays[name], items).to(data.device) for name in model.modalities}
            out.append(model.encode(inputs, data.present[items][:, columns].to(data.device)))
    return torch.cat(out), data.present[rows][:, columns].to(data.device)


def asked(model: Positioner, data: Data, rows: np.ndarray) -> Targets:
    """Returns a model's positions and fused features of records with all modalities that they have."""
    with torch.no_grad():
        estimate = model.fuse(*encoded(model, data, rows))
    return Targets(estimate.position.cpu(), estimate.fused.cpu())


def _validation(data: Data):
    rows = data.parts["validation"]
    truth = data.frame.standardised(data.position_m[rows])

    def validate(model: Positioner) -> Dict[str, float]:
        position = asked(model, data, rows).position
        error = torch.linalg.norm(data.frame.metres(position) - data.position_m[rows], dim=1)
        return {"loss": float(mse_loss(position, truth)), "median_m": float(error.median())}

    return validate


def _fit(
    folder: pathlib.Path, model: Positioner, batches, loss, training: Training, data: Data, **names
) -> Fit:
    def optimizer(parameters):
        return torch.optim.AdamW(parameters, lr=training.learning_rate, weight_decay=training.weight_decay)

    return fit(
        folder,
        model,
        batches,
        loss,
        _validation(data),
        epochs=training.epochs,
        optimizer=optimizer,
        scheduler=lambda o: warmed_cosine(o, training.epochs, training.warm_up),
        device=data.device,
        tensorboard=data.tensorboard,
        **names,
    )


def train_teacher(folder: pathlib.Path, data: Data, seed: int) -> Fit:
    """Trains a network with all modalities, of which some are left out at random."""
    config = data.config
    torch.manual_seed(seed)
    model = Positioner(data.channels(data.modalities), config.network)

    def loss(model: Positioner, batch: Dict[str, torch.Tensor]):
        present = drop_modalities(batch["present"], config.modality_dropout)
        return teacher_loss(model, batch, present, batch["truth"], config.alone)

    batches = _batches(data, data.modalities, config.teacher, None, data.parts["train"])
    title = f"seed {seed}, teacher"
    return _fit(folder, model, batches, loss, config.teacher, data, seed=seed, title=title)


def train_student(folder: pathlib.Path, data: Data, seed: int, targets: Optional[Targets]) -> Fit:
    """Trains a network with CSI alone, from the teacher's `targets` of the training records, or without. Both
    begin with the same weights and see the same batches.
    """
    config = data.config
    torch.manual_seed(seed)
    model = Positioner(data.channels([STUDENT]), config.network)

    def loss(model: Positioner, batch: Dict[str, torch.Tensor]):
        said = None if targets is None else Targets(batch["teacher_position"], batch["teacher_fused"])
        return student_loss(model(batch), batch["truth"], said, config.distillation)

    batches = _batches(data, [STUDENT], config.student, targets, data.parts["train"])
    title = f"seed {seed}, student " + ("alone" if targets is None else "distilled")
    return _fit(folder, model, batches, loss, config.student, data, seed=seed, title=title)


def positions_m(model: Positioner, data: Data, rows: np.ndarray) -> np.ndarray:
    """Returns a model's positions [rows, 3], m."""
    return data.frame.metres(asked(model, data, rows).position).numpy()


def subset_errors_m(
    model: Positioner, data: Data, rows: np.ndarray, subsets: Dict[str, List[str]]
) -> Tuple[Dict[str, np.ndarray], np.ndarray]:
    """Returns the errors [rows] with each subset of the modalities, NaN for records that have none of it, and
    the attention weights [modalities] with all, means over the records.
    """
    features, present = encoded(model, data, rows)
    out = {}
    with torch.no_grad():
        weights = model.fuse(features, present).weights.mean(0).cpu().numpy()
        for title, names in subsets.items():
            mask = torch.tensor([name in names for name in model.modalities], device=present.device)
            here = present & mask
            some = here.any(1)
            errors = np.full(len(rows), np.nan)
            said = data.frame.metres(model.fuse(features[some], here[some]).position)
            there = some.cpu().numpy()
            true = data.position_m[rows[there]]
            errors[there] = torch.linalg.norm(said - true, dim=1).numpy()
            out[title] = errors
    return out, weights
