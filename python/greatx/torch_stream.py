# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Implements Stream.torch. Only that function imports this module, because the module needs torch."""
from __future__ import annotations

from typing import Any, Callable, Dict, Iterator, Mapping, Optional

import numpy as np
import torch
import torch.utils.data

from .modalities import signed
from .streaming import Item, Stream


def _tensor(value: np.ndarray) -> torch.Tensor:
    """Returns a tensor, in the array's own memory if torch takes its type and may write to it."""
    value, dtype = signed(value)
    return torch.from_numpy(value.astype(dtype, copy=not value.flags.writeable))


class TorchStream(torch.utils.data.IterableDataset):
    """Provides a Stream as an endless iterable dataset of tensors."""

    def __init__(self, stream: Stream, transform: Optional[Callable[[Dict[str, Any]], Any]] = None):
        self.stream = stream
        self.transform = transform

    def state_dict(self) -> Dict[str, Any]:
        """Returns the state of the stream after the item that was given last (Stream.state_dict)."""
        return self.stream.state_dict()

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Goes on where another stream was (Stream.load_state_dict)."""
        self.stream.load_state_dict(state)

    def __iter__(self) -> Iterator[Any]:
        worker = torch.utils.data.get_worker_info()
        stream = self.stream if worker is None else self.stream.parted(worker.id, worker.num_workers)
        for item in stream:
            tensors: Item = {
                key: _tensor(value) if isinstance(value, np.ndarray) else value for key, value in item.items()
            }
            yield tensors if self.transform is None else self.transform(tensors)
