#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the corpus of the targets from the seeds of fuzz.py.

python3 tests/fuzz/targets/make_corpus.py tests/fuzz/targets/corpus
"""
import pathlib
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import seeds  # pylint: disable=wrong-import-position

SIDECAR = """materials:
  wall: {itu: concrete, thickness_m: 0.3}
  "itu_*": {itu: brick, thickness_m: 0.24, scattering_coefficient: 0.3, pattern: directive}
  facade: {itu: brick, windows: {share: 0.22, layers: [{itu: glass, thickness_m: 0.006}]}}
  "leaves_*": {foliage: weissberger}
  "*": {relative_permittivity: 4.0, conductivity: 0.02}
"""
LARGEST = 24_000


def kind_of(name):
    """Returns the target that reads a file of this name, or None."""
    if name.endswith((".gltf", ".glb")):
        return "gltf"
    if name.endswith((".png", ".jpg")):
        return "picture"
    if name.endswith(".ply"):
        return "ply"
    if name.endswith(".xml"):
        return "mitsuba"
    if name.endswith((".msi", ".ffd")):
        return "antenna_" + name[-3:]
    words = {"flight": "trajectory", "plain": "trajectory", "gain": "antenna", "field": "antenna"}
    words.update({"shots": "shots", "points": "receivers"})
    return words.get(pathlib.PurePath(name).stem) if name.endswith(".csv") else None


def main():
    corpus = pathlib.Path(sys.argv[1])
    written = {}

    def keep(target, data, suffix):
        if len(data) > LARGEST or data in written.setdefault(target, []):
            return
        written[target].append(data)
        folder = corpus / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"seed_{len(written[target]):02d}{suffix}").write_bytes(data)

    for case in seeds.gltf() + seeds.picture() + seeds.mitsuba() + seeds.csv() + seeds.scenario():
        for name, entry in case.files.items():
            target = "scenario" if name.endswith(".yaml") and "radio" not in name else kind_of(name)
            if target is not None:
                keep(target, entry.content(), pathlib.PurePath(name).suffix)
    keep("radio_material", SIDECAR.encode(), ".yaml")
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"
    header += b" " * (118 - len(header) - 1) + b"\n"
    keep("npy", b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(24), ".npy")
    keep("packed", packed(), ".bin")


def packed():
    """Returns a table of places and the packed bytes behind it: two records of t, points, map and p."""
    places, data = [], b""

    def add(rows, values, kind=0, first=0):
        nonlocal data
        size = len(values) // max(rows, 1)
        planes = b"".join(values[i::size] for i in range(size)) if rows else b""
        chunk = zlib.compress(planes) if rows else b""
        places.append((len(data), len(chunk), rows, kind, first))
        data += chunk

    for rows in (3, 0):
        add(rows, struct.pack(f"<{rows}I", *range(rows)), 1, 70)
        for _ in range(3):
            add(rows, struct.pack(f"<{rows}h", *range(rows)), 3)
        add(rows, struct.pack(f"<{rows}f", *range(rows)))
        add(6, struct.pack("<6f", *range(6)))
        places[-1] = (*places[-1][:2], 1, 0, 0)
        add(rows, bytes(rows))
    text = b"{'descr': '<i8', 'fortran_order': False, 'shape': (2, 7, 5), }"
    table = b"\x93NUMPY\x01\x00" + struct.pack("<H", 246) + text.ljust(245) + b"\n"
    table += b"".join(struct.pack("<5q", *place) for place in places)
    return struct.pack("<H", len(table)) + table + data


if __name__ == "__main__":
    main()
