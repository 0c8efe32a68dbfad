# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Implements Campaign.torch_shuffled. Only that function imports this module, because the module needs
torch."""
from __future__ import annotations

import copy
from typing import Any, Callable, Dict, Iterator, Optional

import torch
import torch.utils.data

from .campaign_samples import ShuffledSamples
from .torch_dataset import tensors


class TorchShuffled(torch.utils.data.IterableDataset):
    """Provides ShuffledSamples as an iterable dataset of tensors. The workers of a DataLoader share the
    sequences. The epoch is in shared memory, so that set_epoch() reaches persistent workers too.
    """

    def __init__(self, samples: ShuffledSamples, transform: Optional[Callable[[Dict[str, Any]], Any]] = None):
        self.samples = samples
        self.transform = transform
        self._epoch = torch.tensor(samples.epoch, dtype=torch.int64).share_memory_()

    def set_epoch(self, epoch: int) -> None:
        """Chooses the order of the next iterations."""
        self._epoch.fill_(epoch)

    def __len__(self) -> int:
        return len(self._now())

    def _now(self) -> ShuffledSamples:
        samples = copy.copy(self.samples)
        samples.set_epoch(int(self._epoch))
        return samples

    def __iter__(self) -> Iterator[Any]:
        worker = torch.utils.data.get_worker_info()
        samples = self._now()
        order = samples.order() if worker is None else samples.order(worker.id, worker.num_workers)
        for i in order:
            item = tensors(samples.samples[i])
            yield item if self.transform is None else self.transform(item)
