# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""greatx from Python.

`greatx.load(DIR)` opens a generated data set with nothing but NumPy (docs/python.md); `greatx.convert` writes it in the
conventions of other tools. What computes (scenes, paths, channels) is the compiled module greatx._native, which is
imported when one of its names is first used.
"""
from __future__ import annotations

from typing import Any

from .arrays import Frames, Ragged
from .dataset import Dataset, Record, Sensor, Sequence, Tick, load
from .errors import DatasetError
from .samples import Samples

__version__ = "0.1.0"
__all__ = ["Dataset", "DatasetError", "Frames", "Ragged", "Record", "Samples", "Sensor", "Sequence", "Tick", "load"]

#: What greatx._native offers under the package's name.
NATIVE: tuple = ()


def __getattr__(name: str) -> Any:
    if name not in NATIVE:
        raise AttributeError(f"module 'greatx' has no attribute {name!r}")
    try:
        from . import _native
    except ImportError as error:
        raise ImportError(f"greatx.{name} needs the compiled module greatx._native, which is not here: {error}. Build it "
                          "with `pip install ./python` in the project's folder (docs/python.md)") from error
    return getattr(_native, name)


def __dir__() -> list:
    return sorted({*globals(), *NATIVE})
