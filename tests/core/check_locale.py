#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that no source reads or writes numbers by the locale of the process. Python, and any program that
loads the module, may have set a locale whose decimal sign is a comma."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
folders = ["core", "gpu", "scene", "renderer", "rf", "io", "sim", "assets", "engine", "apps", "python/src"]
banned = re.compile(
    r"\b(?:std::)?(strtod|strtof|strtold|atof|stod|stof|stold|sscanf|fscanf"
    r"|as_double|as_float|setlocale)\s*\("
    r"|std::(locale)\b|\{[^{}\"]*:[^{}\"]*(L)\}"
)
faults = []
files = [f for folder in folders for f in sorted((root / folder).rglob("*")) if f.suffix in (".cpp", ".h")]
for file in files:
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        found = banned.search(line.split("//")[0])
        if found:
            faults.append(
                f"{file.relative_to(root)}:{number}: {found.group(0)}: use parse_number() or std::from_chars"
            )
if len(files) < 300:
    faults.append(f"only {len(files)} sources found below {root}")
print("\n".join(faults) or f"{len(files)} sources read no number by locale")
sys.exit(1 if faults else 0)
