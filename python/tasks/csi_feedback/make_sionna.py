#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the set of channels that Sionna RT computes for the users of a set of greatx, in its own scene.

    python3 tests/peer/sionna_rt.py --list                       # sets up an environment with Sionna RT
    build/peer/venv/bin/python python/tasks/csi_feedback/make_sionna.py out/csi/etoile -o out/csi/sionna

Transmitter, users, array, grid and depth are those of SET, which was made from Sionna RT's scene "etoile".
Walls are opaque in both. Materials are those of Sionna RT's scene. It needs Debian's libllvm19."""
from __future__ import annotations

import argparse
import pathlib
import sys
import time
from typing import Any, Dict, List, Tuple

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
if __package__ in (None, ""):
    sys.path += [str(ROOT / "python"), str(ROOT / "tests" / "peer")]
    __package__ = "tasks.csi_feedback"

from greatx.errors import Error

from .sets import ChannelSet, load, save
from .transforms import angular_delay

#: Users of a call. All receivers of a call share a table, and more of them lose more paths (docs/sionna.md).
BATCH = 20


def scene(rt: Any, mi: Any, name: str, facts: Dict[str, Any], site: List[float], ports: int) -> Any:
    """Returns Sionna RT's scene with a transmitter and the users' antenna, and the order of its ports."""
    out = rt.load_scene(getattr(rt.scene, name))
    out.frequency = facts["carrier_hz"]
    line = dict(num_rows=1, vertical_spacing=0.5, horizontal_spacing=0.5, pattern="iso", polarization="V")
    out.tx_array = rt.PlanarArray(num_cols=ports, **line)
    out.rx_array = rt.PlanarArray(num_cols=1, **line)
    *position, yaw = site
    orientation = mi.Point3f(float(np.radians(yaw)), 0.0, 0.0)
    out.add(rt.Transmitter("tx", mi.Point3f(*position), orientation=orientation))
    for i in range(BATCH):
        out.add(rt.Receiver(f"rx{i}", mi.Point3f(0, 0, 1)))
    return out


def port_order(array: Any) -> np.ndarray:
    """Returns the numbers of Sionna RT's ports in the order of greatx's, which is that of +y."""
    return np.argsort(np.array(array.normalized_positions.y).ravel(), kind="stable")


def responses(
    rt: Any, mi: Any, place: Any, points: np.ndarray, facts: Dict[str, Any], seed: int
) -> np.ndarray:
    """Returns H of at most BATCH points, complex64 [n, port, subcarrier], zero without a path."""
    padded = np.concatenate([points, np.repeat(points[-1:], BATCH - len(points), axis=0)])
    for i, position in enumerate(padded):
        place.receivers[f"rx{i}"].position = mi.Point3f(*map(float, position))
    paths = rt.PathSolver()(
        place,
        max_depth=facts["max_depth"],
        samples_per_src=1_000_000,
        max_num_paths_per_src=10_000_000,
        specular_reflection=True,
        refraction=False,
        synthetic_array=True,
        seed=seed,
    )
    count = facts["subcarriers"]
    offsets = (np.arange(count) - count // 2) * facts["bandwidth_hz"] / count
    re, im = paths.cfr(frequencies=mi.Float(offsets.astype(np.float32)), normalize_delays=False)
    response = (np.array(re) + 1j * np.array(im))[: len(points), 0, 0, :, 0]
    return response[:, port_order(place.tx_array)].astype(np.complex64)


def make(given: ChannelSet, name: str, users: int, seed: int) -> ChannelSet:
    """Returns the set of the first users of a set of one site."""
    import mitsuba as mi
    import sionna.rt as rt

    facts, ports = given.facts, given.channels.shape[1]
    if len(facts["sites"]) != 1:
        raise Error(f"{given.name}: expected one base station, found {len(facts['sites'])}")
    place = scene(rt, mi, name, facts, facts["sites"][0], ports)
    parts: List[Tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    began = time.perf_counter()
    without = late = 0
    points = given.position_m[:users]
    for first in range(0, len(points), BATCH):
        some = points[first : first + BATCH]
        response = responses(rt, mi, place, some, facts, seed)
        lit = np.flatnonzero(response.any((1, 2)))
        without += len(some) - len(lit)
        if len(lit):
            matrices, outside = angular_delay(response[lit], given.channels.shape[2])
            good = outside <= facts["most_outside"]
            late += int(np.sum(~good))
            parts.append((matrices[good], some[lit][good], outside[good]))
        done = first + len(some)
        left = (time.perf_counter() - began) / done * (len(points) - done)
        if sys.stderr.isatty():
            print(f"\rSionna RT: {done} of {len(points)} users, {left:.0f} s left  ", end="", file=sys.stderr)
    if not parts:
        raise Error(f"Sionna RT finds no path to any of {len(points)} users")
    channels, position, outside = (np.concatenate(part) for part in zip(*parts))
    described = {key: facts[key] for key in ("carrier_hz", "bandwidth_hz", "subcarriers", "array", "sites")}
    described.update(
        name=f"Sionna RT {name}",
        made_by=f"Sionna RT {_version()}",
        scene={"sionna_rt": name},
        max_depth=facts["max_depth"],
        users={
            "of": given.name,
            "asked": len(points),
            "without_path": without,
            "too_late": late,
            "seed": seed,
        },
        power_outside={"mean": float(outside.mean()), "p95": float(np.percentile(outside, 95))},
    )
    return ChannelSet(channels, position, outside, described)


def _version() -> str:
    from importlib.metadata import version

    return version("sionna-rt")


def compare(given: ChannelSet, made: ChannelSet) -> str:
    """Returns a sentence on how far the channels of users of both sets differ."""
    index = {tuple(p): i for i, p in enumerate(given.position_m)}
    ours = given.channels[[index[tuple(p)] for p in made.position_m]]
    error = np.square(np.abs(made.channels - ours)).sum((1, 2)) / np.square(np.abs(ours)).sum((1, 2))
    low, middle, high = 10 * np.log10(np.percentile(error, [10, 50, 90]))
    return (
        f"difference beside greatx, relative to its power: median {middle:.1f} dB, 10 % below {low:.1f} dB, "
        f"10 % above {high:.1f} dB"
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("set", type=pathlib.Path, metavar="SET", help="folder of a set made by greatx")
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True, help="folder of the set")
    parser.add_argument("--scene", default="etoile", help="name in sionna.rt.scene (etoile)")
    parser.add_argument("--users", type=int, default=10**9, help="at most so many users (all)")
    parser.add_argument("--seed", type=int, default=42, help="of Sionna RT's rays (its own default, 42)")
    options = parser.parse_args()
    if (options.out / "set.json").exists():
        raise Error(f"{options.out}: expected no set there, found one")
    given = load(options.set)
    made = make(given, options.scene, options.users, options.seed)
    save(options.out, made)
    asked = made.facts["users"]
    print(
        f"{options.out}: {len(made)} users of {asked['asked']}; {asked['without_path']} have no path, "
        f"{asked['too_late']} get most of their power too late; {compare(given, made)}"
    )


if __name__ == "__main__":
    import os

    import sionna_setup

    if "DRJIT_LIBLLVM_PATH" not in os.environ and sionna_setup.find_llvm():
        os.environ["DRJIT_LIBLLVM_PATH"] = sionna_setup.find_llvm()
    try:
        main()
    except Error as error:
        sys.exit(f"error: {error}")
