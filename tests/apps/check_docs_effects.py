#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that docs/scenario.md and docs/scenario.schema.json name exactly the effects that the program can
switch, as `greatx explain --json` lists them.

usage: check_docs_effects.py PROGRAM SCENARIO_MD SCHEMA
"""
import json
import pathlib
import re
import subprocess
import sys


def documented(page):
    """First column of the section's table, and every name in the paragraphs after it."""
    section = re.search(r"^## `effects`\n(.*?)(?=^## |\Z)", page, re.M | re.S).group(1)
    lines = section.splitlines()
    rows = [index for index, line in enumerate(lines) if line.startswith("|")]
    names = [name for index in rows for name in re.findall(r"`([a-z_]+)`", lines[index].split("|")[1])]
    return names + re.findall(r"`([a-z_]+)`", "\n".join(lines[rows[-1] + 1:]))


def main():
    program, page, schema = sys.argv[1:]
    explained = json.loads(subprocess.run([program, "explain", "city", "--json"], check=True,
                                          capture_output=True, text=True).stdout)
    expected = {effect["name"] for effect in explained["effects"] if effect["switchable"]}
    if len(expected) < 30:
        sys.exit(f"explain names {len(expected)} effects alone")
    faults = []
    in_schema = json.loads(pathlib.Path(schema).read_text())["properties"]["effects"]["propertyNames"]["enum"]
    for name, found in ((page, documented(pathlib.Path(page).read_text())), (schema, in_schema)):
        faults += [f"{name}: lacks {effect}" for effect in sorted(expected - set(found))]
        faults += [f"{name}: names {effect}, which is none" for effect in sorted(set(found) - expected)]
        faults += [f"{name}: names {effect} more than once"
                   for effect in sorted(set(found)) if list(found).count(effect) > 1]
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
