# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Named arrays with units."""
from __future__ import annotations

from typing import Dict, Iterable, Iterator, List, Mapping, Tuple

import numpy as np


class Arrays(Mapping[str, np.ndarray]):
    """Maps names to arrays: arrays["delay"] or arrays.delay. unit(name) returns an array's unit, and
    description(name) its axes and meaning."""

    def __init__(self, named: Iterable[Tuple[str, str, str, np.ndarray]]):
        self._arrays: Dict[str, np.ndarray] = {}
        self._about: Dict[str, Tuple[str, str]] = {}
        for name, unit, description, array in named:
            self._arrays[name] = array
            self._about[name] = (unit, description)

    def unit(self, name: str) -> str:
        return self._about[name][0]

    def description(self, name: str) -> str:
        return self._about[name][1]

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self._arrays[name]
        except KeyError:
            raise KeyError(f"no array {name!r}; there are {', '.join(self._arrays)}") from None

    def __getattr__(self, name: str) -> np.ndarray:
        if not name.startswith("_") and name in self._arrays:
            return self._arrays[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __dir__(self) -> List[str]:
        return sorted({*super().__dir__(), *self._arrays})

    def __repr__(self) -> str:
        rows = [
            f"  {name}: {a.dtype} {list(a.shape)} {self.unit(name)}  {self.description(name)}"
            for name, a in self._arrays.items()
        ]
        return "\n".join([f"<greatx.{type(self).__name__}", *rows]) + ">"
