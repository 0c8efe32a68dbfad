# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What the methods reached: intervals, tables, lead times."""
from __future__ import annotations

from typing import Any, Dict, List, Optional

import numpy as np

from tasks.common.command import Context
from tasks.common.report import Table, write
from tasks.common.statistics import Interval, bootstrap, paired_difference
from tasks.street import learning

from . import labels, measures, pictures


class Scored:
    """The probabilities of one method, [seed, item, step], on the items of validation and test."""

    def __init__(self, probability: np.ndarray, items: np.ndarray, problem: Any, draws: int):
        self.problem, self.draws = problem, draws
        self._probability = probability
        place = {item: i for i, item in enumerate(items.tolist())}
        self._at = {
            part: np.array([place[i] for i in problem.split[part].tolist()])
            for part in ("validation", "test")
        }
        self._asked = np.array([place[i] for i in problem.asked.tolist()])
        self.groups = problem.drives.trajectory[problem.split["test"]]

    def score(self, part: str, horizon: int) -> np.ndarray:
        return self._probability[:, self._at[part], horizon - 1]

    def truth(self, part: str, horizon: int) -> np.ndarray:
        first = self.problem.first[self.problem.split[part]]
        return (first > 0) & (first <= horizon)

    def figure(self, measure: Any, horizon: int, items: Optional[np.ndarray] = None) -> Interval:
        """Returns a measure (score, truth) -> number at a horizon, over all seeds."""
        return self._interval(self.score("test", horizon), measure, horizon, items)

    def f1(self, horizon: int) -> Interval:
        """Returns F1 at the threshold of each seed that is best on the validation items."""
        known = self.truth("validation", horizon)
        threshold = [measures.best_threshold(s, known) for s in self.score("validation", horizon)]
        alarm = self.score("test", horizon) >= np.array(threshold)[:, None]
        return self._interval(alarm, measures.f1, horizon, None)

    def _interval(
        self, values: np.ndarray, measure: Any, horizon: int, items: Optional[np.ndarray]
    ) -> Interval:
        chosen = np.arange(values.shape[1]) if items is None else items
        flat = values[:, chosen].ravel()
        truth = np.tile(self.truth("test", horizon)[chosen], len(values))
        number = np.arange(len(flat)).reshape(len(values), -1)
        return bootstrap(number, lambda n: measure(flat[n], truth[n]), self.groups[chosen], draws=self.draws)

    def alarms(self, horizon: int, false_alarms: float) -> np.ndarray:
        """Returns alarms bool [seed, n] of all items, at the share of false alarms on the validation items.
        Items that were not asked for, such as those without line of sight, have none."""
        known = self.truth("validation", horizon)
        out = np.zeros((len(self._probability), len(self.problem.drives)), bool)
        for seed, score in enumerate(self.score("validation", horizon)):
            threshold = measures.alarm_threshold(score, known, false_alarms)
            out[seed, self.problem.asked] = self._probability[seed, self._asked, horizon - 1] >= threshold
        return out

    def asked_probability(self, horizon: int) -> np.ndarray:
        """Returns the mean over the seeds of all items, [n]; nan where nothing was asked."""
        out = np.full(len(self.problem.drives), np.nan)
        out[self.problem.asked] = self._probability[:, self._asked, horizon - 1].mean(0)
        return out


def report(context: Context, problem: Any, probability, items: np.ndarray, fits, notes: List[str]) -> None:
    """Writes the tables and the pictures."""
    config = context.config
    scored = {name: Scored(p, items, problem, config.draws) for name, p in probability.items()}
    precision = {
        name: [s.figure(measures.average_precision, k) for k in config.horizons] for name, s in scored.items()
    }
    leads = {name: lead_curve(s, problem, config) for name, s in scored.items() if name != "base rate"}

    def one(name: str):
        return problem.gather(name.split(" + "), problem.split["test"][:1])

    tables = [
        _main(scored, config),
        _differences(scored, list(fits), config),
        _horizons(precision, config),
        _lead_table(leads, problem),
    ]
    tables += [t for t in [_cells(scored, problem, config)] if t is not None]
    tables.append(learning.trainings(fits, one))
    paths = {
        name: context.out / f"{name}.png" for name in ("horizon", "precision_recall", "lead", "timeline")
    }
    pictures.horizons(paths["horizon"], precision, config)
    pictures.precision_recall(paths["precision_recall"], scored, config)
    pictures.lead_times(paths["lead"], leads, config)
    pictures.timeline(paths["timeline"], problem, scored, config, list(fits)[-1])
    results = {
        name: {
            "average_precision": dict(zip(config.horizons, precision[name])),
            "roc_auc": {k: s.figure(measures.roc_auc, k) for k in config.horizons},
            "lead_shares": leads.get(name),
        }
        for name, s in scored.items()
    }
    write(context.out, "Blockage prediction", results, tables, list(paths.values()), notes)


def _main(scored: Dict[str, Scored], config: Any) -> Table:
    k = config.shown
    rows = [
        [
            name,
            s.figure(measures.average_precision, k).text(3),
            s.figure(measures.roc_auc, k).text(3),
            s.f1(k).text(3),
        ]
        for name, s in scored.items()
    ]
    return Table(f"Blocked within {k} ticks", ["method", "average precision", "ROC AUC", "F1"], rows)


def difference(a: Scored, b: Scored, measure: Any, horizon: int) -> Interval:
    """Returns a measure of `a` minus that of `b`. Each draw has the same drives and seeds of both."""
    scores = [a.score("test", horizon), b.score("test", horizon)]
    truth = np.tile(a.truth("test", horizon), sum(len(s) for s in scores))
    flat = np.concatenate([s.ravel() for s in scores])
    number = [np.arange(s.size).reshape(s.shape) for s in scores]
    number[1] = number[1] + scores[0].size
    return paired_difference(*number, lambda n: measure(flat[n], truth[n]), a.groups, draws=a.draws)


def _differences(scored: Dict[str, Scored], networks: List[str], config: Any) -> Table:
    """Returns what the last network gains over each of the others."""
    last = networks[-1]
    rows = [
        [
            name,
            difference(scored[last], scored[name], measures.average_precision, config.shown).text(3),
            difference(scored[last], scored[name], measures.roc_auc, config.shown).text(3),
        ]
        for name in networks[:-1]
    ]
    title = f"{last} minus another network, blocked within {config.shown} ticks"
    return Table(title, ["other network", "average precision", "ROC AUC"], rows)


def _horizons(precision: Dict[str, List[Interval]], config: Any) -> Table:
    header = ["average precision", *(f"within {k} ticks" for k in config.horizons)]
    return Table("Horizons", header, [[n, *(i.text(2) for i in of)] for n, of in precision.items()])


def _cells(scored: Dict[str, Scored], problem: Any, config: Any) -> Optional[Table]:
    """Returns the average precision in each cell of a campaign."""
    drives, test = problem.drives, problem.split["test"]
    items = {c: np.flatnonzero(drives.cell[test] == i) for i, c in enumerate(drives.cells)}
    items = {c: of for c, of in items.items() if len(of)}
    if len(items) < 2:
        return None
    rows = [
        [name, *(s.figure(measures.average_precision, config.shown, of).text(2) for of in items.values())]
        for name, s in scored.items()
    ]
    header = [
        f"average precision within {config.shown} ticks",
        *(f"{c} ({len(of)})" for c, of in items.items()),
    ]
    return Table("By cell", header, rows)


def lead_curve(scored: Scored, problem: Any, config: Any) -> List[Interval]:
    """Returns which share of the blockages had an alarm j ticks before, that was kept up to the blockage, for
    j from 1 to the longest horizon. A blockage counts for j if there was line of sight, and a past, at all of
    these ticks."""
    alarm = scored.alarms(config.shown, config.false_alarms)
    drives, asked = problem.drives, np.zeros(len(problem.drives), bool)
    asked[problem.asked] = True
    lead, possible, group = [], [], []
    for drive in np.unique(drives.drive[problem.asked]):
        mine = np.flatnonzero(drives.drive == drive)
        for onset in labels.onsets(problem.line_of_sight[mine]):
            if asked[mine[onset - 1]]:
                lead.append([measures.lead_ticks(of_seed[mine], onset) for of_seed in alarm])
                possible.append(measures.lead_ticks(asked[mine], onset))
                group.append(drives.trajectory[mine[0]])
    out = []
    for j in range(1, problem.most + 1):
        count = np.array(possible, int) >= j
        if not count.any():
            break
        warned = np.array(lead)[count].T >= j
        out.append(
            bootstrap(
                warned.astype(float), lambda v: float(v.mean()), np.array(group)[count], draws=config.draws
            )
        )
    return out


def _lead_table(leads: Dict[str, List[Interval]], problem: Any) -> Table:
    steps = max((len(of) for of in leads.values()), default=0)
    rows = [[name, *(f"{100 * i.value:.0f}" for i in of)] for name, of in leads.items()]
    header = ["blockages with an alarm so many ticks before, %", *(str(j + 1) for j in range(steps))]
    return Table("Lead time", header, rows)
