# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Codes masks as COCO's compressed run lengths.

A mask is read column by column. Its runs of zeros and ones alternate, beginning with zeros (perhaps none).
From the fourth run on, the difference from the run two before is kept. Each number is cut into groups of five
bits, least first, in two's complement; a sixth bit says that another group follows; 48 is added, which makes
a letter. (Format: common/maskApi.c of cocoapi, rleToString.)
"""

from __future__ import annotations

import numpy as np


def run_lengths(mask: np.ndarray) -> np.ndarray:
    """Returns the lengths of the runs of a mask [h, w], int64 [n]."""
    flat = np.asarray(mask, bool).T.reshape(-1)
    ends = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    edges = np.concatenate([[0], ends, [len(flat)]])
    counts = np.diff(edges)
    return np.concatenate([[0], counts]) if len(flat) and flat[0] else counts


def pack(counts: np.ndarray) -> str:
    """Returns the letters of run lengths."""
    values = np.array(counts, np.int64)
    values[3:] -= np.asarray(counts, np.int64)[1:-2]
    letters, there = [], []
    more = np.ones(len(values), bool)
    while more.any():
        group = values & 31
        values >>= 5
        there.append(more)
        last = np.where(group & 16, values == -1, values == 0)
        letters.append(group + np.where(last, 0, 32) + 48)
        more = more & ~last
    table, valid = np.stack(letters, 1), np.stack(there, 1)
    return table[valid].astype(np.uint8).tobytes().decode("ascii")


def encode(mask: np.ndarray) -> dict:
    """Returns the segmentation of a mask [h, w] as COCO's JSON has it."""
    height, width = mask.shape
    return {"size": [height, width], "counts": pack(run_lengths(mask))}


def decode(segmentation: dict) -> np.ndarray:
    """Returns the mask [h, w], bool, of a segmentation: the inverse of encode()."""
    height, width = segmentation["size"]
    counts, value, shift = [], 0, 0
    for letter in segmentation["counts"].encode("ascii"):
        group = letter - 48
        value |= (group & 31) << shift
        shift += 5
        if not group & 32:
            if group & 16:
                value -= 1 << shift
            counts.append(value + (counts[-2] if len(counts) > 2 else 0))
            value, shift = 0, 0
    ones = np.arange(len(counts)) % 2 == 1
    return np.repeat(ones, counts).reshape(width, height).T
