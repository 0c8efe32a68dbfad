# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes PNG (ISO/IEC 15948) with zlib only: 8-bit grey and 8-bit RGB, with the filter Up in every line."""

from __future__ import annotations

import pathlib
import struct
import zlib
from typing import Iterable

import numpy as np


def _chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def write_png(
    path: pathlib.Path, width: int, height: int, channels: int, lines: Iterable[np.ndarray]
) -> None:
    """Writes `height` lines of uint8 [width * channels], which are not kept in memory. There are 1 (grey) or
    3 (RGB) channels."""
    packer = zlib.compressobj(6)
    before = np.zeros(width * channels, np.uint8)
    with open(path, "wb") as file:
        header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2}[channels], 0, 0, 0)
        file.write(b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header))
        for line in lines:
            packed = packer.compress(b"\x02" + (line - before).astype(np.uint8).tobytes())
            before = line
            if packed:
                file.write(_chunk(b"IDAT", packed))
        file.write(_chunk(b"IDAT", packer.flush()) + _chunk(b"IEND", b""))


def write_rgb(path: pathlib.Path, pixels: np.ndarray) -> None:
    """Writes uint8 [h, w, 3]."""
    height, width, _ = pixels.shape
    write_png(path, width, height, 3, (line.reshape(-1) for line in pixels))
