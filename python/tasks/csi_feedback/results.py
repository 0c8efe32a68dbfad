# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Turns scores into tables, pictures and sentences."""
from __future__ import annotations

import pathlib
from typing import Any, Dict, List

import numpy as np

from ..common.plots import figure, lines
from ..common.report import Table
from ..common.statistics import Interval, bootstrap, mean, paired_difference
from .experiment import Config, Score, Split
from .metrics import nmse_db

NAMES = {"mean": "the mean", "pca": "principal components", "csinet": "CsiNet", "crnet": "CRNet"}


def nmse(score: Score, data: Split, config: Config) -> Interval:
    """Returns the NMSE in dB with its interval over places and seeds."""
    return bootstrap(score.errors, nmse_db, data.places, draws=config.draws)


def rho(score: Score, data: Split, config: Config) -> Interval:
    """Returns the mean cosine similarity with its interval over places and seeds."""
    return bootstrap(score.similarities, mean, data.places, draws=config.draws)


def gain_db(score: Score, floor: Score, data: Split, config: Config) -> Interval:
    """Returns NMSE(score) - NMSE(floor) in dB, negative where `score` is better, with its interval."""
    errors = np.atleast_2d(score.errors)
    below = np.broadcast_to(np.atleast_2d(floor.errors), errors.shape)
    return paired_difference(errors, below, nmse_db, data.places, draws=config.draws)


def source_results(scores: Dict[str, Dict[int, Score]], data: Split, config: Config) -> List[Dict[str, Any]]:
    """Returns a row of figures for each method and size."""
    rows = []
    for method, of_size in scores.items():
        for size, value in of_size.items():
            row = {
                "method": method,
                "size": size,
                "nmse_db": nmse(value, data, config),
                "rho": rho(value, data, config),
                "cpu_seconds": value.cpu_seconds,
            }
            if method in ("csinet", "crnet"):
                row["beside_pca_db"] = gain_db(value, scores["pca"][size], data, config)
            rows.append(row)
    return rows


def source_table(rows: List[Dict[str, Any]], title: str) -> Table:
    """Returns the table of source_results."""
    header = ["M", "method", "NMSE, dB (95 %)", "beside principal components, dB", "rho", "CPU s a training"]
    order = {name: i for i, name in enumerate(NAMES)}
    body = [
        [
            str(row["size"]),
            NAMES[row["method"]],
            row["nmse_db"].text(),
            row["beside_pca_db"].text() if "beside_pca_db" in row else "–",
            row["rho"].text(3),
            f"{row['cpu_seconds']:.0f}" if row["cpu_seconds"] else "–",
        ]
        for row in sorted(rows, key=lambda r: (-r["size"], order[r["method"]]))
    ]
    return Table(title, header, body)


def target_results(scores: Dict[str, Score], data: Split, config: Config) -> List[Dict[str, Any]]:
    """Returns a row of figures for each method on a target."""
    return [
        {
            "method": method,
            "nmse_db": nmse(value, data, config),
            "rho": rho(value, data, config),
            "cpu_seconds": value.cpu_seconds,
        }
        for method, value in scores.items()
    ]


def target_table(results: Dict[str, List[Dict[str, Any]]], size: int) -> Table:
    """Returns the NMSE of each method (rows) on each target (columns)."""
    targets = list(results)
    found = {t: {row["method"]: row["nmse_db"].text() for row in results[t]} for t in targets}
    methods = list(max(found.values(), key=len))
    body = [[_called(method), *(found[target].get(method, "–") for target in targets)] for method in methods]
    return Table(f"Other domains, M = {size}: NMSE in dB (95 %)", ["method", *targets], body)


def _called(method: str) -> str:
    for short in ("pca", "csinet", "crnet", "mean"):
        if method.startswith(short):
            name = NAMES[short] if short != "mean" else "the mean"
            return name + method[len(short) :]
    return method


def draw_source(path: pathlib.Path, rows: List[Dict[str, Any]], title: str) -> None:
    """Draws the NMSE over M of all methods that have every size."""
    sizes = sorted({row["size"] for row in rows})
    curves = {}
    for method, name in NAMES.items():
        own = sorted((r for r in rows if r["method"] == method), key=lambda r: r["size"])
        if len(own) == len(sizes):
            figures = [row["nmse_db"] for row in own]
            curves[name] = tuple([getattr(f, part) for f in figures] for part in ("value", "low", "high"))
    lines(path, sizes, curves, "numbers in a codeword, M", "NMSE, dB", title, log_x=True)


#: Methods over the number of users, what they are called, and their lines.
_DRAWN = (
    ("csinet tuned to", "CsiNet tuned", "-"),
    ("pca of the source and", "components of source and users", "--"),
    ("pca of", "components of the users", ":"),
)


def draw_targets(path: pathlib.Path, results: Dict[str, List[Dict[str, Any]]], users: List[int]) -> None:
    """Draws the NMSE of tuned networks, and of components, over the number of users of each target."""
    with figure(path) as axes:
        for number, (target, rows) in enumerate(results.items()):
            by_name = {row["method"]: row["nmse_db"] for row in rows}
            for method, name, style in _DRAWN:
                known = [n for n in users if f"{method} {n} users" in by_name]
                figures = [by_name[f"{method} {n} users"] for n in known]
                values = [f.value for f in figures]
                off = [[f.value - f.low for f in figures], [f.high - f.value for f in figures]]
                axes.errorbar(
                    known,
                    values,
                    off,
                    label=f"{target}: {name}",
                    color=f"C{number}",
                    ls=style,
                    marker="o",
                    ms=4,
                )
        axes.set_xscale("log")
        axes.set_xticks(users, [str(n) for n in users])
        axes.minorticks_off()
        axes.set(xlabel="users of the target", ylabel="NMSE, dB", title="Other domains")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)


def describe(data: Split) -> Dict[str, Any]:
    """Returns what a set is, and the sizes of its parts."""
    sizes = {name: len(getattr(data, name)) for name in ("train", "validation", "test")}
    return {**data.channels.facts, "parts": sizes, "test_places": int(data.places.max() + 1)}
