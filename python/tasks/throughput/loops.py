# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Measures a training loop: how long it waits for its loader, and how long its network works."""
from __future__ import annotations

import time
from typing import Any, Dict, Iterator, Mapping

import torch
from torch import nn

import greatx

from tasks.common.models import macs, parameters, resnet

from .measures import cpu_seconds, load
from .settings import Loader, Training


class Network(nn.Module):
    """An encoder for each modality, and a linear layer that finds a position by all of them."""

    def __init__(self, fields: Mapping[str, Any], names: Mapping[str, Any], settings: Training):
        super().__init__()
        self.encoders = nn.ModuleDict(
            {
                name: resnet(settings.depth, settings.width, fields[name].shape[0], settings.features)
                for name in names
            }
        )
        self.head = nn.Linear(settings.features * len(names), 3)

    def forward(self, batch: Mapping[str, torch.Tensor]) -> torch.Tensor:
        features = []
        for name, encoder in self.encoders.items():
            value = batch[name]
            features.append(encoder(value.float() / 255 if value.dtype == torch.uint8 else value))
        return self.head(torch.cat(features, dim=1))


def endless(loader: Any) -> Iterator[Mapping[str, Any]]:
    """Yields the batches of one epoch after the other."""
    while True:
        yield from loader


def training(
    dataset: greatx.Dataset,
    modalities: Mapping[str, Any],
    batch: Loader,
    settings: Training,
    device: torch.device,
) -> Dict[str, Any]:
    """Trains for some steps, and returns seconds of waiting for batches and of the network (with copies to
    its device), by the clock and as processor time, and its size. The first step is not counted.
    """
    torch.manual_seed(1)
    loader = greatx.batches(
        dataset, modalities, batch.batch, seed=1, workers=settings.workers, drop_last=True
    )
    network = Network(loader.fields, modalities, settings).to(device)
    optimizer = torch.optim.AdamW(network.parameters(), lr=1e-3)
    size: Dict[str, Any] = {"parameters": parameters(network)}
    waited = worked = cpu_network = cpu_loader = 0.0
    processes = []
    batches = endless(loader)
    for step in range(settings.steps + 1):
        begin = time.perf_counter()
        cpu = cpu_seconds(processes)
        held = {k: v.to(device) for k, v in next(batches).items() if k in modalities}
        middle = time.perf_counter()
        alone = time.process_time()
        loss = network(held).square().mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        if device.type == "cuda":
            torch.cuda.synchronize(device)
        if step == 0:
            size["macs"] = macs(network, {k: v[:2] for k, v in held.items()})
            processes = [w.pid for w in loader._loader._iterator._workers] if settings.workers else []
            continue
        waited += middle - begin
        worked += time.perf_counter() - middle
        network_cpu = time.process_time() - alone
        cpu_network += network_cpu
        cpu_loader += cpu_seconds(processes) - cpu - network_cpu
    items = settings.steps * batch.batch
    return {
        **size,
        "wait_ms": waited / items * 1e3,
        "network_ms": worked / items * 1e3,
        "wait_share": waited / (waited + worked),
        "network_cpu_ms": cpu_network / items * 1e3,
        "loader_cpu_ms": cpu_loader / items * 1e3,
        "load": load(),
    }
