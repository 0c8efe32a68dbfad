# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Measures items a second straight from the engine."""
from __future__ import annotations

import itertools
import time
from typing import Any, Dict, Mapping

import greatx

from .generated import SCENARIO
from .measures import cpu_seconds, load
from .settings import Data, Stream


def speed(modalities: Mapping[str, Any], data: Data, settings: Stream) -> Dict[str, Any]:
    """Returns items a second of greatx.stream without a buffer, over whole sequences, and the processor time
    of an item, both with the beginning of sequences in them; and the same of going on in the middle."""
    stream = greatx.stream(SCENARIO, modalities, seed=data.seed, ticks=data.ticks, prefetch=settings.prefetch)
    items = iter(stream)
    begin = time.perf_counter()
    next(items)
    first_s = time.perf_counter() - begin
    begin, cpu = time.perf_counter(), cpu_seconds()
    count = sum(1 for _ in itertools.islice(items, settings.items))
    seconds, cpu = time.perf_counter() - begin, cpu_seconds() - cpu
    items.close()
    return {
        "items": count,
        "items_per_s": count / seconds,
        "cpu_ms": cpu / count * 1e3,
        "first_item_s": first_s,
        "load": load(),
        **_resumed(stream, modalities, data, settings),
    }


def _resumed(stream: Any, modalities: Mapping[str, Any], data: Data, settings: Stream) -> Dict[str, Any]:
    """Goes on from the state of a stream with a buffer, and checks that the next item is the same."""
    options = {"seed": data.seed, "ticks": data.ticks, "buffer": settings.buffer}
    mixed = greatx.stream(SCENARIO, modalities, **options)
    items = iter(mixed)
    next(items)
    state = mixed.state_dict()
    expected = next(items)
    items.close()
    again = greatx.stream(SCENARIO, modalities, **options)
    again.load_state_dict(state)
    begin = time.perf_counter()
    items = iter(again)
    found = next(items)
    seconds = time.perf_counter() - begin
    items.close()
    same = all((expected[name] == found[name]).all() for name in modalities)
    return {"resume_s": seconds, "resume_same": bool(same)}
