# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Writes PNG (ISO/IEC 15948) with zlib only: grey and RGB of 8 or 16 bits, filter Up in every line."""

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


def encode_png(picture: np.ndarray) -> bytes:
    """Returns the PNG of uint8 or uint16 [h, w] (grey) or [h, w, 3] (RGB), all of which is in memory. Raises
    ValueError for other arrays."""
    channels = 1 if picture.ndim == 2 else picture.shape[-1] if picture.ndim == 3 else 0
    if picture.dtype not in (np.uint8, np.uint16) or channels not in (1, 3) or 0 in picture.shape:
        raise ValueError(
            f"expected uint8 or uint16 [h, w] or [h, w, 3], found {picture.dtype} {picture.shape}"
        )
    height, width = picture.shape[:2]
    lines = np.ascontiguousarray(picture.astype(picture.dtype.newbyteorder(">"))).view(np.uint8)
    lines = lines.reshape(height, -1)
    filtered = np.full((height, 1 + lines.shape[1]), 2, np.uint8)
    filtered[:, 1:] = lines
    filtered[1:, 1:] -= lines[:-1]
    colour = {1: 0, 3: 2}[channels]
    header = struct.pack(">IIBBBBB", width, height, 8 * picture.dtype.itemsize, colour, 0, 0, 0)
    data = zlib.compress(filtered.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")
