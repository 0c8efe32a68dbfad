# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of results."""
from __future__ import annotations

import contextlib
import pathlib
from typing import Any, Callable, ContextManager, Dict, Iterator, List, Sequence, Tuple

import numpy as np

from .files import write_whole


def figure(
    path: pathlib.Path, width_in: float = 6.4, height_in: float = 4.2, **grid: Any
) -> ContextManager[Any]:
    """Yields axes (or an array of them, by `grid` as plt.subplots takes it), and saves them as a picture."""
    return _saved(path, 100, lambda plt: plt.subplots(figsize=(width_in, height_in), **grid))


def mosaic(path: pathlib.Path, rows: List[List[str]], heights: List[float]) -> ContextManager[Dict[str, Any]]:
    """Yields axes by name, laid out as `rows` name them with relative `heights`, and saves the picture."""
    ratios = {"height_ratios": heights}
    return _saved(path, 90, lambda plt: plt.subplot_mosaic(rows, figsize=(9, 6), gridspec_kw=ratios))


@contextlib.contextmanager
def _saved(path: pathlib.Path, dots_per_inch: int, make: Callable[[Any], Tuple[Any, Any]]) -> Iterator[Any]:
    """Yields the axes that `make` makes with pyplot, and saves their figure."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    drawn, axes = make(pyplot)
    try:
        yield axes
        drawn.tight_layout()
        write_whole(
            path, lambda part: drawn.savefig(part, dpi=dots_per_inch, metadata={"Software": "greatx"})
        )
    finally:
        pyplot.close(drawn)


def cdf(path: pathlib.Path, errors: Dict[str, np.ndarray], x_label: str, title: str) -> None:
    """Draws the shares of errors up to each value, of several methods; [seeds, n] are taken together. The
    axis ends at the 98th percentile of the worst method."""
    with figure(path) as axes:
        end = max(float(np.percentile(values, 98)) for values in errors.values())
        for name, values in errors.items():
            ordered = np.sort(np.ravel(values))
            axes.step(ordered, np.arange(1, len(ordered) + 1) / len(ordered), where="post", label=name)
        axes.set(xlim=(0, end), ylim=(0, 1), xlabel=x_label, ylabel="share of items", title=title)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8, loc="lower right")


def lines(
    path: pathlib.Path,
    x: Sequence[float],
    curves: Dict[str, Tuple[Sequence[float], Sequence[float], Sequence[float]]],
    x_label: str,
    y_label: str,
    title: str,
    log_x: bool = False,
) -> None:
    """Draws curves with their intervals: a mean, a lower and an upper bound for each x."""
    with figure(path) as axes:
        for name, (middle, low, high) in curves.items():
            (line,) = axes.plot(x, middle, marker="o", markersize=4, label=name)
            axes.fill_between(x, low, high, color=line.get_color(), alpha=0.2, linewidth=0)
        if log_x:
            axes.set_xscale("log", base=2)
            axes.set_xticks(x, [f"{v:g}" for v in x])
        axes.set(xlabel=x_label, ylabel=y_label, title=title)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
