# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks sizes and results of the functions that make inputs of networks (greatx.inputs)."""
from __future__ import annotations

from typing import Any, Optional, Tuple, Union

import numpy as np

from .errors import Error

#: (rows, columns), or one number for both
Size = Union[int, Tuple[int, int]]


def sides_of(size: Size, name: str = "size") -> Tuple[int, int]:
    sides = (size, size) if isinstance(size, (int, np.integer)) else tuple(size)
    if len(sides) != 2 or not all(isinstance(s, (int, np.integer)) and s > 0 for s in sides):
        raise Error(f"{name}: expected one or two numbers of pixels above 0, found {size!r}")
    return int(sides[0]), int(sides[1])


def result(out: Optional[np.ndarray], shape: Tuple[int, ...], dtype: Any) -> np.ndarray:
    if out is None:
        return np.empty(shape, dtype)
    if out.shape != shape or out.dtype != np.dtype(dtype):
        raise Error(
            f"out: expected {np.dtype(dtype).name} {list(shape)}, found {out.dtype.name} {list(out.shape)}"
        )
    return out


def positive(**numbers: float) -> None:
    for name, number in numbers.items():
        if not (np.isfinite(number) and number > 0):
            raise Error(f"{name}: expected a number above 0, found {number!r}")
