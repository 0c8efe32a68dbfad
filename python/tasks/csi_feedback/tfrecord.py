# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads TFRecord files of tf.train.Example messages, without TensorFlow.

A TFRecord file is a sequence of records: the length of the data (uint64), a check of the length (uint32), the
data, a check of the data (uint32), all little-endian. A check is the CRC-32C (Castagnoli, RFC 3720, appendix
B.4) c, masked as ((c >> 15 | c << 17) + 0xa282ead8) mod 2^32 (TensorFlow, "TFRecord and tf.train.Example").

The data of a record is a protocol buffer. Of these messages the following fields are read; others are passed
over, as protocol buffers ask for:

Example      1: Features
Features     1: map entries {1: name, 2: Feature}, repeated
Feature      1: BytesList {1: bytes}, 2: FloatList {1: float, packed or not}, 3: Int64List {1: varint, ...}
TensorProto  1: DataType (1: float32, 2: float64, 3: int32, 9: int64), 2: TensorShapeProto
             {2: Dim {1: size}, repeated}, 4: tensor_content
"""
from __future__ import annotations

import pathlib
import struct
from typing import Any, Dict, Iterator, List, Tuple, Union

import numpy as np

from greatx.errors import Error

Value = Union[List[bytes], np.ndarray]

#: Data types of TensorProto.
_TYPES = {1: np.dtype("<f4"), 2: np.dtype("<f8"), 3: np.dtype("<i4"), 9: np.dtype("<i8")}


class RecordError(Error):
    """Reports a damaged file: FILE: record NUMBER: what was expected, and what was found."""


def _table() -> np.ndarray:
    """Returns the CRC-32C of each byte."""
    values = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        values = np.where(values & 1, (values >> 1) ^ np.uint32(0x82F63B78), values >> 1)
    return values


_BYTES = _table().tolist()


def crc32c(data: bytes) -> int:
    """Returns the CRC-32C of some bytes."""
    if len(data) >= 4096:
        return _crc_of_columns(data)
    state = 0xFFFFFFFF
    for byte in data:
        state = _BYTES[(state ^ byte) & 0xFF] ^ (state >> 8)
    return state ^ 0xFFFFFFFF


def _crc_of_columns(data: bytes) -> int:
    """Returns the CRC-32C of many bytes. Python takes a microsecond for a byte, so the data is cut into rows,
    whose checks NumPy advances side by side. The check is linear: two of them join by moving the first over
    the length of the second."""
    width = 1 << max(6, (len(data).bit_length() - 1) // 2)
    rows = len(data) // width
    table = np.array(_BYTES, np.uint32)
    body = np.frombuffer(data, np.uint8, rows * width).reshape(rows, width)
    states = np.zeros(rows, np.uint32)
    states[0] = 0xFFFFFFFF
    for column in range(width):
        states = table[(states ^ body[:, column]) & 0xFF] ^ (states >> 8)
    over = _moves(width)
    state = 0
    for row in states.tolist():
        state = _moved(over, state) ^ row
    for byte in data[rows * width :]:
        state = _BYTES[(state ^ byte) & 0xFF] ^ (state >> 8)
    return state ^ 0xFFFFFFFF


def _moves(length: int) -> List[int]:
    """Returns what each bit of a check becomes after `length` zero bytes."""
    states = np.uint32(1) << np.arange(32, dtype=np.uint32)
    table = np.array(_BYTES, np.uint32)
    for _ in range(length):
        states = table[states & 0xFF] ^ (states >> 8)
    return states.tolist()


def _moved(moves: List[int], state: int) -> int:
    out = 0
    for bit, value in enumerate(moves):
        if state >> bit & 1:
            out ^= value
    return out


def masked(check: int) -> int:
    """Returns a CRC-32C as files store it."""
    return ((check >> 15 | check << 17) + 0xA282EAD8) & 0xFFFFFFFF


def records(path: pathlib.Path, every: int = 1) -> Iterator[Tuple[int, bytes]]:
    """Yields the numbers and the data of every `every`-th record of a file. Raises RecordError where it is
    damaged. Of the records between, the lengths alone are read and checked.
    """
    with open(path, "rb") as file:
        size = path.stat().st_size
        number = 0
        while True:
            head = file.read(12)
            if not head:
                return
            where = f"{path}: record {number}"
            if len(head) < 12:
                raise RecordError(f"{where}: expected 12 bytes of length and check, found {len(head)}")
            length, check = struct.unpack("<QI", head)
            if masked(crc32c(head[:8])) != check:
                raise RecordError(f"{where}: expected the check of its length, found another: damaged")
            if length + 4 > size - file.tell():
                raise RecordError(
                    f"{where}: expected {length + 4} bytes, found {size - file.tell()}: the file is cut off"
                )
            if number % every:
                file.seek(length + 4, 1)
            else:
                data = file.read(length)
                (check,) = struct.unpack("<I", file.read(4))
                if masked(crc32c(data)) != check:
                    raise RecordError(f"{where}: expected the check of its data, found another: damaged")
                yield number, data
            number += 1


def _varint(data: memoryview, at: int) -> Tuple[int, int]:
    value = shift = 0
    while True:
        if at >= len(data) or shift > 63:
            raise ValueError("a number that does not end")
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
        shift += 7


def _fields(data: memoryview) -> Iterator[Tuple[int, int, Any]]:
    """Yields the number, the wire type and the value of each field of a message."""
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        number, kind = key >> 3, key & 7
        if kind == 0:
            value, at = _varint(data, at)
        elif kind in (1, 2, 5):
            length = 8 if kind == 1 else 4
            if kind == 2:
                length, at = _varint(data, at)
            if at + length > len(data):
                raise ValueError(f"a field of {length} bytes where {len(data) - at} are left")
            value, at = data[at : at + length], at + length
        else:
            raise ValueError(f"a field of wire type {kind}")
        yield number, kind, value


def _bytes(data: memoryview, number: int) -> List[memoryview]:
    return [value for n, kind, value in _fields(data) if n == number and kind == 2]


def example(data: bytes) -> Dict[str, Value]:
    """Returns the features of a tf.train.Example by name: lists of bytes, float32 or int64 arrays. Raises
    ValueError for data that is none."""
    out: Dict[str, Value] = {}
    for features in _bytes(memoryview(data), 1):
        for entry in _bytes(features, 1):
            names, values = _bytes(entry, 1), _bytes(entry, 2)
            if len(names) == 1 and len(values) == 1:
                out[bytes(names[0]).decode("utf-8")] = _feature(values[0])
    return out


def _feature(data: memoryview) -> Value:
    for number, kind, value in _fields(data):
        if number == 1 and kind == 2:
            return [bytes(item) for item in _bytes(value, 1)]
        if number == 2 and kind == 2:
            packed = [bytes(item) for n, k, item in _fields(value) if n == 1 and k in (2, 5)]
            return np.frombuffer(b"".join(packed), "<f4")
        if number == 3 and kind == 2:
            return np.array(_integers(value), np.int64)
    return []


def _integers(data: memoryview) -> List[int]:
    out: List[int] = []
    for number, kind, value in _fields(data):
        if number != 1:
            continue
        if kind == 0:
            out.append(value)
        elif kind == 2:
            at = 0
            while at < len(value):
                item, at = _varint(value, at)
                out.append(item)
    return [item - (1 << 64) if item >> 63 else item for item in out]


def tensor(data: bytes) -> np.ndarray:
    """Returns the array of a TensorProto. Raises ValueError for data that is none, or for a type or a way of
    storing it that is not read here."""
    kind, shape, content = 0, [], b""
    for number, wire, value in _fields(memoryview(data)):
        if number == 1 and wire == 0:
            kind = value
        elif number == 2 and wire == 2:
            dims = [[v for n, k, v in _fields(dim) if n == 1 and k == 0] for dim in _bytes(value, 2)]
            shape = [dim[0] if dim else 0 for dim in dims]
        elif number == 4 and wire == 2:
            content = bytes(value)
    if kind not in _TYPES:
        raise ValueError(f"a tensor of type {kind}, expected one of {', '.join(map(str, _TYPES))}")
    wanted = int(np.prod(shape, dtype=np.int64)) * _TYPES[kind].itemsize
    if len(content) != wanted:
        raise ValueError(f"{len(content)} bytes of content for a tensor of {shape}, expected {wanted}")
    return np.frombuffer(content, _TYPES[kind]).reshape(shape)
