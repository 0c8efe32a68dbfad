#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that the documentation names exactly the effects that the program has, as `greatx explain --json`
lists them. docs/scenario.md and docs/scenario.schema.json must name the effects that can be switched,
docs/effects.md all of them. --write makes docs/effects.md from the table in sim/plan/effect_list.h.

usage: check_docs_effects.py [--write] PROGRAM SOURCE_FOLDER
"""
import json
import pathlib
import re
import subprocess
import sys

GROUPS = {
    "RAY": "Tracing rays",
    "CAMERA": "Cameras",
    "LIDAR": "LiDARs",
    "RADAR": "Radars",
    "RADIO": "Channels",
    "CHECKS": "Checks",
}
HEAD = """<!-- SPDX-FileCopyrightText: 2026 The greatx authors -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
<!-- tests/apps/check_docs_effects.py --write makes this page from sim/plan/effect_list.h -->
# Effects

This page lists every effect in the order in which `greatx explain` prints them. A scenario can switch the
effects that are marked "yes" ([scenario.md](scenario.md#effects) says when `auto` switches each of them on).
The others follow from its sensors.
"""


def table(header):
    """Returns [(group, [(name, switchable, documentation)])] from the rows of the header."""
    groups = []
    for group, body in re.findall(r"^#define GREATX_(\w+?)(?:_EFFECTS)?\(X\)((?:.*\\\n)+.*)", header, re.M):
        rows = re.findall(r'\bX\((\w+), (true|false), \w+, "([^"]+)"\)', body)
        if rows:
            groups.append((GROUPS[group], [(name, can == "true", words) for name, can, words in rows]))
    return groups


def page_of(groups):
    page = HEAD
    for title, rows in groups:
        page += f"\n## {title}\n\n| effect | switch | meaning |\n|---|---|---|\n"
        page += "".join(f"| `{name}` | {'yes' if can else ''} | {words} |\n" for name, can, words in rows)
    return page


def documented(page):
    """Returns the names in the first column of the section's table and in the paragraphs after the table."""
    section = re.search(r"^## `effects`\n(.*?)(?=^## |\Z)", page, re.M | re.S).group(1)
    lines = section.splitlines()
    rows = [index for index, line in enumerate(lines) if line.startswith("|")]
    names = [name for index in rows for name in re.findall(r"`([a-z_]+)`", lines[index].split("|")[1])]
    return names + re.findall(r"`([a-z_]+)`", "\n".join(lines[rows[-1] + 1 :]))


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--write"]
    program, source = arguments[0], pathlib.Path(arguments[1])
    groups = table((source / "sim/plan/effect_list.h").read_text())
    effects_page = source / "docs/effects.md"
    if "--write" in sys.argv:
        effects_page.write_text(page_of(groups))
    explained = json.loads(
        subprocess.run(
            [program, "explain", "city", "--json"], check=True, capture_output=True, text=True
        ).stdout
    )["effects"]
    if len(explained) < 60:
        sys.exit(f"explain names {len(explained)} effects alone")
    faults = []
    rows = [row for _, of_group in groups for row in of_group]
    if [(effect["name"], effect["switchable"]) for effect in explained] != [row[:2] for row in rows]:
        faults.append("sim/plan/effect_list.h: explain lists other effects, or in another order")
    if effects_page.read_text() != page_of(groups):
        faults.append(f"{effects_page}: is not what sim/plan/effect_list.h says; --write makes it")
    expected = {effect["name"] for effect in explained if effect["switchable"]}
    schema = source / "docs/scenario.schema.json"
    scenario = source / "docs/scenario.md"
    in_schema = json.loads(schema.read_text())["properties"]["effects"]["propertyNames"]["enum"]
    for name, found in ((scenario, documented(scenario.read_text())), (schema, in_schema)):
        faults += [f"{name}: lacks {effect}" for effect in sorted(expected - set(found))]
        faults += [f"{name}: names {effect}, which is none" for effect in sorted(set(found) - expected)]
        faults += [
            f"{name}: names {effect} more than once"
            for effect in sorted(set(found))
            if list(found).count(effect) > 1
        ]
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
