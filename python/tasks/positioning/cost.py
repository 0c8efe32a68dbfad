# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What a configuration costs, by a few measured steps on random inputs."""
from __future__ import annotations

import time
from typing import Any, Dict, List

import torch
from torch.nn.functional import mse_loss

from tasks.common.command import Context, machine
from tasks.common.models import macs, parameters

from .cache import beams_of
from .models import Positioner, drop_modalities
from .records import Opened, Records
from .settings import STUDENT, Network

#: Multiply-adds of a training step over those of a forward pass: the gradients by the inputs and by the
#: weights take as many each.
STEP = 3
#: A GPU for estimates: 156e12 floating-point operations a second are the peak of an NVIDIA A100's tensor
#: cores in TF32 (its data sheet), which torch's convolutions use there; the share is an assumption.
GPU_FLOPS, GPU_SHARE = 156e12, 0.3


def random_inputs(shapes: Dict[str, tuple], batch: int) -> Dict[str, torch.Tensor]:
    """Returns random inputs [batch, *shape] by modality."""
    return {name: torch.rand(batch, *shape) for name, shape in shapes.items()}


def step_seconds(
    shapes: Dict[str, tuple], network: Network, batch: int, dropout: float, steps: int, device: torch.device
) -> float:
    """Returns the median time of training steps of a network on random inputs, after one that is not counted:
    core-seconds on a CPU, whatever else it does, and seconds on a GPU.
    """
    clock = time.perf_counter if device.type == "cuda" else time.process_time
    torch.manual_seed(0)
    model = Positioner({name: shape[0] for name, shape in shapes.items()}, network).to(device)
    optimizer = torch.optim.AdamW(model.parameters(), lr=1e-4)
    inputs = {name: value.to(device) for name, value in random_inputs(shapes, batch).items()}
    truth = torch.zeros(batch, 3, device=device)
    seconds: List[float] = []
    for _ in range(steps + 1):
        present = drop_modalities(torch.ones(batch, len(shapes), dtype=torch.bool, device=device), dropout)
        began = clock()
        optimizer.zero_grad(set_to_none=True)
        mse_loss(model(inputs, present).position, truth).backward()
        optimizer.step()
        if device.type == "cuda":
            torch.cuda.synchronize(device)
        seconds.append(clock() - began)
    return sorted(seconds[1:])[(len(seconds) - 1) // 2]


def measure(context: Context, records: Records, opened: Opened, steps: int) -> None:
    """Prints what the run of a configuration takes on this device, and an estimate for a GPU."""
    config = context.config
    shapes = config.inputs.shapes(beams_of(opened, records))
    train = len(records.split(config.split)["train"])
    unit = "hours" if context.device.type == "cuda" else "core-hours"
    total: Dict[str, float] = {"here": 0.0, "gpu": 0.0}
    print(f"{machine(context.device)['device']}, {torch.get_num_threads()} threads; {train} training records")
    plans: List[Any] = [
        ("teacher", records.modalities, config.teacher, config.modality_dropout, 1),
        ("student", [STUDENT], config.student, 0.0, 2),
    ]
    for name, modalities, training, dropout, times in plans:
        own = {m: shapes[m] for m in modalities}
        model = Positioner({m: shape[0] for m, shape in own.items()}, config.network)
        forward = macs(model, random_inputs(own, 1))
        step = step_seconds(own, config.network, training.batch, dropout, steps, context.device)
        seen = train * training.epochs * times * len(context.seeds)
        hours = step / training.batch * seen / 3600
        operations = 2 * STEP * forward * (1 - dropout) * seen
        gpu = operations / (GPU_FLOPS * GPU_SHARE) / 3600
        total["here"] += hours
        total["gpu"] += gpu
        print(
            f"{name}: {parameters(model) / 1e6:.1f} million parameters, {forward / 1e9:.2f} G multiply-adds "
            f"a record, {1000 * step / training.batch:.1f} ms in training; {seen} records: "
            f"{hours:.2f} {unit} here"
        )
    print(
        f"in all {total['here']:.2f} {unit} here; an estimate for a GPU of {GPU_FLOPS / 1e12:.0f} "
        f"Tflop/s at a share of {GPU_SHARE:g}: {60 * total['gpu']:.2g} minutes"
    )
