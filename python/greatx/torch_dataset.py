# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The torch half of Dataset.torch; imported only there, since it needs torch."""
from __future__ import annotations

from typing import Any, Callable, Dict, Optional

import numpy as np
import torch
import torch.utils.data

from .samples import Samples

#: torch computes with no unsigned integers but bytes: the next signed type that holds them; 64-bit ids keep
#: their bits.
_SIGNED = {"uint16": np.int32, "uint32": np.int64}


def to_tensor(value: np.ndarray) -> "torch.Tensor":
    """A tensor of its own memory (the files are mapped read-only). complex64 stays complex64; uint16 and
    uint32 become int32 and int64, uint64 becomes int64 with the same bits."""
    value = np.asarray(value)
    if value.dtype == np.uint64:
        value = value.view(np.int64)
    return torch.from_numpy(np.array(value, dtype=_SIGNED.get(value.dtype.name, value.dtype)))


class TorchDataset(torch.utils.data.Dataset):
    """Samples as tensors: map-style, one dict a tick; "sequence", "tick", "time_s" and counts stay numbers,
    which torch's own collate makes tensors of. Picklable, so any number of DataLoader workers will do."""

    def __init__(self, samples: Samples, transform: Optional[Callable[[Dict[str, Any]], Any]] = None):
        self.samples = samples
        self.transform = transform

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, i: int) -> Any:
        item = {
            key: to_tensor(value) if isinstance(value, np.ndarray) else value
            for key, value in self.samples[i].items()
        }
        return item if self.transform is None else self.transform(item)
