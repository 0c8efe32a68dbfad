# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a scenario in the folder format of DeepMIMO 4, which `deepmimo.load` reads (docs/converters.md).

The amplitude of a path is that between upright isotropic antennas of vertical polarization at both ends,
    a = lambda/(4 pi) transfer[theta, theta] e^{-j 2 pi f_c tau},
independently of the channel's antennas, because DeepMIMO applies arrays and patterns itself. power is 20 lg
|a| (dBW for 0 dBW transmitted). phase is the angle of a in degrees at the carrier, for the time convention
e^{+j omega t}.
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import warnings
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np

from ..dataset import Dataset, Record, Sensor
from ..errors import DatasetError
from ..files import interpreting
from ..links import (
    DIFFRACTION,
    REFLECTION,
    SCATTERING,
    TARGET,
    SPEED_OF_LIGHT,
    TRANSMISSION,
    antenna_pose,
    paths_of,
    receivers,
    transmitters,
)
from .common import Command, channel_arguments, pick_channel, pick_sequence, save_npz, turns
from .folders import new_folder

#: The version of DeepMIMO whose format is written.
DEEPMIMO_VERSION = "4.0.5"
#: A tick becomes a snapshot in a subfolder of its own, or adds users to one static scenario.
LAYOUTS = ("snapshots", "users")
#: DeepMIMO's digits of our interactions.
DIGIT = {REFLECTION: 1, DIFFRACTION: 2, SCATTERING: 3, TRANSMISSION: 4, TARGET: 3}
_DIGITS = np.array([DIGIT.get(i, 0) for i in range(max(DIGIT) + 1)])
VACUUM_PERMITTIVITY = 8.8541878188e-12  # F/m, CODATA 2022
TX_SET, RX_SET = 0, 1

Point = Tuple[Record, int]  # a receiver at a record


def write_deepmimo(
    dataset: Dataset,
    out: Union[str, "os.PathLike[str]"],
    channel: Optional[str] = None,
    sequence: Optional[int] = None,
    layout: str = "snapshots",
) -> Dict[str, Any]:
    """Writes a channel of one sequence to the folder `out`, whose name becomes the scenario's name. Returns
    counts of the written objects.

    With the layout "snapshots", each tick is a snapshot; a single tick gives a static scenario. With "users",
    every receiver at every tick is a user of a static scenario, so the transmitters must not move. In
    addition to the files that DeepMIMO reads, writes doppler_*.npz in Hz (for `Dataset.set_doppler`), and the
    times of the snapshots under "greatx" in params.json. Leaves out and counts the paths whose vertical
    amplitude is 0. Raises DatasetError, or FileExistsError if the folder is not empty.
    """
    if layout not in LAYOUTS:
        raise ValueError(f"layout {layout!r}: expected one of {', '.join(LAYOUTS)}")
    name = pathlib.Path(os.path.abspath(out)).name
    if name != name.lower():
        raise DatasetError(f"{out}: DeepMIMO looks for scenarios by lower-case names; call it {name.lower()}")
    sensor = pick_channel(pick_sequence(dataset, sequence), channel)
    if len(sensor) == 0:
        raise DatasetError(f"{sensor.sequence.path / sensor.name}: has no records")
    records = list(sensor)
    ends = range(len(receivers(sensor)))
    if layout == "users":
        _check_transmitters_stand(sensor, records)
        snapshots: List[List[Point]] = [[(record, rx) for record in records for rx in ends]]
    else:
        snapshots = [[(record, rx) for rx in ends] for record in records]

    with interpreting(sensor.sequence.path / sensor.name):
        room = _Room(sensor, records)
        with new_folder(out) as root:
            return _write(root, sensor, snapshots, records, room, layout)


def _write(
    root: pathlib.Path,
    sensor: Sensor,
    snapshots: List[List[Point]],
    records: List[Record],
    room: "_Room",
    layout: str,
) -> Dict[str, Any]:
    active = np.zeros(len(snapshots[0]), bool)
    for number, points in enumerate(snapshots):
        folder = root if len(snapshots) == 1 else root / f"snapshot_{number:06d}"
        folder.mkdir(exist_ok=True)
        for tx in range(len(transmitters(sensor))):
            arrays = _arrays(points, tx, room)
            active |= ~np.isnan(arrays["power"][:, 0])
            for key, value in arrays.items():
                save_npz(folder / f"{key}_t{TX_SET:03}_tx{tx:03}_r{RX_SET:03}.npz", **{key: value})
        save_npz(folder / "vertices.npz", vertices=np.empty((0, 3), np.float32))
        (folder / "objects.json").write_text("[]\n")  # no objects, because a data set holds no geometry
    params = _params(sensor, records, len(snapshots), len(snapshots[0]), int(active.sum()), layout)
    (root / "params.json").write_text(json.dumps(params, indent=2) + "\n")
    return {
        "snapshots": len(snapshots),
        "transmitters": len(transmitters(sensor)),
        "receivers": len(snapshots[0]),
        "paths": room.written,
        "paths of no vertical amplitude left out": room.left_out,
    }


def _vertical_amplitude(sensor: Sensor, paths: Dict[str, np.ndarray]) -> np.ndarray:
    """Returns the amplitudes a (see the docstring of this file), complex128 [path]."""
    carrier = sensor.metadata["carrier_hz"]
    phase = np.exp(-2j * np.pi * turns(carrier, paths["delay"]))
    return SPEED_OF_LIGHT / carrier / (4 * np.pi) * paths["transfer"][:, 0, 0].astype(complex) * phase


class _Room:
    """Holds the extents of all arrays, the largest numbers of paths per link and of interactions per path,
    and the numbers of written and omitted paths.
    """

    def __init__(self, sensor: Sensor, records: List[Record]):
        self.paths, self.interactions, self.written, self.left_out = 1, 1, 0, 0
        links = len(receivers(sensor)), len(transmitters(sensor))
        for record in records:
            paths = paths_of(record)
            seen = paths["transfer"][:, 0, 0] != 0
            link = paths["rx"] * links[1] + paths.get("tx", 0)
            counts = np.bincount(link[seen], minlength=links[0] * links[1])
            self.paths = max(self.paths, int(counts.max(initial=0)))
            self.interactions = max(
                self.interactions, int(np.count_nonzero(paths["interaction"], axis=1).max(initial=0))
            )
            self.written += int(seen.sum())
            self.left_out += int((~seen).sum())


def _arrays(points: List[Point], tx: int, room: _Room) -> Dict[str, np.ndarray]:
    """Returns the arrays of one transmitter for N points, P paths and I interactions. Missing entries are
    NaN.
    """
    n, p, i = len(points), room.paths, room.interactions
    keys = ("power", "phase", "delay", "aoa_az", "aoa_el", "aod_az", "aod_el", "doppler")
    out = {key: np.full((n, p), np.nan, np.float32) for key in keys}
    # A float32 represents the digits of up to seven interactions exactly.
    out["inter"] = np.full((n, p), np.nan, np.float32 if i <= 7 else np.float64)
    out["inter_pos"] = np.full((n, p, i, 3), np.nan, np.float32)
    out["rx_pos"] = np.empty((n, 3), np.float32)
    for row, (record, rx) in enumerate(points):
        out["rx_pos"][row] = _position(record, receivers(record.sensor)[rx])
        link = _link(record, rx, tx)
        link["inter_pos"] = link["inter_pos"][:, :i]
        for key, value in link.items():
            out[key][row, : len(value)] = value
    out["tx_pos"] = _position(points[0][0], transmitters(points[0][0].sensor)[tx])[None].astype(np.float32)
    return out


def _link(record: Record, rx: int, tx: int) -> Dict[str, np.ndarray]:
    """Returns DeepMIMO's quantities of one link's paths, sorted from the strongest path on: [path], and
    inter_pos [path, depth, 3].
    """
    paths = paths_of(record, rx, tx)
    amplitude = _vertical_amplitude(record.sensor, paths)
    order = np.argsort(-np.abs(amplitude), kind="stable")
    order = order[amplitude[order] != 0]
    paths = {key: value[order] for key, value in paths.items()}
    amplitude = amplitude[order]
    digits = _DIGITS[paths["interaction"]]
    count = np.count_nonzero(digits, axis=1)
    weights = np.where(digits > 0, 10.0 ** (count[:, None] - 1 - np.arange(digits.shape[1])), 0)
    return {
        "power": 20 * np.log10(np.abs(amplitude)),
        "phase": np.degrees(np.angle(amplitude)),
        "delay": paths["delay"],
        "aoa_el": np.degrees(paths["arrival"][:, 0]),
        "aoa_az": np.degrees(paths["arrival"][:, 1]),
        "aod_el": np.degrees(paths["departure"][:, 0]),
        "aod_az": np.degrees(paths["departure"][:, 1]),
        "doppler": paths["doppler"],
        "inter": (digits * weights).sum(axis=1),
        "inter_pos": paths["vertex"],
    }


def _position(record: Record, antenna: Dict[str, Any]) -> np.ndarray:
    position = antenna_pose(record, antenna)[0]
    if np.abs(position).max() > 1e5:
        warnings.warn(
            f"{antenna['name']}: DeepMIMO's positions are 32-bit: {np.round(position)} m loses millimetres",
            stacklevel=4,
        )
    return position


def _check_transmitters_stand(sensor: Sensor, records: List[Record]) -> None:
    for antenna in transmitters(sensor):
        first = antenna_pose(records[0], antenna)[0]
        for record in records:
            if np.abs(antenna_pose(record, antenna)[0] - first).max() > 1e-6:
                raise DatasetError(
                    f"{sensor.sequence.dataset.path}: {antenna['name']} moves, which ticks as users of one "
                    "static scenario cannot say; use the layout 'snapshots'"
                )


def _params(
    sensor: Sensor, records: List[Record], snapshots: int, users: int, active: int, layout: str
) -> Dict[str, Any]:
    dataset, meta = sensor.sequence.dataset, sensor.metadata
    effects, depth = dataset.run.get("effects", {}), meta["max_depth"]
    rt = {
        "raytracer_name": "greatx",
        "raytracer_version": dataset.run["greatx"],
        "frequency": meta["carrier_hz"],
        "max_path_depth": depth,
        "max_reflections": depth,
        "max_diffractions": int(effects.get("diffraction", False)),
        "max_scattering": int(effects.get("scattering", False)),
        "max_transmissions": depth if effects.get("transmission", False) else 0,
        "diffuse_reflections": 0,
        "diffuse_diffractions": 0,
        "diffuse_transmissions": 0,
        "diffuse_final_interaction_only": False,
        "diffuse_random_phases": False,
        "terrain_reflection": True,
        "terrain_diffraction": False,
        "terrain_scattering": False,
        "num_rays": 0,
        "ray_casting_method": "none",
        "synthetic_array": True,
        "ray_casting_range_az": 360.0,
        "ray_casting_range_el": 180.0,
        "gps_bbox": [0, 0, 0, 0],
        "raw_params": meta,
    }
    sets = {}
    for number, points, is_tx in ((TX_SET, len(transmitters(sensor)), True), (RX_SET, users, False)):
        sets[f"txrx_set_{number}"] = {
            "name": "transmitters" if is_tx else "receivers",
            "id_orig": number,
            "id": number,
            "is_tx": is_tx,
            "is_rx": not is_tx,
            "num_points": points,
            "num_active_points": points if is_tx else active,
            "num_ant": 1,
            "dual_pol": False,
            "ant_rel_positions": [[0, 0, 0]],
            "array_orientation": [0, 0, 0],
            "grid_spacing": None,
        }
    scene = {
        "num_scenes": snapshots,
        "n_objects": 0,
        "n_vertices": 0,
        "n_faces": 0,
        "n_triangular_faces": 0,
        "representation": "hull",
    }
    return {
        "version": DEEPMIMO_VERSION,
        "rt_params": rt,
        "txrx_sets": sets,
        "materials": _materials(meta),
        "scene": scene,
        "greatx": {
            "layout": layout,
            "times_s": [record.time_s for record in records],
            "ticks": [record.tick for record in records],
        },
    }


def _materials(meta: Dict[str, Any]) -> Dict[str, Any]:
    """Returns the outermost layer of each wall beside its windows. rt_params.raw_params holds all layers and
    the windows."""
    materials = {}
    for wall in meta["walls"]:
        if not wall["layers"]:
            continue
        real, imaginary = wall["layers"][0]["relative_permittivity"]
        number = len(materials)
        materials[f"material_{number}"] = {
            "id": number,
            "name": wall["material"],
            "permittivity": real,
            "conductivity": -imaginary * 2 * np.pi * meta["carrier_hz"] * VACUUM_PERMITTIVITY,
            "thickness": wall["layers"][0]["thickness_m"],
        }
    return materials


def _arguments(parser: argparse.ArgumentParser) -> None:
    channel_arguments(parser, "needed if there are several")
    parser.add_argument(
        "--layout",
        choices=LAYOUTS,
        default=LAYOUTS[0],
        help="ticks as snapshots of a dynamic scenario, or as users of a static one (default: %(default)s)",
    )


COMMAND = Command(
    "deepmimo",
    "a scenario that DeepMIMO 4 loads",
    lambda dataset, given: write_deepmimo(dataset, given.OUT, given.channel, given.sequence, given.layout),
    _arguments,
)
