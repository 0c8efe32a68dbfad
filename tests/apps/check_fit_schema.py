# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_fit_schema.py ROOT: checks that docs/fit.schema.json, docs/fit.md and the reader of apps/fit name the
same keys, that the schema accepts the page's and the example's descriptions, and that it refuses faults."""
import json
import pathlib
import re
import sys

import jsonschema
import yaml

root = pathlib.Path(sys.argv[1])
schema = json.loads((root / "docs/fit.schema.json").read_text())
page = (root / "docs/fit.md").read_text()
reader = "".join((root / "apps/fit" / name).read_text() for name in ("fit_file.cpp", "measurement_file.cpp"))
faults = []


def keys_of(value: object) -> set[str]:
    """Returns the property names of all objects of the schema."""
    found: set[str] = set()
    if isinstance(value, dict):
        if isinstance(value.get("properties"), dict):
            found |= set(value["properties"])
        for inner in value.values():
            found |= keys_of(inner)
    elif isinstance(value, list):
        for inner in value:
            found |= keys_of(inner)
    return found


in_schema = keys_of(schema)
for key in sorted(in_schema):
    if f'"{key}"' not in reader:
        faults.append(f"the reader does not know the key {key}")
    if f"`{key}`" not in page and f"{key}:" not in page and f"{key}," not in page and f"{key}}}" not in page:
        faults.append(f"fit.md does not name the key {key}")
lists = re.findall(r"(?:FieldMap \w+\(\s*\*?[\w.]+,|Keys(?: \w+)?|taps|band)\s*\{([^}]*)\}", reader)
in_reader = {key for keys in lists for key in re.findall(r'"(\w+)"', keys)}
for key in sorted(in_reader - in_schema):
    faults.append(f"the schema does not know the key {key}")
if len(in_reader) < 30:
    faults.append(f"only {len(in_reader)} keys were found in the reader")

validator = jsonschema.Draft202012Validator(schema)
example = yaml.safe_load((root / "assets/examples/fit/fit.yaml").read_text())
written = yaml.safe_load(re.search(r"```yaml\n(greatx_fit.*?)```", page, re.DOTALL).group(1))
for name, one in (("example", example), ("page", written)):
    faults += [f"the {name}: {error.message}" for error in validator.iter_errors(one)]
for change in (
    {"colour": 1},
    {"greatx_fit": 2},
    {"measurements": []},
    {"measurements": [{"name": "x", "quantity": "power_db"}]},
    {"parameters": [{"material": "x", "property": "mass", "bounds": [1, 2]}]},
    {"unknown": {"scale_db": {}}},
):
    if validator.is_valid({**example, **change}):
        faults.append(f"the schema accepts {change}")
print("\n".join(faults) or f"{len(in_schema)} keys agree")
sys.exit(1 if faults else 0)
