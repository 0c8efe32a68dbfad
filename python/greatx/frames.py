# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads files of one frame each, npy, PNG, OpenEXR, PLY, PCD and KITTI, with NumPy and zlib only.

The readers support the variants that data sets hold (docs/dataset.md). They raise DatasetError for all other
files of these formats.
"""

from __future__ import annotations

import pathlib
import struct
from typing import Dict, Optional, Tuple, Union

import numpy as np

from .errors import DatasetError
from .files import LARGEST, Path, bytes_of_shape, check_plain, inflate, read_bytes, reading
from .layout import OutputInfo

#: Shape of a picture. An extent of -1 accepts any value; None accepts any shape.
Shape = Optional[Tuple[int, ...]]

_PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_EXR_MAGIC = 20000630
_EXR_LINES = {0: 1, 2: 1, 3: 16}  # lines per block by compression: none, ZIPS, ZIP
_EXR_TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
_PLY_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "<i2",
    "ushort": "<u2",
    "int": "<i4",
    "uint": "<u4",
    "float": "<f4",
    "double": "<f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "<i2",
    "uint16": "<u2",
    "int32": "<i4",
    "uint32": "<u4",
    "float32": "<f4",
    "float64": "<f8",
}
_PCD_TYPES = {
    code + size: "<" + code.lower() + size
    for code, sizes in (("U", "1248"), ("I", "1248"), ("F", "48"))
    for size in sizes
}


def _check_shape(path: Path, found: Tuple[int, ...], itemsize: int, expected: Shape) -> None:
    """Raises DatasetError if a picture does not have the expected shape or is too large. Must be called
    before memory is allocated for the picture, because its file is not trusted.
    """
    fits = expected is None or (
        len(found) == len(expected) and all(e in (-1, f) for e, f in zip(expected, found))
    )
    if not fits:
        raise DatasetError(f"{path}: expected {list(expected)} (dataset.json), found {list(found)}")
    if min(found) < 1 or bytes_of_shape(found, itemsize) > LARGEST:
        raise DatasetError(f"{path}: expected a picture of at most {LARGEST} bytes, found {list(found)}")


def read_png(path: Path, expected: Shape = None) -> np.ndarray:
    """Reads a PNG (ISO/IEC 15948): uint8 [h, w, 3] from RGB, uint8 [h, w] from 8-bit grey, or uint16 [h, w]
    from 16-bit grey.
    """
    data = read_bytes(path)
    if data[:8] != _PNG_SIGNATURE:
        raise DatasetError(f"{path}: is no PNG")
    with reading(path):
        chunks, at = [], 8
        while at < len(data):
            length, kind = struct.unpack_from(">I4s", data, at)
            chunks.append((kind, data[at + 8 : at + 8 + length]))
            at += length + 12
            if at > len(data):
                raise ValueError("the file is cut off")
        width, height, bits, colour, _, _, interlaced = struct.unpack(">IIBBBBB", dict(chunks)[b"IHDR"])
        if (bits, colour) not in ((8, 2), (8, 0), (16, 0)) or interlaced:
            raise DatasetError(
                f"{path}: expected 8-bit RGB or grey or 16-bit grey, not interlaced; found {bits} bits, "
                f"colour type {colour}, interlacing {interlaced}"
            )
        channels = 3 if colour == 2 else 1
        step = channels * bits // 8
        _check_shape(path, (height, width, 3) if channels == 3 else (height, width), bits // 8, expected)
        raw = inflate(b"".join(body for kind, body in chunks if kind == b"IDAT"), height * (1 + width * step))
    if len(raw) != height * (1 + width * step):
        raise DatasetError(f"{path}: is damaged: {len(raw)} bytes of pixels for {width} x {height}")
    lines = np.frombuffer(raw, np.uint8).reshape(height, 1 + width * step)
    pixels = _unfilter(path, lines[:, 0], lines[:, 1:].reshape(height, width, step))
    if bits == 16:
        return np.ascontiguousarray(pixels).view(">u2").astype(np.uint16).reshape(height, width)
    return pixels.reshape((height, width, 3) if channels == 3 else (height, width))


def _unfilter(path: Path, filters: np.ndarray, lines: np.ndarray) -> np.ndarray:
    """Undoes the filters None, Sub and Up of lines [h, w, bytes of a pixel]. Sums are modulo 256, as the
    standard requires.
    """
    unknown = np.flatnonzero(filters > 2)
    if len(unknown):
        y = unknown[0]
        raise DatasetError(f"{path}: line {y} has the filter {filters[y]}, which greatx does not write")
    out = np.array(lines)
    sub = np.flatnonzero(filters == 1)
    out[sub] = np.cumsum(lines[sub], axis=1, dtype=np.uint8)
    flat = out.reshape(len(out), -1)
    for y in np.flatnonzero(filters == 2):
        if y > 0:
            np.add(flat[y], flat[y - 1], out=flat[y])
    return out


def depth_from_png24(rgb: np.ndarray) -> np.ndarray:
    """Returns depths, float32 [h, w] in metres, from uint8 [h, w, 3] in CARLA's coding: 1000 m (R + 256 G +
    65536 B)/(2^24 - 1). 1000 m stands for all depths from 1000 m on, including the sky."""
    code = (
        rgb[..., 0].astype(np.uint32)
        + (rgb[..., 1].astype(np.uint32) << 8)
        + (rgb[..., 2].astype(np.uint32) << 16)
    )
    return (1000.0 * code / (2**24 - 1)).astype(np.float32)


def read_exr(path: Path, expected: Shape = None) -> np.ndarray:
    """Reads OpenEXR 2, single part, scan lines, ZIP, ZIPS or uncompressed. Returns float32 [h, w] from
    channel Y or, if there is none, Z, which some data sets have; otherwise [h, w, 3] from R, G, B.
    """
    data = read_bytes(path)
    with reading(path):
        header, at = _exr_header(data)
        channels, compression, box = header["channels"], header["compression"], header["dataWindow"]
        if compression not in _EXR_LINES or data[5] & 0x1A:
            raise DatasetError(
                f"{path}: expected scan lines, ZIP or uncompressed; found compression {compression}, "
                f"flags {data[5]:#x}"
            )
        height, width = box[3] - box[1] + 1, box[2] - box[0] + 1
        _check_shape(
            path,
            (height, width) if expected is None or len(expected) < 3 else (height, width, len(channels)),
            sum(np.dtype(kind).itemsize for _, kind in channels),
            expected,
        )
        line = np.dtype([(name, kind, (width,)) for name, kind in channels])
        pixels = np.zeros(height, line)
        per_block = _EXR_LINES[compression]
        blocks = -(-height // per_block)
        for offset in struct.unpack_from(f"<{blocks}Q", data, at):
            y, size = struct.unpack_from("<ii", data, offset)
            first = y - box[1]
            if not 0 <= first < height or first % per_block or size < 0:
                raise ValueError(f"a block of {size} bytes at line {y}")
            lines = min(per_block, height - first)
            block = data[offset + 8 : offset + 8 + size]
            if compression and size < lines * line.itemsize:
                block = _exr_unzip(block, lines * line.itemsize)
            pixels[first : first + lines] = np.frombuffer(block, line, lines)
    names = [name for name, _ in channels]
    for plane in ("Y", "Z"):
        if plane in names:
            return pixels[plane].astype(np.float32)
    if not {"R", "G", "B"} <= set(names):
        raise DatasetError(f"{path}: expected a channel Y or Z, or R, G and B; found {', '.join(names)}")
    return np.stack([pixels[name].astype(np.float32) for name in "RGB"], axis=-1)


def _exr_header(data: bytes) -> Tuple[dict, int]:
    """Returns the attributes that decoding needs, and the offset of the table of blocks."""
    if struct.unpack_from("<I", data)[0] != _EXR_MAGIC:
        raise ValueError("it does not begin as OpenEXR does")
    header, at = {}, 8
    while data[at] != 0:
        end = data.index(b"\0", at)
        name, after = data[at:end].decode(), data.index(b"\0", end + 1)
        size = struct.unpack_from("<i", data, after + 1)[0]
        if not 0 <= size <= len(data) - after - 5:
            raise ValueError(f"an attribute of {size} bytes")
        at = after + 5 + size
        body = data[after + 5 : at]
        if name == "channels":
            header[name] = _exr_channels(body)
        elif name == "compression":
            header[name] = body[0]
        elif name == "dataWindow":
            header[name] = struct.unpack("<4i", body)
    return header, at + 1


def _exr_channels(body: bytes) -> list:
    channels, at = [], 0
    while body[at] != 0:
        end = body.index(b"\0", at)
        kind = struct.unpack_from("<i", body, end + 1)[0]
        channels.append((body[at:end].decode(), _EXR_TYPES[kind]))
        at = end + 17
    return channels


def _exr_unzip(block: bytes, size: int) -> bytes:
    """Undoes the ZIP compression. The inflated bytes are differences plus 128; their sums are first all even
    bytes, then all odd bytes of the block.
    """
    coded = np.frombuffer(inflate(block, size), np.uint8).copy()
    coded[1:] -= 128
    plain = np.cumsum(coded, dtype=np.uint8)
    half = (len(plain) + 1) // 2
    out = np.empty_like(plain)
    out[0::2], out[1::2] = plain[:half], plain[half:]
    return out.tobytes()


def _count(text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 15):
        raise ValueError(f"expected a number of points, found {text[:60]!r}")
    return int(text)


def _rows(data: bytes, kind: np.dtype, count: int, begin: int) -> np.ndarray:
    if kind.itemsize == 0 or len(data) - begin != count * kind.itemsize:
        raise ValueError(f"expected {count} points of {kind.itemsize} bytes, found {len(data) - begin} bytes")
    return np.frombuffer(data, kind, count, begin)


def read_ply(path: Path) -> np.ndarray:
    """Reads a binary little-endian PLY. Returns a structured array [n] with a field for each property of the
    element "vertex".
    """
    data = read_bytes(path)
    end = data.find(b"end_header\n")
    lines = data[: max(end, 0)].decode("ascii", "replace").splitlines()
    if end < 0 or lines[:2] != ["ply", "format binary_little_endian 1.0"]:
        raise DatasetError(f"{path}: is no PLY in binary, little endian")
    words = [line.split() for line in lines[2:] if not line.startswith("comment")]
    with reading(path):
        (count,) = [_count(w[2]) for w in words if w[:2] == ["element", "vertex"]]
        kind = np.dtype([(w[2], _PLY_TYPES[w[1]]) for w in words if w[0] == "property"])
        return _rows(data, kind, count, end + len(b"end_header\n"))


def read_pcd(path: Path) -> np.ndarray:
    """Reads a binary PCD file, version 0.7, with one value per field. Returns a structured array [n] with a
    field for each field of the file.
    """
    data = read_bytes(path)
    end = data.find(b"\nDATA binary\n")
    if end < 0:
        raise DatasetError(f"{path}: is no PCD in binary")
    lines = [line.split() for line in data[:end].decode("ascii", "replace").splitlines()]
    header = {words[0]: words[1:] for words in lines if words and not words[0].startswith("#")}
    with reading(path):
        rows = [header[key] for key in ("FIELDS", "TYPE", "SIZE", "COUNT")]
        if not rows[0] or {len(row) for row in rows} != {len(rows[0])} or set(rows[3]) != {"1"}:
            raise ValueError("expected a TYPE, a SIZE and a COUNT of 1 for each of one or more FIELDS")
        kind = np.dtype([(name, _PCD_TYPES[code + size]) for name, code, size, _ in zip(*rows)])
        return _rows(data, kind, _count(header["POINTS"][0]), end + len(b"\nDATA binary\n"))


def read_kitti(path: Path) -> np.ndarray:
    """Reads KITTI's velodyne points. Returns float32 [n, 4]: x, y, z, reflectance."""
    data = read_bytes(path)
    if len(data) % 16:
        raise DatasetError(f"{path}: expected points of 16 bytes, found {len(data)} bytes")
    return np.frombuffer(data, "<f4").reshape(-1, 4)


def read_frame(path: pathlib.Path, output: OutputInfo) -> Dict[str, np.ndarray]:
    """Returns the arrays of one file of an output by name, with their types and shapes in dataset.json."""
    if output.format in ("ply", "pcd"):
        points = read_ply(path) if output.format == "ply" else read_pcd(path)
        first = output.arrays[0].name
        with reading(path):
            out = {first: np.stack([points[p] for p in ("x", "y", "z", "intensity")], axis=-1)}
            for a in output.arrays[1:]:
                values = points[a.name]
                # PLY stores uint32 as int32 (io/formats/ply.cpp).
                if a.dtype.kind == "u" and values.dtype.kind == "i" and len(values) and values.min() < 0:
                    raise ValueError(f"expected {a.name} from 0 on, found {values.min()}")
                out[a.name] = values.astype(a.dtype)
        return out
    shape = output.arrays[0].shape
    if output.format == "npy_frame":
        value = load_npy(path)
    elif output.format == "exr":
        value = read_exr(path, shape)
    elif output.format == "kitti":
        value = read_kitti(path)
    else:
        value = read_png(path, (*shape, 3) if output.format == "png_depth24" else shape)
        if output.format == "png_depth24":
            value = depth_from_png24(value)
    array = output.arrays[0]
    if value.ndim != len(array.shape) or any(e not in (-1, f) for e, f in zip(array.shape, value.shape)):
        raise DatasetError(f"{path}: expected {list(array.shape)} (dataset.json), found {list(value.shape)}")
    return {array.name: value.astype(array.dtype, copy=False)}


def load_npy(path: pathlib.Path, mmap_mode: Union[str, None] = None) -> np.ndarray:
    """Loads a .npy file by numpy.load. Errors name the file. A file that is not memory-mapped may have at
    most LARGEST bytes.
    """
    check_plain(path, 1 << 62 if mmap_mode else LARGEST)
    with reading(path):
        with open(path, "rb") as file:
            if file.read(6) != b"\x93NUMPY":
                raise DatasetError(f"{path}: is no .npy file")
        array = np.load(path, mmap_mode=mmap_mode or "r", allow_pickle=False)
        return array if mmap_mode else np.array(array)
