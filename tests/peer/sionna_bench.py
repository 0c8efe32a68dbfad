# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Measures one row of the table for Sionna RT in a process of its own: `sionna_bench.py ROW JSON` prints one
JSON object. A time is the wall clock time until amplitudes and delays are in NumPy arrays. The time before
the first solve is stated separately."""
import time

BEGIN = time.perf_counter()

import dataclasses  # noqa: E402
import hashlib  # noqa: E402
import json  # noqa: E402
import pathlib  # noqa: E402
import sys  # noqa: E402

import numpy as np  # noqa: E402

from sionna_paths import case_called  # noqa: E402


def arrays(paths):
    """Returns the arrays that a user takes away. Reading them makes Dr.Jit finish."""
    return [
        np.array(x)
        for x in (
            *paths.a,
            paths.tau,
            paths.theta_t,
            paths.phi_t,
            paths.theta_r,
            paths.phi_r,
            paths.valid,
            paths.interactions,
            paths.vertices,
        )
    ]


def timed(call):
    begin = time.perf_counter()
    value = call()
    return 1e3 * (time.perf_counter() - begin), value


def first(sionna, receivers, settings):
    """Times the first solve, whose kernels are compiled or come from Dr.Jit's own cache, and then `repeat`
    more at other places."""
    import mitsuba as mi

    sionna.place(receivers[:1])
    first_ms, _ = timed(lambda: arrays(sionna.solve(**settings["solve"])))
    to_first_ms = 1e3 * (time.perf_counter() - BEGIN)
    device = sionna.scene.receivers["rx0"]
    steady = []
    for i in range(settings["repeat"]):
        device.position = mi.Point3f(*map(float, receivers[(i + 1) % len(receivers)]))
        steady.append(timed(lambda: arrays(sionna.solve(**settings["solve"])))[0])
    return {
        "first_ms": first_ms,
        "to_first_ms": to_first_ms,
        "steady_ms": float(np.median(steady)) if steady else None,
        "slowest_ms": max(steady, default=None),
    }


def many(sionna, receivers, settings):
    """Times all receivers in one call, or one at a time: once to warm up, then once more."""
    sionna.place(receivers)
    call = lambda: arrays(sionna.solve(**settings["solve"]))  # noqa: E731
    cold_ms, _ = timed(call)
    to_first_ms = 1e3 * (time.perf_counter() - BEGIN)
    warm_ms, out = timed(call)
    return {"first_ms": cold_ms, "to_first_ms": to_first_ms, "steady_ms": warm_ms, "paths": int(out[7].sum())}


def digest(sionna, receivers, settings):
    """Returns hashes of the arrays as they come and of the sorted paths. Sets of paths may be equal where the
    bytes differ."""
    sionna.place(receivers)
    out = arrays(sionna.solve(**settings["solve"]))
    whole = hashlib.sha256(b"".join(a.tobytes() for a in out)).hexdigest()
    valid = out[7]
    rows = sorted(
        (int(r), int(t), round(float(out[2][r, t, i]) * 299792458.0, 3), tuple(map(int, out[8][:, r, t, i])))
        for r, t, i in np.argwhere(valid)
    )
    return {"bytes": whole, "set": hashlib.sha256(repr(rows).encode()).hexdigest(), "paths": int(valid.sum())}


def radio_map(sionna, receivers, settings):
    import mitsuba as mi
    import sionna.rt as rt

    scene = sionna.scene
    sionna.antennas("iso", "V", 1, 1, receiver=("iso", "V"))
    case = sionna.case
    kwargs = dict(
        center=mi.Point3f(*settings["center"]),
        orientation=mi.Point3f(0, 0, 0),
        size=mi.Point2f(*settings["size"]),
        cell_size=mi.Point2f(settings["cell"], settings["cell"]),
        samples_per_tx=int(settings["samples"]),
        max_depth=case.depth,
        refraction=case.walls > 0,
        specular_reflection=True,
    )
    solver = rt.RadioMapSolver()
    cold_ms, first_map = timed(lambda: np.array(solver(scene, **kwargs).path_gain))
    to_first_ms = 1e3 * (time.perf_counter() - BEGIN)
    warm_ms, gain = timed(lambda: np.array(solver(scene, **kwargs).path_gain))
    if settings.get("file"):
        np.save(settings["file"], gain)
    return {
        "first_ms": cold_ms,
        "to_first_ms": to_first_ms,
        "steady_ms": warm_ms,
        "cells": int(gain.size),
        "lit": int((gain > 0).sum()),
        "same_bytes": bool((first_map == gain).all()),
    }


def main():
    row, settings = sys.argv[1], json.loads(sys.argv[2])
    from sionna_side import Sionna

    case = dataclasses.replace(case_called(settings["case"]), **settings.get("change", {}))
    sionna = Sionna(case, pathlib.Path(settings["work"]))
    receivers = np.array(settings["receivers"], float)
    ready_ms = 1e3 * (time.perf_counter() - BEGIN)
    result = {"first": first, "many": many, "digest": digest, "map": radio_map}[row](
        sionna, receivers, settings
    )
    print(json.dumps({"import_and_load_ms": ready_ms} | result))


if __name__ == "__main__":
    main()
