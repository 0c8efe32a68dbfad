# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of errors with intervals that say how far they would differ on other data and other seeds.

Frames of one trajectory resemble each other, so the bootstrap draws whole trajectories (the cluster
bootstrap; A. C. Davison and D. V. Hinkley, "Bootstrap Methods and their Application", 1997, section 3.8), and
the seeds of the trainings, both with replacement. The interval is that of the percentiles (section 5.3.1).
"""
from __future__ import annotations

from typing import Callable, Dict, Iterator, List, NamedTuple, Optional

import numpy as np

Statistic = Callable[[np.ndarray], float]


class Interval(NamedTuple):
    """A figure, and the bounds of its bootstrap interval."""

    value: float
    low: float
    high: float

    def text(self, digits: int = 2) -> str:
        """Returns "value (low to high)"."""
        return f"{self.value:.{digits}f} ({self.low:.{digits}f} to {self.high:.{digits}f})"


def percentile(share: float) -> Statistic:
    """Returns the statistic "percentile", with a share in percent."""
    return lambda values: float(np.percentile(values, share))


def mean(values: np.ndarray) -> float:
    """Returns the mean."""
    return float(np.mean(values))


def _table(values: np.ndarray) -> np.ndarray:
    values = np.asarray(values)
    if values.ndim not in (1, 2) or values.size == 0:
        raise ValueError(f"values: expected [n] or [seeds, n] and at least one, found {values.shape}")
    return values[None] if values.ndim == 1 else values


def _draws(shape, groups: Optional[np.ndarray], draws: int, seed: int) -> Iterator[tuple]:
    """Yields the rows (seeds) and the columns (items) of each draw."""
    generator = np.random.default_rng(seed)
    rows, count = shape
    labels = np.arange(count) if groups is None else np.asarray(groups)
    if labels.shape != (count,):
        raise ValueError(f"groups: expected [{count}], found {list(labels.shape)}")
    order = np.argsort(labels, kind="stable")
    _, starts, lengths = np.unique(labels[order], return_index=True, return_counts=True)
    for _ in range(draws):
        chosen = generator.integers(len(starts), size=len(starts))
        of = lengths[chosen]
        first = np.repeat(starts[chosen] - (np.cumsum(of) - of), of)  # so that each group's places follow
        yield generator.integers(rows, size=rows), order[first + np.arange(len(first))]


def bootstrap(
    values: np.ndarray,
    statistic: Statistic,
    groups: Optional[np.ndarray] = None,
    *,
    draws: int = 2000,
    level: float = 0.95,
    seed: int = 0,
) -> Interval:
    """Returns a statistic of all values [n] or [seeds, n], and its interval.

    groups  [n]: items with the same group (a trajectory, a place) are drawn together; None: each by itself
    """
    return _estimate([_table(values)], statistic, groups, draws, level, seed)


def paired_difference(
    a: np.ndarray,
    b: np.ndarray,
    statistic: Statistic,
    groups: Optional[np.ndarray] = None,
    *,
    draws: int = 2000,
    level: float = 0.95,
    seed: int = 0,
) -> Interval:
    """Returns statistic(a) - statistic(b) of two methods on the same items and seeds, and its interval. Each
    draw takes the same items and seeds of both, so that what is hard for both does not widen the interval.
    """
    first, second = _table(a), _table(b)
    if first.shape != second.shape:
        raise ValueError(f"expected as many errors of both methods, found {first.shape} and {second.shape}")
    return _estimate([first, second], lambda x, y: statistic(x) - statistic(y), groups, draws, level, seed)


def _estimate(
    tables: List[np.ndarray],
    statistic: Callable[..., float],
    groups: Optional[np.ndarray],
    draws: int,
    level: float,
    seed: int,
) -> Interval:
    """Returns a statistic of tables of one shape [seeds, n], and its interval. A draw is the same for all."""
    drawn = [
        statistic(*(table[rows][:, columns].ravel() for table in tables))
        for rows, columns in _draws(tables[0].shape, groups, draws, seed)
    ]
    outside = 50 * (1 - level)
    low, high = np.percentile(drawn, [outside, 100 - outside])
    return Interval(float(statistic(*(table.ravel() for table in tables))), float(low), float(high))


def error_summary(
    errors: np.ndarray,
    groups: Optional[np.ndarray] = None,
    *,
    draws: int = 2000,
    level: float = 0.95,
    seed: int = 0,
) -> Dict[str, Interval]:
    """Returns mean, median and 90th percentile ("p90") of errors [n] or [seeds, n], with intervals: those of
    bootstrap(), with each draw made once for the three."""
    table = _table(errors)

    def three(values: np.ndarray) -> tuple:
        return (np.mean(values), *np.percentile(values, [50, 90]))

    drawn = [
        three(table[rows][:, columns].ravel()) for rows, columns in _draws(table.shape, groups, draws, seed)
    ]
    outside = 50 * (1 - level)
    low, high = np.percentile(np.array(drawn), [outside, 100 - outside], axis=0)
    figures = three(table.ravel())
    return {
        name: Interval(float(figure), float(low[i]), float(high[i]))
        for i, (name, figure) in enumerate(zip(("mean", "median", "p90"), figures))
    }
