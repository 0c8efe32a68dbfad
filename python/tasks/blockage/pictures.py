# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of what the methods reached."""
from __future__ import annotations

import pathlib
from typing import Any, Dict, List, Tuple

import numpy as np

from tasks.common import plots
from tasks.common.statistics import Interval
from tasks.street.pictures import intervals

from . import labels, measures


def horizons(path: pathlib.Path, precision: Dict[str, List[Interval]], config: Any) -> None:
    """Draws the average precision of each method against the horizon."""
    title = "Will the line of sight be blocked within k ticks?"
    intervals(path, config.horizons, precision, "k, ticks", "average precision", title)


def lead_times(path: pathlib.Path, leads: Dict[str, List[Interval]], config: Any) -> None:
    """Draws the share of blockages that had an alarm j ticks before."""
    x = range(1, max((len(of) for of in leads.values()), default=0) + 1)
    title = f"How early a blockage is known, at {100 * config.false_alarms:g} % false alarms"
    intervals(path, list(x), leads, "ticks before the blockage", "share with an alarm", title)


def precision_recall(path: pathlib.Path, scored: Dict[str, Any], config: Any) -> None:
    """Draws precision against recall at the shown horizon, all seeds of a method together."""
    with plots.figure(path) as axes:
        for name, s in scored.items():
            truth, score = s.truth("test", config.shown), s.score("test", config.shown)
            precision, recall, _ = measures.precision_recall(score.ravel(), np.tile(truth, len(score)))
            axes.plot(recall, precision, label=name, marker="." if len(recall) < 20 else None)
        title = f"Blocked within {config.shown} ticks, all seeds together"
        axes.set(xlim=(0, 1), ylim=(0, 1.02), xlabel="recall", ylabel="precision", title=title)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)


def timeline(path: pathlib.Path, problem: Any, scored: Dict[str, Any], config: Any, name: str) -> None:
    """Draws a test drive with a blockage: events at four ticks, the probability that the method `name` gives,
    the truth, and the gain of the channel."""
    mine, onset = _drive_of_timeline(problem)
    tick, sight = problem.drives.tick[mine], problem.line_of_sight[mine]
    shown = np.clip(onset + np.array([-6, -3, -1, 1]), 0, len(mine) - 1)
    with plots.mosaic(path, [["e0", "e1", "e2", "e3"], ["p"] * 4, ["g"] * 4], [1, 2, 1.3]) as axes:
        for i, at in enumerate(shown):
            _draw_events(axes[f"e{i}"], problem.arrays["events"][mine[at]], f"events, tick {tick[at]}")
        for of, style in ((name, "-o"), ("true motion, straight on", ":")):
            probability = scored[of].asked_probability(config.shown)[mine]
            axes["p"].plot(tick, probability, style, markersize=3, label=of)
        axes["p"].set(ylim=(-0.03, 1.03), ylabel=f"blocked within\n{config.shown} ticks")
        axes["p"].set_title("red: blocked; orange: the ticks before, at which an alarm is right", fontsize=9)
        axes["p"].legend(fontsize=7, loc="center right")
        axes["g"].plot(tick, problem.gain_db[mine], "-", color="0.3")
        axes["g"].set(xlabel="tick", ylabel="path gain, dB")
        for part in ("p", "g"):
            _mark(axes[part], tick, sight, config.shown)


def _drive_of_timeline(problem: Any) -> Tuple[np.ndarray, int]:
    """Returns the items of the test drive with the longest blockage, and the place where it begins. If there
    are some, only blockages that end, and that have a past with line of sight, count."""
    drives, most = problem.drives, ((False, False, 0), None, 0)
    for drive in np.unique(drives.drive[problem.asked]):
        mine = np.flatnonzero(drives.drive == drive)
        sight = problem.line_of_sight[mine]
        for onset in labels.onsets(sight):
            ends = np.flatnonzero(sight[onset:])
            long = int(ends[0]) if len(ends) else len(sight) - int(onset)
            known = onset >= problem.most and bool(sight[onset - problem.most : onset].all())
            passes = int(onset) + long < len(sight)
            if (known, passes, long) > most[0]:
                most = ((known, passes, long), mine, int(onset))
    if most[1] is None:
        mine = np.flatnonzero(drives.drive == drives.drive[problem.asked[0]])
        return mine, len(mine) - 1
    return most[1], most[2]


def _draw_events(axes: Any, counts: np.ndarray, title: str) -> None:
    """Draws brighter events red and darker ones blue."""
    darker, brighter = np.asarray(counts).astype(np.float32)
    axes.imshow(np.stack([brighter, 0 * darker, darker], -1) / max(brighter.max(), darker.max(), 1e-6))
    axes.set_title(title, fontsize=9)
    axes.set_axis_off()


def _mark(axes: Any, tick: np.ndarray, sight: np.ndarray, horizon: int) -> None:
    """Shades the ticks that are blocked, and those before."""
    for at in np.flatnonzero(~sight):
        axes.axvspan(tick[at] - 0.5, tick[at] + 0.5, color="tab:red", alpha=0.15, linewidth=0)
    for at in labels.onsets(sight):
        begin = max(tick[at] - horizon, tick[0]) - 0.5
        axes.axvspan(begin, tick[at] - 0.5, color="tab:orange", alpha=0.15, linewidth=0)
    axes.set_xlim(tick[0] - 0.5, tick[-1] + 0.5)
