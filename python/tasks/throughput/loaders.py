# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Measures loaders of data sets: items a second by storage and number of workers, and where the time goes."""
from __future__ import annotations

import gc
import time
from typing import Any, Callable, Dict, List, Mapping

import numpy as np
import torch

import greatx
from greatx.batch_reader import BatchReader, samples_of
from greatx.modalities import Source

from .generated import bytes_of
from .measures import Parts, Spread, cpu_seconds, load
from .settings import Loader


def speed(dataset: greatx.Dataset, modalities: Mapping[str, Any], settings: Loader, workers: int) -> Dict:
    """Returns items a second and processor time an item of greatx.batches."""
    loader = greatx.batches(dataset, modalities, settings.batch, seed=1, workers=workers)
    processes = [w.pid for w in _workers(loader, iter_once(loader))]
    return _measured(lambda: iter_once(loader), loader.items, settings.epochs, processes)


def speed_of_torch(
    dataset: greatx.Dataset, modalities: Mapping[str, Any], settings: Loader, workers: int
) -> Dict:
    """Returns the same of torch's own way: an item a dict, which the loader stacks to batches."""
    data = _Items(dataset, modalities)
    options = {"persistent_workers": True} if workers else {}
    generator = torch.Generator().manual_seed(1)
    loader = torch.utils.data.DataLoader(
        data, settings.batch, shuffle=True, num_workers=workers, generator=generator, **options
    )
    once = iter_once(loader)
    processes = [w.pid for w in getattr(getattr(loader, "_iterator", None), "_workers", [])]
    del once
    return _measured(lambda: iter_once(loader), len(data), settings.epochs, processes)


class _Items(torch.utils.data.Dataset):
    """Items as a user would write them by Dataset.samples and greatx.inputs."""

    def __init__(self, dataset: greatx.Dataset, modalities: Mapping[str, Any]):
        self._samples = samples_of(dataset, modalities)
        self._modalities = dict(modalities)
        self._makes: Dict[str, Callable[..., np.ndarray]] = {}

    def __len__(self) -> int:
        return len(self._samples)

    def __getitem__(self, i: int) -> Dict[str, torch.Tensor]:
        if not self._makes:
            source = Source.of(self._samples.dataset)
            self._makes = {name: m.bind(source) for name, m in self._modalities.items()}
        item = self._samples[i]
        return {name: torch.from_numpy(make(item, None)) for name, make in self._makes.items()}


def iter_once(loader: Any) -> int:
    """Goes through an epoch, and returns the number of batches."""
    count = 0
    for batch in loader:
        count += 1
        del batch
    return count


def _workers(loader: Any, _: int) -> List[Any]:
    return list(getattr(getattr(loader._loader, "_iterator", None), "_workers", []))


def _measured(epoch: Callable[[], int], items: int, epochs: int, processes: List[int]) -> Dict[str, Any]:
    rates: List[float] = []
    costs: List[float] = []
    gc.collect()
    for _ in range(epochs):
        begin, cpu = time.perf_counter(), cpu_seconds(processes)
        epoch()
        rates.append(items / (time.perf_counter() - begin))
        costs.append((cpu_seconds(processes) - cpu) / items * 1e3)
    return {"items_per_s": Spread.of(rates), "cpu_ms": Spread.of(costs), "load": load()}


def parts(dataset: greatx.Dataset, modalities: Mapping[str, Any]) -> Dict[str, Dict[str, float]]:
    """Returns the processor time in ms of reading (with decoding) and of making each modality, for an item in
    random order, medians over all items, and the bytes of an item on disk.
    """
    order = np.random.default_rng(1).permutation(len(samples_of(dataset, modalities)))
    source = Source.of(dataset)
    out: Dict[str, Dict[str, float]] = {}
    for name, modality in modalities.items():
        samples, make = samples_of(dataset, {name: modality}), modality.bind(source)
        first = make(samples[int(order[0])], None)
        for number in order[:32]:  # not measured: the C library learns to keep memory of these sizes
            make(samples[int(number)], first)
        measured = Parts()
        for number in order:
            with measured:
                item = samples[int(number)]
                measured.end("read")
                make(item, first)
                measured.end("make")
        out[name] = {part: float(np.median(s)) * 1e3 for part, s in measured.seconds.items()}
        out[name]["bytes"] = bytes_of(dataset, modality.arrays) / len(samples)
    return out


def whole(dataset: greatx.Dataset, modalities: Mapping[str, Any], batch: int) -> float:
    """Returns the processor time in ms of an item that is read into a batch in this process, the least of
    three epochs."""
    reader = BatchReader(samples_of(dataset, modalities), modalities)
    order = np.random.default_rng(1).permutation(len(reader.samples))
    out = reader.empty(batch)
    costs = []
    for _ in range(3):
        begin = time.thread_time()
        for first in range(0, len(order), batch):
            numbers = order[first : first + batch]
            reader.read(numbers, {name: array[: len(numbers)] for name, array in out.items()})
        costs.append((time.thread_time() - begin) / len(order) * 1e3)
    return min(costs)
