# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Encodes pictures as PNG (ISO/IEC 15948) with zlib alone."""

from __future__ import annotations

import struct
import zlib

import numpy as np

_COLOUR = {1: 0, 3: 2}  # channels: colour type


def encode_png(picture: np.ndarray) -> bytes:
    """Returns a PNG of uint8 or uint16 [h, w] (grey) or [h, w, 3] (RGB). Every line has the filter Up, which
    all decoders know and greatx itself writes. Raises ValueError for other arrays."""
    channels = 1 if picture.ndim == 2 else picture.shape[-1] if picture.ndim == 3 else 0
    if picture.dtype not in (np.uint8, np.uint16) or channels not in _COLOUR or 0 in picture.shape:
        raise ValueError(
            f"expected uint8 or uint16 [h, w] or [h, w, 3], found {picture.dtype} {picture.shape}"
        )
    height, width = picture.shape[:2]
    lines = np.ascontiguousarray(picture.astype(picture.dtype.newbyteorder(">"))).view(np.uint8)
    lines = lines.reshape(height, -1)
    filtered = np.empty((height, 1 + lines.shape[1]), np.uint8)
    filtered[:, 0] = 2
    filtered[:, 1:] = lines
    filtered[1:, 1:] -= lines[:-1]
    header = struct.pack(">IIBBBBB", width, height, 8 * picture.dtype.itemsize, _COLOUR[channels], 0, 0, 0)

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    data = zlib.compress(filtered.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
