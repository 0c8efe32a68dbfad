#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the bytes that two builds of greatx write. A change of structure must not change any of them.

    python3 tests/compare_builds.py OLD/greatx NEW/greatx [--ticks 4] [--assets FOLDER]
            [--only city --only room] [--decoded]

The scenarios of assets/scenarios, and the examples whose files lie in FOLDER, run for a few ticks in both
builds, from the same text. The
manifests list the size and the SHA-256 of every file, so equal manifests mean equal data sets. For each
scenario with a channel the JSON of `greatx paths` is compared as well. The exit status is 0 if everything is
equal and 1 if not. With --decoded, pictures whose bytes differ are read back by the Python package (which
needs NumPy) and their pixels are compared: for a change of an encoder. The sizes of these pictures are shown.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(program, *arguments):
    """Returns the bytes on stdout. If the program fails, ends the comparison with the program's message."""
    command = [str(program), *map(str, arguments)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: exit {done.returncode}\n{done.stderr.decode(errors='replace')}")
    return done.stdout


def files_of(folder):
    """Returns path -> (size, SHA-256) of a finished data set."""
    manifest = json.loads((folder / "manifest.json").read_text())
    return {entry["path"]: (entry["size"], entry["sha256"]) for entry in manifest["files"]}


def equal_pixels(old, new):
    """Returns whether two PNG or EXR files hold the same pixels."""
    sys.path.insert(0, str(ROOT / "python"))
    from greatx import frames

    read = frames.read_png if old.suffix == ".png" else frames.read_exr
    a, b = read(old), read(new)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def difference_of_sets(old, new, sizes=None):
    """Describes the first file that differs between two data sets. Returns an empty string if all are
    equal. With `sizes`, a picture may differ if its pixels are equal; its sizes are added to sizes[kind],
    [before, after]."""
    before, after = files_of(old), files_of(new)
    for path in sorted(before.keys() | after.keys()):
        if path not in after:
            return f"{path} is missing in the new one"
        if path not in before:
            return f"{path} is missing in the old one"
        if before[path] != after[path]:
            if sizes is not None and path.endswith((".png", ".exr")):
                if equal_pixels(old / path, new / path):
                    kind = pathlib.Path(path).parent.name + pathlib.Path(path).suffix
                    of_kind = sizes.setdefault(kind, [0, 0])
                    of_kind[0] += before[path][0]
                    of_kind[1] += after[path][0]
                    continue
            return (
                f"{path}: {before[path][0]} bytes {before[path][1][:12]}, "
                f"{after[path][0]} bytes {after[path][1][:12]}"
            )
    return ""


def compare_generate(programs, scenario, extra, ticks, scratch, sizes):
    folders = [scratch / side for side in ("old", "new")]
    for program, folder in zip(programs, folders):
        shutil.rmtree(folder, ignore_errors=True)
        run(program, "generate", scenario, *extra, "--ticks", ticks, "-q", "-o", folder)
    return difference_of_sets(*folders, sizes)


def compare_paths(programs, scenario, extra, tick):
    texts = [run(program, "paths", scenario, *extra, "--tick", tick, "--json") for program in programs]
    if texts[0] == texts[1]:
        return ""
    lines = zip(texts[0].decode().splitlines(), texts[1].decode().splitlines())
    return next((f"{a.strip()} became {b.strip()}" for a, b in lines if a != b), "one is longer")


def ticks_of(scenario):
    """Returns the length of a scenario that states it in ticks, else a number that is never reached."""
    stated = re.search(r"^ticks: (\d+)", scenario.read_text(), re.MULTILINE)
    return int(stated.group(1)) if stated else 1 << 60


def cases_of(assets):
    """Yields (name, scenario argument, further arguments, whether it has a channel) of everything to
    compare."""
    for file in sorted((ROOT / "assets/scenarios").glob("*.yaml")):
        yield file.stem, file, [], "\nchannels:" in file.read_text()
    if assets:
        for file in sorted((ROOT / "assets/examples").glob("*.yaml")):
            text = file.read_text()
            if "\ngreatx:" in text and "\nticks:" in text:
                yield file.stem, file, ["--assets", assets], "\nchannels:" in text


def main():
    parser = argparse.ArgumentParser(description="compares the bytes that two builds of greatx write")
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("--ticks", type=int, default=4)
    parser.add_argument("--assets", type=pathlib.Path, help="folder of the examples' scenes")
    parser.add_argument("--only", action="append", default=[], help="a scenario's name; may be given again")
    parser.add_argument("--decoded", action="store_true", help="compare pixels of pictures that differ")
    options = parser.parse_args()
    sizes = {} if options.decoded else None
    programs = [options.old.resolve(), options.new.resolve()]
    differing = compared = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, scenario, extra, has_channel in cases_of(options.assets):
            if options.only and name not in options.only:
                continue
            begin = time.monotonic()
            found = compare_generate(programs, scenario, extra, options.ticks, pathlib.Path(folder), sizes)
            if not found and has_channel:
                last = min(options.ticks, ticks_of(scenario)) - 1
                found = compare_paths(programs, scenario, extra, last)
            compared += 1
            differing += bool(found)
            print(f"{name:16} {time.monotonic() - begin:6.1f} s  {found or 'equal'}", flush=True)
    for kind, (before, after) in sorted((sizes or {}).items()):
        print(f"{kind:16} {before} -> {after} bytes, the same pixels")
    print(f"{compared} compared, {differing} differ")
    return 1 if differing or not compared else 0


if __name__ == "__main__":
    sys.exit(main())
