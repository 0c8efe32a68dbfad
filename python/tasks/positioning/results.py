# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tables, pictures and sentences about an experiment."""
from __future__ import annotations

from typing import Any, Dict, List

import numpy as np

from tasks.common import plots, report as common
from tasks.common.command import Context
from tasks.common.models import macs, parameters
from tasks.common.report import Table
from tasks.common.statistics import error_summary, mean, paired_difference, percentile
from tasks.common.progress import duration

from .cache import Cached
from .cost import random_inputs
from .models import Positioner
from .pictures import flights_map, inputs_picture
from .records import Records
from .settings import STUDENT
from .training import Data

ERRORS = ("mean", "median", "p90")


def report(context: Context, records: Records, data: Data, inputs: Cached, found: Dict[str, Any]) -> None:
    """Writes results.json, results.md and the pictures of CDFs to the run's folder."""
    test = data.parts["test"]
    flights = records.trajectory[test]
    methods = {name: np.asarray(found["floors"][name]) for name in ("mean position", "nearest neighbours")}
    methods.update({name: np.stack(values) for name, values in found["students"].items()})
    teacher = {title: np.stack(values) for title, values in found["subsets"].items()}
    methods["teacher, all"] = teacher["all"]
    differences = {
        name: paired_difference(methods["student distilled"], methods["student alone"], statistic, flights)
        for name, statistic in (("mean", mean), ("median", percentile(50)), ("p90", percentile(90)))
    }
    summaries = {name: error_summary(errors, flights) for name, errors in methods.items()}
    of_subsets = {title: _some(errors, flights) for title, errors in teacher.items()}
    costs = _costs(data, records, context)
    tables = [
        _errors(f"Errors on the test part, split by {context.config.split.by}, m", summaries),
        _errors("The teacher with subsets of its modalities, m", of_subsets),
        _by_sight(methods, records.line_of_sight[test], flights),
        _times(found["fits"], costs, context.seeds),
    ]
    figures = [context.out / f"{name}.png" for name in ("cdf", "cdf_subsets", "map", "inputs")]
    title = f"Positioning, split by {context.config.split.by}, {context.preset} size"
    plots.cdf(figures[0], methods, "error, m", title)
    alone = {t: e[:, ~np.isnan(e).any(0)] for t, e in teacher.items() if t == "all" or t.endswith(" alone")}
    plots.cdf(figures[1], alone, "error, m", f"The teacher with one modality, {context.preset} size")
    flights_map(figures[2], data, flights, found["positions"])
    inputs_picture(figures[3], data)
    results = {
        "split": {name: len(rows) for name, rows in data.parts.items()},
        "trajectories": {n: len(np.unique(records.trajectory[rows])) for n, rows in data.parts.items()},
        "modalities": records.modalities,
        "absent": records.absent,
        "errors": summaries,
        "subsets": of_subsets,
        "distilled_minus_alone": differences,
        "attention": dict(zip(records.modalities, np.mean(found["weights"], axis=0))),
        "neighbours": found["floors"]["k"],
        "costs": costs,
        "fits": found["fits"],
        "machine": found["machine"],
    }
    notes = _notes(context, records, data, inputs, found, summaries, differences)
    common.write(context.out, title, results, tables, figures, notes)


def _some(errors: np.ndarray, flights: np.ndarray) -> Dict[str, Any]:
    """Returns the summary over the records that have one of the subset's modalities."""
    there = ~np.isnan(errors).any(0)
    return error_summary(errors[:, there], flights[there]) if there.any() else {}


def _errors(title: str, summaries: Dict[str, Dict[str, Any]]) -> Table:
    rows = [
        [name, *(summary[e].text(1) if summary else "no record" for e in ERRORS)]
        for name, summary in summaries.items()
    ]
    return Table(title, ["method", "mean", "median", "90 %"], rows)


def _by_sight(methods: Dict[str, np.ndarray], sight: np.ndarray, flights: np.ndarray) -> Table:
    rows = []
    for name, errors in methods.items():
        cells = [name]
        for here in (sight, ~sight):
            cells.append(
                error_summary(np.atleast_2d(errors)[:, here], flights[here])["median"].text(1)
                if here.any()
                else "no record"
            )
        rows.append(cells)
    header = ["method", f"in line of sight ({sight.mean():.0%} of the records)", "without"]
    return Table("Median errors by line of sight to the base station, m", header, rows)


def _costs(data: Data, records: Records, context: Context) -> Dict[str, Dict[str, int]]:
    """Returns multiply-adds of a record and parameters of both networks."""
    out = {}
    for name, modalities in (("teacher", records.modalities), ("student", [STUDENT])):
        model = Positioner(data.channels(modalities), context.config.network)
        shapes = {m: data.arrays[m].shape[1:] for m in modalities}
        out[name] = {"macs": macs(model, random_inputs(shapes, 1)), "parameters": parameters(model)}
    return out


def _times(fits: Dict[str, List[Dict[str, float]]], costs: Dict[str, Any], seeds: List[int]) -> Table:
    rows = []
    for name, of_seeds in fits.items():
        cost = costs["teacher" if name == "teacher" else "student"]
        rows.append(
            [
                name,
                f"{cost['parameters'] / 1e6:.2f}",
                f"{cost['macs'] / 1e6:.0f}",
                str(of_seeds[0]["epochs"]),
                f"{sum(f['cpu_seconds'] for f in of_seeds) / 60:.1f}",
                f"{sum(f['seconds'] for f in of_seeds) / 60:.1f}",
            ]
        )
    return Table(
        f"What the trainings took, all {len(seeds)} seeds",
        ["network", "parameters, 10⁶", "multiply-adds a record, 10⁶", "epochs", "core-minutes", "minutes"],
        rows,
    )


def _notes(context, records, data, inputs, found, summaries, differences) -> List[str]:
    parts = ", ".join(
        f"{len(rows)} {name} ({len(np.unique(records.trajectory[rows]))} flights)"
        for name, rows in data.parts.items()
    )
    machine = found["machine"]
    weights = zip(records.modalities, np.mean(found["weights"], axis=0))
    total = sum(f["cpu_seconds"] for fits in found["fits"].values() for f in fits)
    notes = [
        f"Records: {parts}. Seeds: {', '.join(map(str, context.seeds))}. Intervals hold 95 % of bootstrap "
        "draws of whole flights and of seeds.",
        f"The inputs took {duration(inputs.seconds)} ({inputs.bytes / 1e6:.0f} MB), the trainings "
        f"{total / 60:.1f} core-minutes: {machine['device']}, {machine['threads']} threads, torch "
        f"{machine['torch']}.",
        f"The neighbours are {found['floors']['k']}, found in {found['floors']['cpu_seconds']:.1f} core-s.",
        "Mean attention of the teacher: " + ", ".join(f"{m} {w:.2f}" for m, w in weights) + ".",
        verdict(differences),
        third(summaries),
    ]
    if records.absent:
        notes.insert(0, f"The data lack {', '.join(records.absent)}; the networks work without.")
    return notes


def verdict(differences: Dict[str, Any]) -> str:
    """Returns what the interval of the difference of the students says."""
    texts = ", ".join(f"{name} {interval.text()} m" for name, interval in differences.items())
    interval = differences["mean"]
    if interval.high < 0:
        says = "The distilled student is better than the same student alone, beyond the interval"
    elif interval.low > 0:
        says = "The distilled student is worse than the same student alone, beyond the interval"
    else:
        says = "The distilled student and the same student alone do not differ beyond the interval"
    return f"{says}: distilled minus alone, {texts}."


def third(summaries: Dict[str, Any]) -> str:
    """Returns how the median errors compare with that of the mean position."""
    floor = summaries["mean position"]["median"].value
    shares = {n: s["median"].value / floor for n, s in summaries.items() if n != "mean position"}
    return (
        "Median errors over that of the mean position: "
        + ", ".join(f"{name} {share:.2f}" for name, share in shares.items())
        + "."
    )
