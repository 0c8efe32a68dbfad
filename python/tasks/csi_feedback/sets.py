# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Channel sets: folders of channels over angle and delay of many users, with what they are.

A folder has four files:

channels.npy    complex64 [n, angle, delay]: X of transforms.py, with absolute delays and gains
position_m.npy  float64 [n, 3]: x, y, z of the user, m
outside.npy     float32 [n]: share of the power of H that lies in bins of delay beyond those kept
set.json        what the set is: "format", "format_version", "name", "subcarriers", "bandwidth_hz",
                "carrier_hz", "users" (drawn, without a path, kept, ...), and whatever the maker knows of the
                scene, the antennas, the models and the programs

Users without a path have no matrix and are left out; set.json counts them.

This module needs NumPy alone, so that an environment with Sionna RT and without torch can use it.
"""
from __future__ import annotations

import dataclasses
import json
import pathlib
from typing import Any, Dict

import numpy as np

from greatx.errors import Error

from ..common.files import write_array, write_text

FORMAT = "greatx-csi-set"
VERSION = 1

#: Fields of set.json that every set has, and their types.
_FIELDS = {"name": str, "subcarriers": int, "bandwidth_hz": (int, float), "carrier_hz": (int, float)}


class SetError(Error):
    """Reports a folder that is no channel set: FILE: what was expected, and what was found."""


@dataclasses.dataclass
class ChannelSet:
    """Holds the channels of many users."""

    channels: np.ndarray  #: complex64 [n, angle, delay]
    position_m: np.ndarray  #: float64 [n, 3]
    outside: np.ndarray  #: float32 [n]
    facts: Dict[str, Any]  #: of set.json

    @property
    def name(self) -> str:
        return self.facts["name"]

    def __len__(self) -> int:
        return len(self.channels)

    def part(self, items: np.ndarray) -> "ChannelSet":
        """Returns the set of some of the users."""
        return ChannelSet(self.channels[items], self.position_m[items], self.outside[items], self.facts)


def save(folder: pathlib.Path, channels: ChannelSet) -> None:
    """Writes a channel set. set.json comes last, so that a folder with it is whole."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, dtype in (("channels", np.complex64), ("position_m", np.float64), ("outside", np.float32)):
        write_array(folder / f"{name}.npy", getattr(channels, name).astype(dtype))
    facts = {"format": FORMAT, "format_version": VERSION, **channels.facts}
    write_text(folder / "set.json", json.dumps(facts, indent=1) + "\n")


def load(folder: pathlib.Path) -> ChannelSet:
    """Reads a channel set. Raises SetError for anything else."""
    facts = _facts(folder / "set.json")
    channels = _array(folder / "channels.npy", np.complex64, 3)
    position = _array(folder / "position_m.npy", np.float64, 2)
    outside = _array(folder / "outside.npy", np.float32, 1)
    for name, array, shape in (
        ("position_m.npy", position, (len(channels), 3)),
        ("outside.npy", outside, (len(channels),)),
    ):
        if array.shape != shape:
            raise SetError(
                f"{folder / name}: expected {list(shape)}, as many users as in channels.npy, "
                f"found {list(array.shape)}"
            )
    finite = np.isfinite(channels).all((1, 2)) & channels.any((1, 2))
    if not finite.all():
        raise SetError(
            f"{folder / 'channels.npy'}: expected finite channels with power, found another in "
            f"number {int(np.argmin(finite))}"
        )
    return ChannelSet(channels, position, outside, facts)


def _facts(path: pathlib.Path) -> Dict[str, Any]:
    try:
        facts = json.loads(path.read_text())
    except OSError as error:
        raise SetError(f"{path}: {error.strerror}: expected a channel set") from None
    except ValueError as error:
        raise SetError(f"{path}: is no JSON: {error}") from None
    if not isinstance(facts, dict) or facts.get("format") != FORMAT:
        found = facts.get("format") if isinstance(facts, dict) else facts
        raise SetError(f"{path}: format: expected {FORMAT!r}, found {found!r}")
    if facts.get("format_version") != VERSION:
        raise SetError(f"{path}: format_version: expected {VERSION}, found {facts.get('format_version')!r}")
    for name, kind in _FIELDS.items():
        if not isinstance(facts.get(name), kind) or isinstance(facts.get(name), bool):
            raise SetError(
                f"{path}: {name}: expected a {'text' if kind is str else 'number'}, found {facts.get(name)!r}"
            )
    return facts


def _array(path: pathlib.Path, dtype: type, dimensions: int) -> np.ndarray:
    try:
        array = np.load(path, allow_pickle=False)
    except OSError as error:
        raise SetError(f"{path}: {error.strerror or error}: expected an array") from None
    except ValueError as error:
        raise SetError(f"{path}: is no array: {error}") from None
    if array.dtype != dtype or array.ndim != dimensions or array.size == 0:
        raise SetError(
            f"{path}: expected {np.dtype(dtype).name} of {dimensions} dimensions and at least one user, "
            f"found {array.dtype.name} {list(array.shape)}"
        )
    return array
