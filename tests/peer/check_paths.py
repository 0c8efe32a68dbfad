# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the paths of data sets (first record, receivers matched by position) with a list of all paths that
exist. Prints one row for each data set: found, missing, extra and doubled paths, and differences.
Usage: check_paths.py REFERENCE DATASET...

REFERENCE has lines `receiver i x y z` and `path i depth length x y z ...` (vertices from the transmitter)."""
import sys

import numpy as np

from dataset import C, Channel


def read_reference(file):
    receivers, paths = {}, {}
    for line in open(file):
        word, *values = line.split() if line.strip() else ("",)
        if word == "receiver":
            receivers[int(values[0])] = np.array(values[1:4], float)
        elif word == "path":
            vertices = np.array(values[3:], float).reshape(-1, 3)
            paths.setdefault(int(values[0]), []).append((float(values[2]), vertices))
    return receivers, paths


def same(a, b, tolerance):
    return len(a[1]) == len(b[1]) and abs(a[0] - b[0]) < tolerance and np.all(np.abs(a[1] - b[1]) < tolerance)


def main():
    receivers, reference = read_reference(sys.argv[1])
    for folder in sys.argv[2:]:
        channel = Channel(folder)
        p = channel.paths(0)
        total = found = extra = doubled = 0
        length_difference = vertex_difference = 0.0
        notes = []
        for r, description in enumerate(channel.meta["receivers"]):
            place, _ = channel.end(0, description)
            i = min(receivers, key=lambda k: np.linalg.norm(receivers[k] - place))
            assert np.linalg.norm(receivers[i] - place) < 1e-6
            # The list holds reflections only, so paths with transmissions, diffractions or scatterings are
            # left out.
            mine = [k for k in np.flatnonzero(p["rx"] == r) if (p["interaction"][k] <= 1).all()]
            ours = [
                (p["delay"][k] * C, p["vertex"][k][: np.count_nonzero(p["interaction"][k])]) for k in mine
            ]
            left = list(ours)
            for path in reference.get(i, []):
                total += 1
                hits = [k for k, other in enumerate(left) if same(path, other, 1e-3)]
                if not hits:
                    notes.append(f"  missing: receiver {i}, depth {len(path[1])}, {path[0]:.6f} m")
                    continue
                found += 1
                length_difference = max(length_difference, abs(left[hits[0]][0] - path[0]))
                if len(path[1]):
                    vertex_difference = max(vertex_difference, np.abs(left[hits[0]][1] - path[1]).max())
                doubled += len(hits) - 1
                left = [other for k, other in enumerate(left) if k not in hits]
            extra += len(left)
            notes += [
                f"  extra: receiver {i}, depth {len(v)}, {l:.6f} m {np.round(v, 4).tolist()}" for l, v in left
            ]
        print(
            f"{folder}: {channel.meta['candidates'].get('guarantee', 'no search')}; "
            f"{found} of {total} found, {extra} extra, {doubled} doubled; "
            f"largest difference: length {length_difference:.1e} m, vertex {vertex_difference:.1e} m"
        )
        print("\n".join(notes), end="\n" if notes else "")


if __name__ == "__main__":
    main()
