# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of a run for machines (results.json) and for people (results.md)."""
from __future__ import annotations

import dataclasses
import json
import pathlib
from typing import Any, Dict, List, Sequence

import numpy as np

from .files import write_text
from .statistics import Interval


@dataclasses.dataclass
class Table:
    """A table of texts."""

    title: str
    header: Sequence[str]
    rows: List[Sequence[str]]

    def markdown(self) -> str:
        lines = [f"## {self.title}", "", _row(self.header), _row(["---"] * len(self.header))]
        return "\n".join(lines + [_row(row) for row in self.rows]) + "\n"


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def plain(value: Any) -> Any:
    """Returns a value with plain numbers, lists and dicts, for JSON. An Interval becomes a dict."""
    if isinstance(value, Interval):
        return {"value": value.value, "low": value.low, "high": value.high}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return plain(dataclasses.asdict(value))
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(v) for v in value]
    if isinstance(value, np.generic):
        return value.item()
    return str(value) if isinstance(value, pathlib.Path) else value


def write(
    out: pathlib.Path,
    title: str,
    results: Dict[str, Any],
    tables: Sequence[Table],
    figures: Sequence[pathlib.Path] = (),
    notes: Sequence[str] = (),
) -> None:
    """Writes out/results.json and out/results.md, and prints the latter's tables.

    figures  pictures in `out`
    notes    sentences about the run: its size, its device, its time
    """
    write_text(out / "results.json", json.dumps(plain(results), indent=1) + "\n")
    text = f"# {title}\n\n" + "".join(f"{note}\n" for note in notes)
    text += "".join("\n" + table.markdown() for table in tables)
    text += "".join(f"\n![{path.stem}]({path.name})\n" for path in figures)
    write_text(out / "results.md", text)
    print(text, end="")
