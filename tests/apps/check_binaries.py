#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks every program and shared library below the folders by readelf: no RPATH or RUNPATH may have an empty
or relative entry. The loader takes such an entry for the current folder, from which it would load anybody's
library. With --hardened it also checks the flags that cmake/GreatxTargets.cmake sets.

usage: check_binaries.py [--hardened] LEAST FOLDER...
       LEAST: smallest number of files to be found, so that a check of the wrong folder fails
"""
import os
import pathlib
import re
import subprocess
import sys

#: Functions that the program and the Python module call if they are built with these flags.
CALLED = {
    "stack protector": r"__stack_chk_fail\b",
    "_FORTIFY_SOURCE": r"__(?:mem|str|vsnprintf|snprintf|read|pread)\w*_chk\b",
    "_GLIBCXX_ASSERTIONS": r"__glibcxx_assert_fail",
}


def is_elf(path):
    if path.is_symlink() or not path.is_file():
        return False
    with path.open("rb") as file:
        head = file.read(18)
    # ET_EXEC and ET_DYN. Object files have no dynamic section.
    return head[:4] == b"\x7fELF" and len(head) == 18 and int.from_bytes(head[16:18], "little") in (2, 3)


def binaries(folders):
    for folder in folders:
        for where, names, files in os.walk(folder):
            names[:] = [name for name in names if name != "CMakeFiles"]  # CMake's trials of the compiler
            yield from (pathlib.Path(where) / name for name in files if is_elf(pathlib.Path(where) / name))


def readelf(path, *options):
    return subprocess.run(
        ["readelf", "--wide", *options, path],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, "LC_ALL": "C"},
    ).stdout


def loader_faults(path):
    for kind, entries in re.findall(
        r"\((RPATH|RUNPATH)\)\s+Library r(?:un)?path: \[(.*)\]", readelf(path, "--dynamic")
    ):
        for entry in entries.split(":"):
            if not entry.startswith(("/", "$ORIGIN")):
                yield f"{path}: {kind} [{entries}] has the entry '{entry}': expected absolute folders"


def hardening_faults(path):
    segments, dynamic = readelf(path, "--segments"), readelf(path, "--dynamic")
    if "GNU_RELRO" not in segments:
        yield f"{path}: no GNU_RELRO segment"
    if not re.search(r"\(FLAGS(_1)?\).*\b(BIND_)?NOW\b", dynamic):
        yield f"{path}: not bound at start (BIND_NOW)"
    if re.search(r"GNU_STACK.*\bRWE\b", segments):
        yield f"{path}: its stack is executable"
    if "INTERP" in segments and not re.search(r"\(FLAGS_1\).*\bPIE\b", dynamic):
        yield f"{path}: at a fixed address (no PIE)"
    if path.name == "greatx" or path.name.startswith("_native"):
        symbols = readelf(path, "--dyn-syms")
        for what, symbol in CALLED.items():
            if not re.search(symbol, symbols):
                yield f"{path}: nothing of {what}"


def main():
    arguments = sys.argv[1:]
    hardened = arguments[0] == "--hardened"
    least, *folders = arguments[hardened:]
    found = sorted(binaries(folders))
    checks = (loader_faults, hardening_faults) if hardened else (loader_faults,)
    faults = [fault for path in found for check in checks for fault in check(path)]
    if len(found) < int(least):
        faults.append(
            f"{', '.join(folders)}: expected {least} programs and libraries or more, found {len(found)}"
        )
    print("\n".join(faults) or f"{len(found)} programs and libraries are sound")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
