# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Implements Dataset.torch. Only that function imports this module, because the module needs torch."""

from __future__ import annotations

from typing import Any, Callable, Dict, Optional

import numpy as np
import torch
import torch.utils.data

from .modalities import signed
from .samples import Samples


def to_tensor(value: np.ndarray) -> "torch.Tensor":
    """Copies an array to a tensor, because the files are mapped read-only. complex64 stays complex64, uint16
    becomes int32, uint32 becomes int64, and uint64 becomes int64 with the same bits.
    """
    value, dtype = signed(value)
    return torch.from_numpy(np.array(value, dtype=dtype))


def tensors(item: Dict[str, Any]) -> Dict[str, Any]:
    """Returns an item with tensors for its arrays."""
    return {key: to_tensor(value) if isinstance(value, np.ndarray) else value for key, value in item.items()}


class TorchDataset(torch.utils.data.Dataset):
    """Provides Samples as a map-style dataset of tensors, one dict per tick. "sequence", "tick", "time_s" and
    counts stay numbers, which torch's collate function converts to tensors. The object is picklable, so a
    DataLoader can use any number of workers.
    """

    def __init__(self, samples: Samples, transform: Optional[Callable[[Dict[str, Any]], Any]] = None):
        self.samples = samples
        self.transform = transform

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, i: int) -> Any:
        item = tensors(self.samples[i])
        return item if self.transform is None else self.transform(item)
