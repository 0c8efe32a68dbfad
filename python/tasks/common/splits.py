# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Splits of items into training, validation and test: by trajectory or by place, never by frame.

Neighbouring frames of one flight are almost equal. A split by frame would therefore test what was learned by
heart.
"""
from __future__ import annotations

from typing import Dict

import numpy as np

from greatx.errors import Error

Split = Dict[str, np.ndarray]

_GOLDEN = (5**0.5 - 1) / 2


def _assign(numbers: np.ndarray, shares: Dict[str, float]) -> np.ndarray:
    """Returns the index of the share into which each number (0, 1, 2, ...) falls. Multiples of the golden
    section modulo 1 spread evenly for every count (docs/campaigns.md)."""
    ends = np.cumsum(list(shares.values()))
    if min(shares.values()) <= 0 or abs(ends[-1] - 1) > 1e-9:
        raise Error(f"shares: expected positive shares that sum to 1, found {shares}")
    place = np.modf((np.asarray(numbers, np.float64) + 0.5) * _GOLDEN)[0]
    return np.minimum(np.searchsorted(ends, place, side="right"), len(ends) - 1)


def _gather(part: np.ndarray, shares: Dict[str, float], what: str) -> Split:
    split = {name: np.flatnonzero(part == i) for i, name in enumerate(shares)}
    empty = [name for name, items in split.items() if len(items) == 0]
    if empty:
        raise Error(f"split: no {what} fell to {empty[0]!r}: expected more of them, or larger shares")
    return split


def by_trajectory(trajectory: np.ndarray, shares: Dict[str, float]) -> Split:
    """Returns the items of each part. Items with equal numbers in `trajectory` [n] are in the same part."""
    _, number = np.unique(np.asarray(trajectory), return_inverse=True)
    return _gather(_assign(number, shares), shares, "trajectory")


def by_place(
    position_m: np.ndarray, cell_m: float, shares: Dict[str, float], seed: int = 0, gap_m: float = 0
) -> Split:
    """Returns the items of each part. The plane is cut into square cells, and each cell falls to a part.

    position_m  [n, 2 or more], m; only the first two coordinates count
    cell_m      side of a cell, m
    seed        moves the order in which cells fall to parts
    gap_m       items nearer than this to a cell of another part that has items are in no part
    """
    if not cell_m > 0 or not 0 <= gap_m < cell_m / 2:
        raise Error(f"split: expected cell_m > 0 and gap_m below its half, found {cell_m} and {gap_m}")
    place = np.asarray(position_m, np.float64)[:, :2] / cell_m
    cells = np.floor(place).astype(np.int64)
    taken, number = np.unique(cells, axis=0, return_inverse=True)
    order = np.random.default_rng(seed).permutation(len(taken))
    parts = _assign(order, shares)
    part = parts[number.reshape(-1)].copy()
    if gap_m > 0:
        part[_near_others(place, cells, taken, parts, gap_m / cell_m)] = -1
    return _gather(part, shares, "place")


def _near_others(place, cells, taken, parts, gap) -> np.ndarray:
    """Returns which items are nearer than `gap` (in cells) to a taken cell of another part."""
    of = {tuple(cell): part for cell, part in zip(taken.tolist(), parts.tolist())}
    own = np.array([of[tuple(cell)] for cell in cells.tolist()])
    near = np.zeros(len(place), bool)
    inside = place - cells
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            if dx == dy == 0:
                continue
            other = np.array([of.get((x + dx, y + dy), -1) for x, y in cells.tolist()])
            away = np.where(np.array([dx, dy]) < 0, inside, 1 - inside) * np.abs([dx, dy])
            near |= (other >= 0) & (other != own) & (np.hypot(*away.T) < gap)
    return near
