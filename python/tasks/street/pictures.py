# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The picture that both tasks draw."""
from __future__ import annotations

import pathlib
from typing import Dict, Sequence

from tasks.common import plots
from tasks.common.statistics import Interval


def intervals(
    path: pathlib.Path,
    x: Sequence[float],
    curves: Dict[str, Sequence[Interval]],
    x_label: str,
    y_label: str,
    title: str,
) -> None:
    """Draws curves with a bar for the interval of each point. Points of different curves are moved aside by a
    little, so that bars do not hide each other. A curve may end before the others."""
    with plots.figure(path, 7.2, 4.6) as axes:
        step = min([b - a for a, b in zip(x, x[1:])], default=1) * 0.6 / max(len(curves), 1)
        for number, (name, of) in enumerate(curves.items()):
            at = [value + (number - (len(curves) - 1) / 2) * step for value in x[: len(of)]]
            middle = [i.value for i in of]
            below = [max(i.value - i.low, 0) for i in of]
            above = [max(i.high - i.value, 0) for i in of]
            axes.errorbar(
                at,
                middle,
                [below, above],
                marker="o",
                markersize=4,
                linewidth=1.2,
                elinewidth=0.8,
                label=name,
            )
        axes.set(xlabel=x_label, ylabel=y_label, title=title)
        axes.set_xticks(list(x))
        axes.grid(alpha=0.3)
        if curves:
            axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
