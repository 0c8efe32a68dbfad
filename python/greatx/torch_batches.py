# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Implements greatx.batches. Only that function imports this module, because the module needs torch.

Data flow: Batches chooses the items of each batch and a slot of shared memory -> a worker of a DataLoader
reads the items into the slot -> Batches gives the slot's memory to the user as tensors -> when the last of
them is gone, the slot is free for a later batch.

To reuse memory matters: 64 items with voxel grids are 100 MB, and a process that touches new memory waits for
the kernel to clear each page of it.
"""
from __future__ import annotations

import collections
import ctypes
import weakref
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np
import torch
import torch.utils.data

from .batch_reader import BatchReader, Field, order_of
from .errors import Error

#: Alignment of the arrays of a slot in bytes.
ALIGNMENT = 64
#: mallopt's parameters (malloc.h of glibc), and the memory that a worker may keep.
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, KEPT_BYTES = -1, -3, 1 << 28


class Slot:
    """Memory for a batch."""

    def __init__(self, number: int, fields: Dict[str, Field], items: int, shared: bool):
        self.number, self.fields, self.items = number, fields, items
        size = sum(-(-f.bytes_of(items) // ALIGNMENT) * ALIGNMENT for f in fields.values())
        self.memory = torch.empty(size, dtype=torch.uint8)
        if shared:
            self.memory.share_memory_()

    def arrays(self, items: int) -> Dict[str, np.ndarray]:
        """Returns the arrays of the first items, new objects that keep the memory alive."""
        return arrays_of(self.memory, self.fields, self.items, items)


def arrays_of(memory: torch.Tensor, fields: Dict[str, Field], room: int, items: int) -> Dict[str, np.ndarray]:
    """Returns the arrays of fields in the memory of a slot with room for `room` items."""
    flat, at, out = memory.numpy(), 0, {}
    for field in fields.values():
        size = field.bytes_of(room)
        out[field.name] = flat[at : at + size].view(field.dtype).reshape(room, *field.shape)[:items]
        at += -(-size // ALIGNMENT) * ALIGNMENT
    return out


class Pool:
    """Slots for batches. A slot that was given to a user is free again when nothing refers to it any more. Of
    free ones, `most` are kept.
    """

    def __init__(self, fields: Dict[str, Field], items: int, shared: bool, most: int):
        self._made = (fields, items, shared)
        self._most = most
        self._free: List[Slot] = []
        self.count = 0  #: slots that were made

    def take(self) -> Slot:
        if self._free:
            return self._free.pop()
        self.count += 1
        return Slot(self.count, *self._made)

    def give_back(self, slot: Slot) -> None:
        if len(self._free) < self._most:
            self._free.append(slot)

    def tensors(self, slot: Slot, items: int) -> Dict[str, torch.Tensor]:
        """Returns the arrays of a slot as tensors, and takes the slot back when they are gone. The memory of
        a tensor, and of all its views, refers to the NumPy array that it was made of.
        """
        arrays = slot.arrays(items)
        held = [len(arrays)]

        def gone() -> None:
            held[0] -= 1
            if not held[0]:
                self.give_back(slot)

        for array in arrays.values():
            weakref.finalize(array, gone).atexit = False
        return {name: torch.from_numpy(array) for name, array in arrays.items()}


def keep_memory(_: int = 0) -> None:
    """Tells the C library to keep freed memory for later arrays instead of returning it to the kernel, which
    would clear every page of it anew. Of other C libraries than glibc, does nothing.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):
        return
    mallopt(M_TRIM_THRESHOLD, KEPT_BYTES)
    mallopt(M_MMAP_THRESHOLD, KEPT_BYTES)


#: The work for a batch: its number, numbers of its items, number, memory and room of its slot.
Work = Tuple[int, np.ndarray, int, torch.Tensor, int]


class _Reading(torch.utils.data.Dataset):
    """What the workers do. Each keeps `most` slots mapped."""

    def __init__(self, reader: BatchReader, most: int):
        self.reader, self._most = reader, most
        self._mapped: "collections.OrderedDict[int, torch.Tensor]" = collections.OrderedDict()

    def __getitem__(self, work: Work) -> Tuple[int, Optional[List[str]]]:
        number, items, slot, memory, room = work
        # Memory that comes again is then the one that is mapped already.
        self._mapped[slot] = memory
        self._mapped.move_to_end(slot)
        while len(self._mapped) > self._most:
            self._mapped.popitem(last=False)
        return number, self.reader.read(items, arrays_of(memory, self.reader.fields, room, len(items)))


class _Works(torch.utils.data.Sampler):
    """Gives the work of an epoch, each with a slot, when the DataLoader asks for it.

    It refers to its Batches weakly, so that there is no cycle and an unused loader goes at once. When the
    collector of cycles ends workers, their queues are gone before them, and torch waits 5 s for each worker.
    """

    def __init__(self, batches: "Batches"):
        self._batches = weakref.proxy(batches)
        self.given: Dict[int, Tuple[Slot, np.ndarray]] = {}

    def __iter__(self) -> Iterator[Work]:
        # What an iteration that was left early asked for is not reused: a worker may still write to it.
        self.given = {}
        for number, items in enumerate(self._batches._numbers_of(self._batches._now)):
            slot = self._batches._pool.take()
            self.given[number] = (slot, items)
            yield number, items, slot.number, slot.memory, slot.items

    def __len__(self) -> int:
        return len(self._batches)


def _same(value: Any) -> Any:
    return value


class Batches:
    """Iterates over an epoch of batches, dicts of tensors; see greatx.batches. Each iteration is the next
    epoch.

    A batch has each modality [items, ...], "sequence", "tick", "time_s" and "item" (the number of an item,
    for instance of CampaignSamples) [items], and of a campaign "cell", a list.
    """

    def __init__(
        self,
        reader: BatchReader,
        numbers: np.ndarray,
        batch: int,
        shuffle: bool,
        seed: int,
        part: Tuple[int, int],
        drop_last: bool,
        workers: int,
        prefetch: int,
        context: Optional[str],
    ):
        self.reader, self.numbers, self.batch = reader, numbers, batch
        self.shuffle, self.seed, self.part, self.drop_last = shuffle, seed, part, drop_last
        self.workers = workers
        self.epoch = 0  #: of the next iteration
        self._now = 0
        if not len(self):
            raise Error(f"batches: expected items for a batch of {batch} or more, found {self.items}")
        slots = workers * prefetch + 2  # those that are read into, the user's, and the one before it
        self._pool = Pool(reader.fields, min(batch, self.items), workers > 0, slots)
        self._works = _Works(self)
        options: Dict[str, Any] = {}
        if workers > 0:
            options = {
                "prefetch_factor": prefetch,
                "persistent_workers": True,
                "multiprocessing_context": context,
                "worker_init_fn": keep_memory,
            }
        self._loader = torch.utils.data.DataLoader(
            _Reading(reader, slots),
            batch_size=None,
            sampler=self._works,
            num_workers=workers,
            collate_fn=_same,
            **options,
        )

    @property
    def items(self) -> int:
        """Returns the number of items of this part."""
        return len(self.numbers) // self.part[1]

    @property
    def fields(self) -> Dict[str, Field]:
        """Returns the shape of an item and the type of each array of a batch by name."""
        return self.reader.fields

    def __len__(self) -> int:
        """Returns the number of batches of an epoch."""
        return self.items // self.batch if self.drop_last else -(-self.items // self.batch)

    def set_epoch(self, epoch: int) -> None:
        """Chooses the epoch of the next iteration."""
        self.epoch = epoch

    def _numbers_of(self, epoch: int) -> List[np.ndarray]:
        """Returns the numbers of the items of each batch."""
        order = order_of(len(self.numbers), self.seed, epoch, self.shuffle, self.part)
        numbers = self.numbers[order]
        return [numbers[i * self.batch : (i + 1) * self.batch] for i in range(len(self))]

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        self._now, self.epoch = self.epoch, self.epoch + 1
        for number, cells in self._loader:
            slot, items = self._works.given.pop(number)
            batch: Dict[str, Any] = self._pool.tensors(slot, len(items))
            del slot
            batch["item"] = torch.from_numpy(items.copy())
            if cells is not None:
                batch["cell"] = cells
            yield batch
            del batch  # the user's reference is the last one

    def __repr__(self) -> str:
        return f"<greatx.Batches: {len(self)} of {self.batch} items, {', '.join(self.reader.modalities)}>"
