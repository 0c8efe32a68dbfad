# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes files whole or not at all."""
from __future__ import annotations

import os
import pathlib
from typing import Any, Callable

import numpy as np


def write_whole(path: pathlib.Path, write: Callable[[pathlib.Path], Any]) -> None:
    """Lets `write` make a file beside `path`, and gives it its name when it is complete."""
    part = path.with_name(f"{path.stem}.part{path.suffix}")
    write(part)
    os.replace(part, path)


def write_text(path: pathlib.Path, text: str) -> None:
    """Writes a text file."""
    write_whole(path, lambda part: part.write_text(text))


def write_array(path: pathlib.Path, array: np.ndarray) -> None:
    """Writes an array as a .npy file."""
    write_whole(path, lambda part: np.save(part, array))


def write_torch(path: pathlib.Path, value: Any) -> None:
    """Writes what torch.save takes."""
    import torch

    write_whole(path, lambda part: torch.save(value, part))
