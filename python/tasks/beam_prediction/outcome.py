# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tables and pictures of what the methods reached."""
from __future__ import annotations

import pathlib
from typing import Any, Dict, List

import numpy as np

from tasks.common import plots
from tasks.common.command import Context
from tasks.common.inputs import tensor
from tasks.common.report import Table, write
from tasks.common.statistics import Interval, bootstrap, mean, paired_difference, percentile
from tasks.street import learning
from tasks.street.pictures import intervals

from . import measures

CURVE = 10  #: beams of the curves


class Outcome:
    """The measures of one method on the test items: arrays [seeds, n, beams tried]."""

    def __init__(self, rank: np.ndarray, power: np.ndarray, groups: np.ndarray, draws: int):
        self.hit = np.stack([measures.hits(r, power) for r in rank])
        self.loss_db = np.stack([measures.losses_db(r, power) for r in rank])
        self.groups, self.draws = groups, draws

    def accuracy(self, k: int, items: Any = slice(None)) -> Interval:
        """Returns how often the best beam is among the first k, %."""
        return self._of(100.0 * self.hit[:, items, k - 1], mean, items)

    def loss(self, statistic, items: Any = slice(None), k: int = 1) -> Interval:
        """Returns a statistic of the loss if the best of the first k beams is used, dB."""
        return self._of(self.loss_db[:, items, k - 1], statistic, items)

    def saved(self, limit_db: float) -> Interval:
        """Returns the share of the sweep that is saved at a mean loss, %."""
        flat = self.loss_db.reshape(-1, self.loss_db.shape[-1])
        number = np.arange(len(flat)).reshape(self.loss_db.shape[:2])
        return self._of(number, lambda n: 100.0 * measures.saved_share(flat[n], limit_db), slice(None))

    def _of(self, values: np.ndarray, statistic, items: Any) -> Interval:
        return bootstrap(values, statistic, self.groups[items], draws=self.draws)


def report(context: Context, problem: Any, ranks: Dict[str, np.ndarray], fits, notes: List[str]) -> None:
    """Writes the tables and the pictures."""
    config, test = context.config, problem.split["test"]
    groups = problem.drives.trajectory[test]
    power = problem.power[test]

    def first(name: str):
        return {m: tensor(problem.arrays[m], test[:1]) for m in name.split(" + ")}

    outcomes = {name: Outcome(rank, power, groups, config.draws) for name, rank in ranks.items()}
    tables = [
        _measures(outcomes, config),
        _differences(outcomes, list(fits)[-1]),
        _conditions(outcomes, problem, test),
        learning.trainings(fits, first),
    ]
    top = context.out / "top_k.png"
    sweep = context.out / "sweep.png"
    count = min(CURVE, power.shape[1])
    shown = {name: o for name, o in outcomes.items() if name != "most frequent beam"}
    tried = list(range(1, count + 1))
    curves = {name: [o.accuracy(k) for k in tried] for name, o in shown.items()}
    label = "best beam among the first k, %"
    intervals(top, tried, curves, "k, beams tried", label, "Beams tried and the best one found")
    curves = {name: [o.loss(mean, k=k) for k in tried] for name, o in shown.items()}
    label = "mean loss of power, dB"
    intervals(sweep, tried, curves, "k, beams tried", label, "Beams tried and the power that is lost")
    strip = context.out / "example.png"
    main = list(fits)[-1]
    example(strip, problem, test, ranks[main][0][:, 0], main)
    results = {
        name: {
            **{f"top_{k}_percent": o.accuracy(k) for k in config.top},
            "loss_mean_db": o.loss(mean),
            "loss_p90_db": o.loss(percentile(90)),
            "sweep_saved_percent": o.saved(config.loss_limit_db),
        }
        for name, o in outcomes.items()
    }
    write(context.out, "Beam prediction", results, tables, [top, sweep, strip], notes)


def _measures(outcomes: Dict[str, Outcome], config: Any) -> Table:
    header = [
        "method",
        *(f"top {k}, %" for k in config.top),
        "loss, mean, dB",
        "loss, 90 %, dB",
        f"sweep saved at {config.loss_limit_db:g} dB, %",
    ]
    rows = [
        [
            name,
            *(o.accuracy(k).text(1) for k in config.top),
            o.loss(mean).text(2),
            o.loss(percentile(90)).text(2),
            o.saved(config.loss_limit_db).text(0),
        ]
        for name, o in outcomes.items()
    ]
    return Table("All test items", header, rows)


def _differences(outcomes: Dict[str, Outcome], last: str) -> Table:
    """Returns what the last network gains over every other method, on the same drives and seeds."""
    ours, rows = outcomes[last], []
    for name, other in outcomes.items():
        if name == last:
            continue
        pairs = [
            (100.0 * ours.hit[..., 0], 100.0 * other.hit[..., 0]),
            (ours.loss_db[..., 0], other.loss_db[..., 0]),
        ]
        rows.append([name])
        for digits, (a, b) in enumerate(pairs, 1):
            same = np.broadcast_to(b, a.shape)  # a baseline has one seed
            rows[-1].append(paired_difference(a, same, mean, ours.groups, draws=ours.draws).text(digits))
    return Table(f"{last} minus another method", ["other method", "top 1, %", "loss, mean, dB"], rows)


def _conditions(outcomes: Dict[str, Outcome], problem: Any, test: np.ndarray) -> Table:
    """Returns the accuracy and the loss of the first beam by cell, and with and without line of sight."""
    drives, sight = problem.drives, problem.line_of_sight[test]
    conditions = {"line of sight": sight, "blocked": ~sight}
    if len(drives.cells) > 1:
        conditions.update({name: drives.cell[test] == i for i, name in enumerate(drives.cells)})
    conditions = {name: np.flatnonzero(which) for name, which in conditions.items() if which.any()}
    rows = [
        [
            name,
            *(
                f"{o.accuracy(1, items).text(0)}; {o.loss(mean, items).text(1)}"
                for items in conditions.values()
            ),
        ]
        for name, o in outcomes.items()
    ]
    header = ["top 1, %; mean loss, dB", *(f"{name} ({len(items)})" for name, items in conditions.items())]
    return Table("By condition", header, rows)


def example(path: pathlib.Path, problem: Any, test: np.ndarray, predicted: np.ndarray, name: str) -> None:
    """Draws four ticks of a test drive in which the best beam changes most: the picture, the LiDAR's range
    image, and the power of all beams with the predicted and the best one."""
    drive = problem.drives.drive[test]
    changes = {d: len(np.unique(problem.best[test[drive == d]])) for d in np.unique(drive)}
    mine = np.flatnonzero(drive == max(changes, key=lambda d: changes[d]))
    chosen = mine[np.linspace(0, len(mine) - 1, min(4, len(mine))).astype(int)]
    grid = {"nrows": 3, "ncols": len(chosen), "squeeze": False}
    with plots.figure(path, 3.2 * len(chosen), 5.4, **grid) as axes:
        for column, i in enumerate(chosen):
            item = test[i]
            picture, lidar = (np.asarray(problem.arrays[m][item]) for m in ("camera", "lidar"))
            axes[0, column].imshow(picture.transpose(1, 2, 0), aspect="auto")
            sight = "line of sight" if problem.line_of_sight[item] else "blocked"
            axes[0, column].set_title(f"tick {problem.drives.tick[item]}: {sight}", fontsize=9)
            axes[1, column].imshow(lidar[0].astype(np.float32), aspect="auto", cmap="viridis")
            for row in (0, 1):
                axes[row, column].set_axis_off()
            _draw_beams(axes[2, column], problem, item, predicted[i], column == 0, name)


def _draw_beams(axes: Any, problem: Any, item: int, predicted: int, legend: bool, name: str) -> None:
    power = problem.power[item]
    db = np.maximum(10 * np.log10(np.maximum(power, 1e-30) / power.max()), -40)
    cosine = problem.beams.cosine
    axes.bar(cosine, db + 40, width=cosine[1] - cosine[0], bottom=-40, color="0.75")
    best = problem.best[item]
    axes.plot(cosine[best], db[best], "o", color="tab:green", label="best beam")
    axes.plot(cosine[predicted], db[predicted], "x", color="tab:red", label=name)
    axes.set(xlim=(1, -1), ylim=(-41, 4), xlabel="direction cosine, left to right")
    if legend:
        axes.set_ylabel("power, dB")
        axes.legend(fontsize=7, loc="lower right")
