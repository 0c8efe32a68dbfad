# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Collects the records of nuScenes' thirteen tables and writes them as JSON (docs/schema_nuscenes.md of the
development kit). Tokens are hashes of what a record stands for, so that the same data set gives the same
tokens."""

from __future__ import annotations

import hashlib
import json
import pathlib
from typing import Any, Dict, List, Optional

from ...dataset import Dataset
from .categories import ATTRIBUTES, CATEGORIES, VISIBILITIES

NAMES = (
    "category",
    "attribute",
    "visibility",
    "instance",
    "sensor",
    "calibrated_sensor",
    "ego_pose",
    "log",
    "scene",
    "sample",
    "sample_data",
    "sample_annotation",
    "map",
)

Row = Dict[str, Any]


class Tables:
    """Holds the rows of all tables."""

    def __init__(self, dataset: Dataset):
        run = dataset.run
        self._salt = f"{run.get('scenario_sha256', '')} {run.get('scene_sha256', '')} {run.get('seed', '')}"
        self.rows: Dict[str, List[Row]] = {name: [] for name in NAMES}

    def token(self, table: str, *key: Any) -> str:
        """Returns 32 hexadecimal digits that depend on the run and on the key."""
        text = "|".join([self._salt, table, *(str(part) for part in key)])
        return hashlib.sha256(text.encode()).hexdigest()[:32]

    def add(self, table: str, token: str, **fields: Any) -> Row:
        row = {"token": token, **fields}
        self.rows.setdefault(table, []).append(row)
        return row

    def taxonomy(self, extra: List[str]) -> None:
        """Adds categories (and those of `extra` that nuScenes has not), attributes and visibilities."""
        names = [*CATEGORIES, *(name for name in extra if name not in CATEGORIES)]
        for index, name in enumerate(names):
            self.add("category", self.token("category", name), name=name, description="", index=index)
        for name, meaning in ATTRIBUTES:
            self.add("attribute", self.token("attribute", name), name=name, description=meaning)
        for token, level, end in VISIBILITIES:
            meaning = f"up to {end:.0%} of the object's pixels are visible"
            self.add("visibility", token, level=level, description=meaning)

    def write(self, folder: pathlib.Path) -> None:
        folder.mkdir(parents=True)
        for name, rows in self.rows.items():
            (folder / f"{name}.json").write_text(json.dumps(rows, indent=0) + "\n")


def chain(rows: List[Row]) -> None:
    """Sets prev and next of rows that follow one another."""
    before: Optional[Row] = None
    for row in rows:
        row["prev"], row["next"] = "", ""
        if before is not None:
            row["prev"], before["next"] = before["token"], row["token"]
        before = row
