# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Functions that the converters use, and the description of a converter as a command.

Each converter is a module or a package of this folder with a Command, which catalogue.py lists. Data flow one
way: a converter reads a Dataset, turns its axes and units by common functions, and writes a new folder or
file. Optional packages (h5py, mcap, ...) are imported by `run`, so that NumPy remains the only package that
every converter needs.
"""

from __future__ import annotations

import argparse
import dataclasses
import io
import pathlib
from typing import Any, Callable, Dict, Optional

import numpy as np

from ..dataset import Dataset, Sensor, Sequence
from ..errors import DatasetError, nearest


@dataclasses.dataclass(frozen=True)
class Command:
    """Describes a converter for `python3 -m greatx.convert NAME DIR OUT ...`."""

    name: str
    help: str  #: half a sentence: what OUT becomes
    #: converts the data set; gets DIR's data set and all arguments, and returns counts for the last line
    run: Callable[[Dataset, argparse.Namespace], Dict[str, Any]]
    #: adds the arguments beside DIR and OUT
    arguments: Callable[[argparse.ArgumentParser], None] = lambda parser: None
    out_help: str = "folder to make; it must not exist or be empty"


def channel_arguments(parser: argparse.ArgumentParser, sequence_default: str) -> None:
    """Adds --channel and --sequence. `sequence_default` says which sequence is taken without --sequence."""
    parser.add_argument("--channel", help="name of the channel; needed if there are several")
    parser.add_argument("--sequence", type=int, help=f"number of the sequence; {sequence_default}")


def sequence_argument(parser: argparse.ArgumentParser) -> None:
    """Adds --sequence of a converter that writes all sequences by default."""
    parser.add_argument("--sequence", type=int, help="number of the only sequence to write; default: all")


def link_argument(parser: argparse.ArgumentParser) -> None:
    """Adds --link of a converter that copies pictures (folders.place)."""
    parser.add_argument(
        "--link", action="store_true", help="make hard links to pictures where possible instead of copies"
    )


def pick_sequence(dataset: Dataset, number: Optional[int]) -> Sequence:
    """Returns the sequence of this number; None stands for the only one. Raises DatasetError if there is
    none.
    """
    if number is None:
        if len(dataset.sequences) != 1:
            raise DatasetError(
                f"{dataset.path}: has {len(dataset.sequences)} sequences: say which one (--sequence 0)"
            )
        return dataset.sequences[0]
    for sequence in dataset.sequences:
        if sequence.number == number:
            return sequence
    raise DatasetError(
        f"{dataset.path}: has no sequence {number}; it has "
        f"{', '.join(str(s.number) for s in dataset.sequences)}"
    )


def pick_channel(sequence: Sequence, name: Optional[str]) -> Sensor:
    """Returns the channel of this name; None stands for the only one. Raises DatasetError if there is
    none.
    """
    channels = {s.name: s for s in sequence.sensors.values() if s.kind == "csi"}
    if not channels:
        raise DatasetError(
            f"{sequence.dataset.path}: expected a channel, found none; the scenario needs a channel with "
            "outputs: [cfr, paths]"
        )
    if name is None:
        if len(channels) > 1:
            raise DatasetError(
                f"{sequence.dataset.path}: has the channels {', '.join(channels)}: say which one (--channel)"
            )
        return next(iter(channels.values()))
    if name not in channels:
        raise DatasetError(
            f"{sequence.dataset.path}: has no channel {name!r}{nearest(name, channels)}; channels: "
            f"{', '.join(channels)}"
        )
    return channels[name]


def save_npz(file: pathlib.Path, **arrays: Any) -> None:
    """Writes arrays to a compressed .npz. They are compressed in memory first, because a ZipFile that cannot
    write fails a second time when it is removed, and prints that.
    """
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    file.write_bytes(buffer.getbuffer())


def turns(frequency_hz: float, delay_s: np.ndarray) -> np.ndarray:
    """Returns the fractional part of f tau, [0, 1), so that the argument of the exponential is small."""
    return np.mod(frequency_hz * np.asarray(delay_s, np.float64), 1.0)
