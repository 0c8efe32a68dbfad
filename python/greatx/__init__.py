# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The Python package of greatx (docs/python.md).

`greatx.load(DIR)` opens a generated data set, or a campaign of them, and needs only NumPy. `greatx.convert`
writes a data set in the conventions of other tools. `greatx.Simulation` computes scenes, paths and channels.
It needs the compiled module greatx._native, which is imported when `Simulation` is first used.
"""

from __future__ import annotations

from typing import Any

from . import geodesy
from .antenna import Array
from .arrays import Frames, Ragged
from .batch_reader import batches
from .campaign import Campaign, campaign
from .campaign_samples import CampaignSamples, ShuffledSamples
from .dataset import Dataset, Record, Sensor, Sequence, Tick
from .errors import DatasetError, Error, print_errors_plainly
from .events import Events
from .loading import load
from .packed import PackedRagged, PackedStack, PackedTable
from .paths import Paths
from .radio_map import RadioMap
from .run import Run
from .samples import Samples
from .streaming import Stream, stream
from .tables import Arrays

__version__ = "0.1.0"
__all__ = [
    "Array",
    "Arrays",
    "Campaign",
    "CampaignSamples",
    "Dataset",
    "DatasetError",
    "Error",
    "Events",
    "Frames",
    "PackedRagged",
    "PackedStack",
    "PackedTable",
    "Paths",
    "RadioMap",
    "Ragged",
    "Record",
    "Run",
    "Samples",
    "Sensor",
    "Sequence",
    "ShuffledSamples",
    "Stream",
    "Tick",
    "batches",
    "campaign",
    "geodesy",
    "load",
    "print_errors_plainly",
    "stream",
]

#: Names that need greatx._native.
NATIVE = ("Simulation",)


def __getattr__(name: str) -> Any:
    if name not in NATIVE:
        raise AttributeError(f"module 'greatx' has no attribute {name!r}")
    try:
        from . import simulation
    except ImportError as error:
        raise ImportError(
            f"greatx.{name} needs the compiled module greatx._native, which is not here: {error}. Build it "
            "with ./run.sh and set PYTHONPATH=build/release/python, or `pip install ./python` in the "
            "project's folder, or install a wheel for this version of Python (docs/install.md)"
        ) from error
    return getattr(simulation, name)


def __dir__() -> list:
    return sorted({*globals(), *NATIVE})
