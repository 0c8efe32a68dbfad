# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The training loop: epochs, checkpoints, resume, a log, progress.

A training has a folder. After each epoch it holds last.pt (everything that the next epoch needs), best.pt
(the weights of the epoch with the least validation loss) and log.csv (one row for each epoch). The random
numbers of an epoch follow from the seed and its number alone, so that a training that was stopped goes on to
the result of one that was not.
"""
from __future__ import annotations

import csv
import dataclasses
import io
import math
import pathlib
import sys
import time
from typing import Any, Callable, Dict, Iterable, List, Optional, Tuple

import numpy as np
import torch
from torch import nn

from greatx.errors import Error

from .files import write_text, write_torch
from .progress import duration

Batch = Dict[str, torch.Tensor]
Rows = List[Dict[str, float]]


@dataclasses.dataclass
class Fit:
    """The outcome of a training."""

    model: nn.Module  #: with the weights of the best epoch
    rows: Rows  #: of log.csv
    seconds: float  #: in all epochs, also those before a resume
    cpu_seconds: float

    @property
    def epochs(self) -> int:
        return len(self.rows)


def seed_everything(seed: int, epoch: int = 0) -> np.random.Generator:
    """Seeds torch, and returns a generator of NumPy, for an epoch of a training."""
    sequence = np.random.SeedSequence((seed, epoch))
    torch.manual_seed(int(sequence.generate_state(1, np.uint32)[0]))
    return np.random.default_rng(sequence.spawn(1)[0])


def shuffled(items: np.ndarray, batch: int, generator: np.random.Generator) -> Iterable[np.ndarray]:
    """Yields the items in random order, in batches. A single item that is left over is dropped, because batch
    normalisation has no variance of one."""
    order = generator.permutation(items)
    for first in range(0, len(order), batch):
        part = order[first : first + batch]
        if len(part) > 1 or len(order) == 1:
            yield part


def fit(
    folder: pathlib.Path,
    model: nn.Module,
    batches: Callable[[np.random.Generator], Iterable[Batch]],
    loss: Callable[[nn.Module, Batch], Tuple[torch.Tensor, Dict[str, float]]],
    validate: Callable[[nn.Module], Dict[str, float]],
    *,
    epochs: int,
    optimizer: Callable[[Iterable[nn.Parameter]], torch.optim.Optimizer],
    scheduler: Optional[Callable[[torch.optim.Optimizer], Any]] = None,
    seed: int,
    device: torch.device,
    title: str,
    patience: Optional[int] = None,
    tensorboard: bool = False,
) -> Fit:
    """Trains a model, or goes on with its training, and returns it with the weights of its best epoch.

    batches    gives the batches of an epoch, dicts of tensors, from the epoch's generator
    loss       gives a batch's loss, which is minimised, and figures for the log
    validate   gives figures of the model in its evaluation mode; the epoch with the least "loss" is the best
    scheduler  makes what is stepped after each epoch
    patience   ends the training after so many epochs without a better one

    Raises Error if a loss is not finite, or if the folder's checkpoint does not fit the model.
    """
    folder.mkdir(parents=True, exist_ok=True)
    model.to(device)
    state = _State(model, optimizer, scheduler)
    state.restore(folder / "last.pt", device)
    writer = _tensorboard(folder) if tensorboard else None
    progress = _Progress(title, epochs, len(state.rows))
    while len(state.rows) < epochs and not state.exhausted(patience):
        row = _epoch(state, batches, loss, validate, seed, device, title)
        state.rows.append(row)
        if state.is_best():
            write_torch(folder / "best.pt", model.state_dict())
        write_text(folder / "log.csv", _csv(state.rows))
        write_torch(folder / "last.pt", state.saved())
        for name, value in row.items() if writer else ():
            writer.add_scalar(name, value, len(state.rows))
        progress.show(row, len(state.rows))
    progress.end(len(state.rows))
    if writer:
        writer.close()
    model.load_state_dict(torch.load(folder / "best.pt", map_location=device))
    model.eval()
    return Fit(
        model, state.rows, sum(r["seconds"] for r in state.rows), sum(r["cpu_seconds"] for r in state.rows)
    )


def cosine_factor(epoch: int, epochs: int, warm_up: int = 0, last: float = 0.0) -> float:
    """Returns the learning rate of an epoch (0, 1, ...) relative to the highest one: a linear rise over the
    epochs of the warm-up, and half a cosine down to `last` (Z. Lu, J. Wang, J. Song, "Multi-resolution CSI
    feedback with deep learning in massive MIMO system", IEEE ICC 2020, equation 6).
    """
    if epoch < warm_up:
        return (epoch + 1) / (warm_up + 1)
    done = (epoch - warm_up) / max(epochs - warm_up, 1)
    return last + (1 - last) * (1 + math.cos(math.pi * min(done, 1.0))) / 2


def warmed_cosine(optimizer: torch.optim.Optimizer, epochs: int, warm_up: int = 0, last: float = 0.0) -> Any:
    """Returns a scheduler by cosine_factor, for fit()."""
    return torch.optim.lr_scheduler.LambdaLR(
        optimizer, lambda epoch: cosine_factor(epoch, epochs, warm_up, last)
    )


class _State:
    """A model in training, with all that its next epoch depends on."""

    def __init__(self, model: nn.Module, optimizer: Any, scheduler: Any):
        self.model = model
        self.optimizer = optimizer([p for p in model.parameters() if p.requires_grad])
        self.scheduler = None if scheduler is None else scheduler(self.optimizer)
        self.rows: Rows = []

    def saved(self) -> Dict[str, Any]:
        return {
            "model": self.model.state_dict(),
            "optimizer": self.optimizer.state_dict(),
            "scheduler": None if self.scheduler is None else self.scheduler.state_dict(),
            "rows": self.rows,
        }

    def restore(self, path: pathlib.Path, device: torch.device) -> None:
        if not path.is_file():
            return
        try:
            saved = torch.load(path, map_location=device)
            self.model.load_state_dict(saved["model"])
            self.optimizer.load_state_dict(saved["optimizer"])
            if self.scheduler is not None:
                self.scheduler.load_state_dict(saved["scheduler"])
            self.rows = saved["rows"]
        except Exception as error:
            raise Error(
                f"{path}: expected a checkpoint of this model, found another: {error}; "
                "another folder begins anew"
            ) from None

    def _losses(self) -> List[float]:
        return [row["validation_loss"] for row in self.rows]

    def is_best(self) -> bool:
        """Returns whether the last epoch is better than all before it."""
        losses = self._losses()
        return losses[-1] < min(losses[:-1], default=math.inf)

    def exhausted(self, patience: Optional[int]) -> bool:
        losses = self._losses()
        return patience is not None and bool(losses) and len(losses) - 1 - int(np.argmin(losses)) >= patience


def _epoch(state: _State, batches, loss, validate, seed, device, title) -> Dict[str, float]:
    """Trains one epoch, and returns its row of the log."""
    began, cpu = time.perf_counter(), time.process_time()
    rate = state.optimizer.param_groups[0]["lr"]
    generator = seed_everything(seed, len(state.rows) + 1)
    sums: Dict[str, float] = {}
    count = 0
    state.model.train()
    for batch in batches(generator):
        batch = {name: value.to(device, non_blocking=True) for name, value in batch.items()}
        state.optimizer.zero_grad(set_to_none=True)
        value, figures = loss(state.model, batch)
        value.backward()
        state.optimizer.step()
        count += 1
        for name, figure in {"loss": float(value.detach()), **figures}.items():
            sums[name] = sums.get(name, 0.0) + float(figure)
    if count == 0:
        raise Error(f"{title}: expected training data, found none")
    if not math.isfinite(sums["loss"]):
        raise Error(
            f"{title}: the loss of epoch {len(state.rows) + 1} is not finite: lower the learning rate"
        )
    if state.scheduler is not None:
        state.scheduler.step()
    state.model.eval()
    with torch.no_grad():
        validation = validate(state.model)
    row = {name: total / count for name, total in sums.items()}
    row.update({f"validation_{name}": float(value) for name, value in validation.items()})
    if not math.isfinite(row["validation_loss"]):
        raise Error(f"{title}: the validation loss of epoch {len(state.rows) + 1} is not finite")
    return {
        **row,
        "learning_rate": rate,
        "seconds": time.perf_counter() - began,
        "cpu_seconds": time.process_time() - cpu,
    }


def _csv(rows: Rows) -> str:
    text = io.StringIO()
    names = ["epoch", *rows[0]]
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows({"epoch": i + 1, **row} for i, row in enumerate(rows))
    return text.getvalue()


def _tensorboard(folder: pathlib.Path) -> Any:
    try:
        from torch.utils.tensorboard import SummaryWriter
    except ImportError as error:
        raise Error(f"--tensorboard: expected the package tensorboard: {error}") from None
    return SummaryWriter(str(folder))


class _Progress:
    """Shows the epoch, its validation loss, and the time that is left: one line that is written over on a
    terminal, and one line for every tenth of the epochs elsewhere."""

    def __init__(self, title: str, epochs: int, done: int):
        self.title, self.epochs, self.first = title, epochs, done
        self.began = time.perf_counter()
        self.terminal = sys.stdout.isatty()

    def show(self, row: Dict[str, float], done: int) -> None:
        step = max(1, self.epochs // 10)
        if not self.terminal and done % step and done != self.epochs:
            return
        left = (time.perf_counter() - self.began) / (done - self.first) * (self.epochs - done)
        text = (
            f"{self.title}: epoch {done} of {self.epochs}, loss {row['loss']:.4g}, "
            f"validation {row['validation_loss']:.4g}, {duration(left)} left"
        )
        print(f"\r{text:<100}" if self.terminal else text, end="" if self.terminal else "\n", flush=True)

    def end(self, done: int) -> None:
        if self.terminal and done > self.first:
            print()
