# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Takes batches out of the inputs of networks that a task keeps as memory-mapped arrays.

Pictures are kept as uint8, everything else as float16.
"""
from __future__ import annotations

import numpy as np
import torch

#: Intensities of a LiDAR beyond this are glare (docs/lidar.md), and are cut off.
GLARE = 2.0


def tensor(array: np.ndarray, rows: np.ndarray) -> torch.Tensor:
    """Returns some rows of an array, float32; uint8 from 0 to 1."""
    order = np.argsort(rows)  # a memory map is read in order
    value = np.asarray(array[rows[order]])[np.argsort(order)]
    scale = np.float32(1 / 255 if value.dtype == np.uint8 else 1)
    return torch.from_numpy(value.astype(np.float32) * scale)
