# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a folder: a data set, or a campaign of many data sets."""

from __future__ import annotations

import os
import pathlib
from typing import Any, Union

from .campaign import CELLS, SPLITS_FILE, Campaign
from .dataset import Dataset


def load(folder: Union[str, "os.PathLike[str]"], incomplete: bool = False) -> Any:
    """Opens the data set in `folder` without reading its arrays, and returns a Dataset. If the folder holds a
    campaign, returns a Campaign, which opens its data sets when they are used.

    A data set without manifest.json is unfinished: a run is writing it, or was stopped (`greatx generate
    --resume` finishes it). Raises DatasetError for such a data set unless `incomplete` is set; then gives a
    warning, and opens the sequences that are whole and what is written of the next one. The run may go on
    meanwhile: the data set holds what was written when it was loaded. Raises DatasetError, whose message
    names the file, for everything that does not follow docs/dataset.md.
    """
    path = pathlib.Path(folder)
    if not (path / "dataset.json").exists() and any((path / name).exists() for name in (SPLITS_FILE, CELLS)):
        return Campaign(folder, incomplete=incomplete)
    return Dataset(folder, incomplete)
