# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Functions that both converters use."""
from __future__ import annotations

import os
import pathlib
from typing import Optional, Union

import numpy as np

from ..dataset import Dataset, Sensor, Sequence
from ..errors import DatasetError


def pick_sequence(dataset: Dataset, number: Optional[int]) -> Sequence:
    """Returns the sequence of this number; None stands for the only one. Raises DatasetError if there is
    none.
    """
    if number is None:
        if len(dataset.sequences) != 1:
            raise DatasetError(
                f"{dataset.path}: has {len(dataset.sequences)} sequences: say which one (--sequence)"
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
    channels = [s for s in sequence.sensors.values() if s.kind == "csi"]
    names = ", ".join(s.name for s in channels) or "none"
    for channel in channels:
        if channel.name == name or (name is None and len(channels) == 1):
            return channel
    what = (
        f"no channel {name!r}" if name is not None else "several channels or none: say which one (--channel)"
    )
    raise DatasetError(f"{sequence.dataset.path}: has {what}; channels: {names}")


def make_folder(out: Union[str, "os.PathLike[str]"]) -> pathlib.Path:
    """Creates a folder, or accepts an empty one. Raises FileExistsError if the folder is not empty."""
    path = pathlib.Path(out)
    path.mkdir(parents=True, exist_ok=True)
    if any(path.iterdir()):
        raise FileExistsError(f"{path}: is not empty; nothing is overwritten")
    return path


def turns(frequency_hz: float, delay_s: np.ndarray) -> np.ndarray:
    """Returns the fractional part of f tau, [0, 1), so that the argument of the exponential is small."""
    return np.mod(frequency_hz * np.asarray(delay_s, np.float64), 1.0)
