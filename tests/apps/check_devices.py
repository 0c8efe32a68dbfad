# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_devices.py SOURCE [--write]: checks docs/devices/*.json and the table of docs/devices.md.

Each file is a device.json of `greatx bench --suite`. The table has one row a file. With --write, the script
writes the table between the two comments of docs/devices.md; without, it fails if the table is another one.
"""
from __future__ import annotations

import json
import pathlib
import sys

BEGIN, END = "<!-- devices: begin -->\n", "<!-- devices: end -->\n"
PASSES = ["single rays", "LiDAR sweep", "path segments", "candidate rays", "radar rays", "camera picture",
          "event interval", "whole tick"]
DEVICE_FIELDS = {"name": str, "type": str, "driver": str, "api_version": str, "mesa": str, "llvm": str}
FIELDS = {"greatx": str, "device": dict, "cores": int, "date": str, "embree": str, "triangles": int,
          "note": str, "passes": list}
PASS_FIELDS = {"pass": str, "tracer": str, "unit": str, "per_second": (int, float),
               "per_core_second": (int, float)}


class Failure(Exception):
    pass


def check_fields(where: str, value: object, fields: dict) -> None:
    if not isinstance(value, dict):
        raise Failure(f"{where}: expected an object")
    for key, kind in fields.items():
        if not isinstance(value.get(key), kind) or isinstance(value[key], bool):
            raise Failure(f"{where}: {key}: expected {kind}, found {value.get(key)!r}")


def read(path: pathlib.Path) -> dict:
    try:
        device = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise Failure(f"{path}: {error}") from error
    check_fields(str(path), device, FIELDS)
    if device.get("greatx_suite") != 1:
        raise Failure(f"{path}: greatx_suite: expected 1, found {device.get('greatx_suite')!r}")
    check_fields(f"{path}: device", device["device"], DEVICE_FIELDS)
    for number, row in enumerate(device["passes"]):
        check_fields(f"{path}: passes[{number}]", row, PASS_FIELDS)
    return device


def cell(text: str) -> str:
    return " ".join(text.replace("|", "/").split()) or "–"


def rates(device: dict, name: str) -> str:
    """Returns the rate of greatx's fastest tracer with its name: millions of units per second, or ticks."""
    rows = [row for row in device["passes"] if row["pass"] == name and row["tracer"] != "embree"]
    if not rows:
        return "–"
    best = max(rows, key=lambda row: row["per_second"])
    rate = best["per_second"] / (1 if best["unit"] == "ticks" else 1e6)
    return f"{rate:.2f} ({best['tracer']})"


def table(folder: pathlib.Path) -> str:
    heads = ["device", "driver", "Mesa", "LLVM", "cores", "triangles", *PASSES, "greatx", "date", "note"]
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for path in sorted(folder.glob("*.json")):
        device = read(path)
        about = device["device"]
        cells = [
            f"[{cell(about['name'])}](devices/{path.name})",
            *(about[key] for key in ("driver", "mesa", "llvm")),
            str(device["cores"]),
            f"{device['triangles']:,}",
            *(rates(device, name) for name in PASSES),
            *(device["greatx"], device["date"][:10], device["note"]),
        ]
        lines.append("| " + " | ".join(cell(text) for text in cells) + " |")
    return "\n".join(lines) + "\n"


def main(arguments: list[str]) -> int:
    source = pathlib.Path(arguments[0])
    page = source / "docs" / "devices.md"
    text = page.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise Failure(f"{page}: expected the comments 'devices: begin' and 'devices: end', once each")
    before, rest = text.split(BEGIN)
    found, after = rest.split(END)
    wanted = "\n" + table(source / "docs" / "devices") + "\n"
    if found == wanted:
        return 0
    if "--write" not in arguments:
        raise Failure(f"{page}: the table is not that of docs/devices/; run this script with --write")
    page.write_text(before + BEGIN + wanted + END + after, encoding="utf-8")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Failure as failure:
        sys.exit(f"check_devices.py: {failure}")
