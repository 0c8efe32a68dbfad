# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Trains a network that chooses one of several classes from the inputs of an item."""
from __future__ import annotations

from typing import Callable, Dict, Iterable, List, Optional

import numpy as np
import torch
from torch import nn

from tasks.common import models
from tasks.common.command import Context, machine
from tasks.common.report import Table
from tasks.common.training import Fit, fit, seed_everything, shuffled

from .networks import Fused

Batch = Dict[str, torch.Tensor]
Gather = Callable[[np.ndarray], Batch]  #: the inputs of some items
Change = Callable[[Batch, np.random.Generator], Batch]


def train(
    context: Context,
    names: List[str],
    seed: int,
    gather: Gather,
    label: np.ndarray,
    classes: int,
    split: Dict[str, np.ndarray],
    change: Optional[Change] = None,
) -> Fit:
    """Trains a network for the modalities `names` by the cross entropy, in a folder of the run.

    gather  gives the inputs of items, without the labels
    label   int64 [n]: the class of every item, from 0 to `classes` - 1
    change  changes a batch of the training, whose labels are its "label"
    """
    config, size = context.config.training, context.config.network
    seed_everything(seed)
    shapes = {name: tuple(value.shape[1:]) for name, value in gather(split["train"][:1]).items()}
    model = Fused(shapes, classes, size.widths, size.blocks, size.features, size.dropout)
    loss_of = nn.CrossEntropyLoss()

    def batches(generator: np.random.Generator) -> Iterable[Batch]:
        for items in shuffled(split["train"], config.batch, generator):
            batch = {**gather(items), "label": torch.from_numpy(label[items])}
            yield batch if change is None else change(batch, generator)

    def loss(net: nn.Module, batch: Batch):
        return loss_of(net(batch), batch["label"]), {}

    def validate(net: nn.Module) -> Dict[str, float]:
        truth = torch.from_numpy(label[split["validation"]])
        logits = torch.from_numpy(predict(net, gather, split["validation"], context.device))
        return {
            "loss": float(loss_of(logits, truth)),
            "right": float((logits.argmax(1) == truth).float().mean()),
        }

    return fit(
        context.out / f"{'_'.join(names)}_{seed}",
        model,
        batches,
        loss,
        validate,
        epochs=config.epochs,
        optimizer=lambda p: torch.optim.AdamW(p, lr=config.learning_rate, weight_decay=config.weight_decay),
        scheduler=lambda o: torch.optim.lr_scheduler.CosineAnnealingLR(o, config.epochs),
        seed=seed,
        device=context.device,
        title=f"{' + '.join(names)}, seed {seed}",
        patience=config.patience,
        tensorboard=context.tensorboard,
    )


def predict(net: nn.Module, gather: Gather, items: np.ndarray, device: torch.device) -> np.ndarray:
    """Returns the logits of the classes, float32 [item, class]."""
    net.eval()
    out = []
    with torch.no_grad():
        for first in range(0, len(items), 256):
            batch = gather(items[first : first + 256])
            out.append(net({name: value.to(device) for name, value in batch.items()}).cpu().numpy())
    return np.concatenate(out)


def trainings(fits: Dict[str, List[Fit]], gather_one: Callable[[str], Batch]) -> Table:
    """Returns a table of the networks' sizes and of the times of their trainings.

    gather_one  gives a batch of one item for the network of this name
    """
    rows = []
    for name, of in fits.items():
        net = of[0].model.cpu()
        rows.append(
            [
                name,
                f"{models.parameters(net) / 1e3:.0f}",
                f"{models.macs(net, gather_one(name)) / 1e6:.2f}",
                ", ".join(str(f.epochs) for f in of),
                f"{np.mean([f.seconds for f in of]):.0f}",
                f"{np.mean([f.cpu_seconds for f in of]):.0f}",
            ]
        )
    header = [
        "network",
        "1000 parameters",
        "million multiply-adds",
        "epochs of each seed",
        "s",
        "s of processor",
    ]
    return Table("Trainings, times of one seed on average", header, rows)


def notes(context: Context, drives: np.ndarray, split: Dict[str, np.ndarray], seconds: float, cpu: float):
    """Returns sentences about a run. `drives` [n] has the number of each item's drive."""
    m = machine(context.device)
    parts = ", ".join(f"{name} {len(np.unique(drives[i]))} ({len(i)})" for name, i in split.items())
    return [
        f"Configuration: {context.preset}; seeds {', '.join(map(str, context.seeds))}.  ",
        f"Drives (and items): {parts}.  ",
        f"{m['device']}, {m['threads']} threads, torch {m['torch']}; this run took {seconds:.0f} s and "
        f"{cpu:.0f} s of processor time.  ",
    ]
