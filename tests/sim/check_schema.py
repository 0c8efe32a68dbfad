#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks docs/scenario.schema.json. The schema must accept the good scenarios. Of the bad ones it must refuse
exactly those that bad_scenarios.json says a schema can find. The others show only in several fields together
or in files.

usage: check_schema.py SCHEMA FOLDER
"""
import json
import pathlib
import re
import sys

import jsonschema
import yaml


class Core(yaml.SafeLoader):
    """Loads YAML by the core schema of YAML 1.2, as the program does: `on` is a text and 28e9 a number."""


Core.yaml_implicit_resolvers = {}
Core.add_implicit_resolver(
    "tag:yaml.org,2002:bool", re.compile(r"^(true|True|TRUE|false|False|FALSE)$"), list("tTfF")
)
Core.add_implicit_resolver(
    "tag:yaml.org,2002:null", re.compile(r"^(~|null|Null|NULL|)$"), ["~", "n", "N", ""]
)
Core.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?[0-9]+$"), list("-+0123456789"))
Core.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$"),
    list("-+.0123456789"),
)
Core.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))
Core.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
    folder = pathlib.Path(sys.argv[2])
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    faults = []

    # JSON Schema ignores keywords that it does not know, so a misspelt keyword would accept anything.
    known = set(jsonschema.Draft202012Validator.VALIDATORS) | {
        "$schema",
        "$defs",
        "title",
        "description",
        "default",
        "minItems",
        "maxItems",
        "then",
    }

    def look(node, in_names):
        if isinstance(node, dict):
            for key, value in node.items():
                if not in_names and key not in known:
                    faults.append(f"schema: unknown keyword {key}")
                if key not in ("default", "const", "enum"):
                    look(value, not in_names and key in ("properties", "$defs", "dependentRequired"))
        elif isinstance(node, list):
            for value in node:
                look(value, False)

    look(schema, False)

    good = sorted(path for path in folder.rglob("*.yaml") if path.name != "materials.yaml")
    for path in good:
        for error in validator.iter_errors(yaml.load(path.read_text(), Core)):
            faults.append(f"{path.name}: refused: {error.json_path}: {error.message}")
    cases = json.loads((folder / "bad_scenarios.json").read_text())
    for case in cases:
        if case["schema"] == "malformed":
            continue  # no YAML, nothing to validate
        base = folder / case.get("base", "everything.yaml")
        text = case["text"] if "text" in case else base.read_text().replace(case["replace"], case["with"], 1)
        accepted = validator.is_valid(yaml.load(text, Core))
        if accepted != (case["schema"] == "accepts"):
            faults.append(f"{case['name']}: the schema {'accepts' if accepted else 'refuses'} it")
    if not good or not cases:
        faults.append("no scenarios found")
    print("\n".join(faults) or f"{len(good)} good and {len(cases)} bad scenarios as expected")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
