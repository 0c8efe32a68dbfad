# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What both converters need."""
from __future__ import annotations

import os
import pathlib
from typing import Optional, Union

import numpy as np

from ..dataset import Dataset, Sensor, Sequence
from ..errors import DatasetError


def pick_sequence(dataset: Dataset, number: Optional[int]) -> Sequence:
    """The sequence of this number; None: the only one."""
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
        f"{dataset.path}: has no sequence {number}; it has {', '.join(str(s.number) for s in dataset.sequences)}"
    )


def pick_channel(sequence: Sequence, name: Optional[str]) -> Sensor:
    """The channel of this name; None: the only one."""
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
    """A folder that was not there or is empty."""
    path = pathlib.Path(out)
    path.mkdir(parents=True, exist_ok=True)
    if any(path.iterdir()):
        raise FileExistsError(f"{path}: is not empty; nothing is overwritten")
    return path


def turns(frequency_hz: float, delay_s: np.ndarray) -> np.ndarray:
    """f tau without its whole turns, [0, 1): so that the exponential meets small numbers."""
    return np.mod(frequency_hz * np.asarray(delay_s, np.float64), 1.0)
