#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a set of channels over angle and delay by greatx: many users of a scene, drawn by a seed.

    python3 python/tasks/csi_feedback/make.py city -o out/csi/city --users 20000
    python3 python/tasks/csi_feedback/make.py etoile -o out/csi/etoile --users 6000 --scene etoile.glb \\
        --radio-materials assets/examples/etoile_radio.yaml

DOMAIN is a file of domains/ without ".yaml". It needs greatx's compiled module (docs/python.md)."""
from __future__ import annotations

import argparse
import hashlib
import logging
import pathlib
import sys
import time
import warnings
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np

if __package__ in (None, ""):
    # Behind PYTHONPATH, which names the folder of the greatx that has the compiled module.
    sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))
    __package__ = "tasks.csi_feedback"

import greatx
from greatx.errors import Error

from ..common.config import load_config
from .domain import FOLDER, Domain, counts, facts
from .sets import ChannelSet, save
from .transforms import angular_delay

#: Users that are solved at once: their responses take 64 MiB.
BATCH = 256


def simulation(domain: Domain, site: Tuple[float, float, float, float]) -> "greatx.Simulation":
    """Returns a simulation of the domain's scene with one of its base stations and a channel "csi"."""
    if domain.generate is not None:
        scene: Dict[str, Any] = {"generate": vars(domain.generate)}
    elif domain.scene is not None:
        scene = {"file": str(pathlib.Path(domain.scene).resolve())}
    else:
        raise Error(f"{domain.name}: expected a scene (--scene FILE.glb), found none")
    if domain.radio_materials is not None:
        scene["radio_materials"] = str(pathlib.Path(domain.radio_materials).resolve())
    effects = {name: "on" if on else "off" for name, on in domain.effects.items()}
    sim = greatx.Simulation({"greatx": 1, "name": "csi", "ticks": 1, "scene": scene, "effects": effects})
    *position, yaw = site
    array = greatx.Array(columns=domain.ports)
    sim.place_transmitter("bs", position, array=array, orientation_deg=[yaw, 0, 0])
    sim.add_channel(
        "csi",
        carrier_hz=domain.carrier_hz,
        bandwidth_hz=domain.bandwidth_hz,
        subcarriers=domain.subcarriers,
        max_depth=domain.max_depth,
        max_transmissions=domain.max_transmissions,
    )
    return sim


def responses(sim: "greatx.Simulation", points: np.ndarray) -> np.ndarray:
    """Returns H of points [n, 3], complex64 [n, port, subcarrier], zero without a path."""
    with warnings.catch_warnings():
        # A user within the array's far-field distance gets one path for the whole array; docs/learning.md.
        warnings.filterwarnings("ignore", message=".*nearer than the far field.*")
        return sim.paths("csi", receivers=points).cfr()[:, 0, 0, :, 0, :]


#: Matrices, positions and shares outside of the users of a batch, how many places were looked at, and how
#: many users were left out because their power arrives too late.
Batch = Tuple[np.ndarray, np.ndarray, np.ndarray, int, int]


def served(domain: Domain, sim: "greatx.Simulation", count: int, seed: List[int]) -> Iterator[Batch]:
    """Yields users with a path whose power lies in the kept bins, batch by batch; a batch may be empty. Ends
    with the batch that completes `count` of them. Raises Error if hardly any place has such a user.
    """
    generator = np.random.default_rng(seed)
    found = drawn = 0
    while found < count:
        points = domain.draw(BATCH, generator)
        response = responses(sim, points)
        lit = np.flatnonzero(response.any((1, 2)))
        matrices, outside = np.zeros((0, domain.ports, domain.delays), np.complex64), np.zeros(0, np.float32)
        if len(lit):
            matrices, outside = angular_delay(response[lit], domain.delays)
        good = np.flatnonzero(outside <= domain.most_outside)[: count - found]
        found += len(good)
        # The places behind the last user that is needed do not count.
        last = BATCH - 1 if found < count else int(lit[good[-1]])
        drawn += last + 1
        if drawn > 100 * (found + BATCH):
            raise Error(f"{domain.name}: of {drawn} places, {found} have a user: expected more than 1 %")
        late = int(np.sum(lit <= last)) - len(good)
        yield matrices[good], points[lit[good]], outside[good], last + 1, late


def make(domain: Domain, users: int, seed: int, report=print) -> ChannelSet:
    """Returns the channels of `users` users of a domain, in equal parts from its base stations, one after
    the other (set.json: users.of_site). The result follows from the arguments alone."""
    if users < len(domain.sites):
        raise Error(f"--users: expected at least one for each base station, found {users}")
    parts: List[Batch] = []
    began = time.perf_counter()
    done = 0
    sim: Optional["greatx.Simulation"] = None
    of_site = counts(users, len(domain.sites))
    for number, (site, count) in enumerate(zip(domain.sites, of_site)):
        sim = simulation(domain, site)
        for batch in served(domain, sim, count, [seed, number]):
            parts.append(batch)
            done += len(batch[0])
            left = (time.perf_counter() - began) * (users - done) / max(done, 1)
            report(f"{domain.name}: {done} of {users} users, {left:.0f} s left")
    channels, position, outside = (np.concatenate(part) for part in list(zip(*parts))[:3])
    drawn, late = (sum(part[k] for part in parts) for k in (3, 4))
    left_out = {"without_path": drawn - late - users, "too_late": late}
    counted = {"seed": seed, "drawn": drawn, **left_out, "of_site": of_site}
    described = facts(domain, counted, outside, f"greatx {greatx.__version__}")
    described["scene"] = _scene(domain, sim)
    described["effects"] = sorted(name for name, effect in sim.effects.items() if effect.on)
    return ChannelSet(channels, position, outside, described)


def _scene(domain: Domain, sim: "greatx.Simulation") -> Dict[str, Any]:
    out: Dict[str, Any] = {"sha256": sim.scene["sha256"]}
    if domain.generate is not None:
        out["generate"] = vars(domain.generate)
    else:
        out["file"] = pathlib.Path(domain.scene).name
    if domain.radio_materials is not None:
        path = pathlib.Path(domain.radio_materials)
        out["radio_materials"] = path.name
        out["radio_materials_sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    return out


def progress(text: str) -> None:
    """Shows a line over the last one on a terminal, and nothing elsewhere."""
    if sys.stderr.isatty():
        print(f"\r{text:<100}", end="", file=sys.stderr, flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    names = sorted(path.stem for path in FOLDER.glob("*.yaml") if path.stem not in _NO_DOMAINS)
    parser.add_argument("domain", choices=names, metavar="DOMAIN", help=f"one of {', '.join(names)}")
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True, help="folder of the set")
    parser.add_argument("--users", type=int, required=True, help="users with a path")
    parser.add_argument("--seed", type=int, default=1, help="of the places (1)")
    parser.add_argument("--scene", help="a glTF file")
    parser.add_argument("--radio-materials", help="a YAML file with the radio properties of its materials")
    parser.add_argument("--set", action="append", default=[], metavar="FIELD=VALUE", dest="sets")
    options = parser.parse_args()
    given = {"scene": options.scene, "radio_materials": options.radio_materials}
    sets = [f"{name}={value}" for name, value in given.items() if value is not None]
    domain = load_config(Domain, FOLDER, options.domain, sets + options.sets)
    if (options.out / "set.json").exists():
        raise Error(f"{options.out}: expected no set there, found one")
    # Places inside of buildings are warned of batch by batch. set.json counts all places without a path.
    logging.getLogger("greatx").setLevel(logging.ERROR)
    channels = make(domain, options.users, options.seed, progress)
    save(options.out, channels)
    users, outside = channels.facts["users"], channels.facts["power_outside"]
    print(
        f"{options.out}: {len(channels)} users of {users['drawn']} places; {users['without_path']} have no "
        f"path, {users['too_late']} get most of their power too late; {100 * outside['mean']:.2f} % of the "
        f"power lies beyond the bins (95th percentile {100 * outside['p95']:.2f} %)"
    )


#: Files of domains/ that are no domains by themselves.
_NO_DOMAINS = ("config", "etoile_materials")

if __name__ == "__main__":
    from tasks.common.command import main as run

    run(main)
