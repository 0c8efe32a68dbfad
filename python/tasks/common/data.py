# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What tasks ask of data sets and campaigns: their sequences with the parts of a split, and what they are."""
from __future__ import annotations

import hashlib
from typing import Iterator, NamedTuple, Optional, Union

import greatx
from greatx.campaign import SPLITS
from greatx.errors import Error

Opened = Union[greatx.Dataset, greatx.Campaign]
#: The parts of a split: train, validation, test.
PARTS = SPLITS


class Part(NamedTuple):
    """A sequence, and where it belongs."""

    cell: str  #: empty for a data set that is no campaign
    dataset: greatx.Dataset
    index: int  #: in dataset.sequences
    part: Optional[str]  #: one of PARTS by a campaign's own split; None for a data set


def sequences_of(opened: Opened) -> Iterator[Part]:
    """Yields the sequences of a data set, or those of a campaign that are in a part, in order of cell and
    sequence.
    """
    if not isinstance(opened, greatx.Campaign):
        yield from (Part("", opened, i, None) for i in range(len(opened.sequences)))
        return
    for cell in opened.cells:
        part = {number: name for name in PARTS for number in opened.sequences(cell, name)}
        for index, sequence in enumerate(opened[cell].sequences):
            if sequence.number in part:
                yield Part(cell, opened[cell], index, part[sequence.number])


def fingerprint(dataset: greatx.Dataset) -> str:
    """Returns a hash of a data set's contents: that of its manifest, or of its description if it is not
    finished. Raises Error if it has neither.
    """
    for name in ("manifest.json", "dataset.json"):
        path = dataset.path / name
        if path.is_file():
            return hashlib.sha256(path.read_bytes()).hexdigest()
    raise Error(f"{dataset.path}: expected a data set, found no dataset.json")
