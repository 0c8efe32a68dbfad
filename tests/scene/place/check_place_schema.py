#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that the reader of place.yaml, docs/place.schema.json and docs/places_reference.md name the same
fields, that the schema accepts the page's example, and that the page names every topic of a finding.

usage: check_place_schema.py ROOT
"""

import json
import pathlib
import re
import sys

import jsonschema
import yaml

root = pathlib.Path(sys.argv[1])
schema = json.loads((root / "docs/place.schema.json").read_text())
page = (root / "docs/places_reference.md").read_text()
reader = (root / "scene/place/config/load_place.cpp").read_text()
faults = []


def keys_of(value):
    """Yields the property names of each object of the schema."""
    if isinstance(value, dict):
        if "properties" in value and isinstance(value["properties"], dict):
            yield frozenset(value["properties"])
        for inner in value.values():
            yield from keys_of(inner)
    if isinstance(value, list):
        for inner in value:
            yield from keys_of(inner)


in_reader = {
    frozenset(re.findall(r'"(\w+)"', keys))
    for keys in re.findall(r"(?:FieldMap map\(\s*\w+,|Keys keys)\s*\{([^}]*)\}", reader)
}
in_schema = set(keys_of(schema))
for keys in in_reader ^ in_schema:
    side = "the reader" if keys in in_reader else "the schema"
    faults.append(f"only {side} has an object with the fields {', '.join(sorted(keys))}")
for key in sorted(set().union(*in_schema)):
    if f"`{key}`" not in page:
        faults.append(f"places_reference.md does not name the field `{key}`")

example = yaml.safe_load(re.search(r"```yaml\n(.*?)```", page, re.DOTALL).group(1))
validator = jsonschema.Draft202012Validator(schema)
faults += [f"the example: {error.message}" for error in validator.iter_errors(example)]
for change in (
    {"colour": 1},
    {"greatx_place": 2},
    {"area": {"bounds_deg": [1, 2, 3]}},
    {"maps": [{"name": "x"}]},
):
    if validator.is_valid({**example, **change}):
        faults.append(f"the schema accepts {change}")

topics = set()
for file in sorted((root / "scene/place/source").glob("*.cpp")):
    topics |= set(re.findall(r'Kind::\w+,\s*"(\w+)"', file.read_text()))
for topic in sorted(topics):
    if f"`{topic}`" not in page:
        faults.append(f"places_reference.md does not name the finding `{topic}`")
if len(in_reader) < 9 or len(topics) < 20:
    faults.append(f"only {len(in_reader)} objects and {len(topics)} topics were found in the sources")

print("\n".join(faults) or f"{len(in_schema)} objects with fields and {len(topics)} topics agree")
sys.exit(1 if faults else 0)
