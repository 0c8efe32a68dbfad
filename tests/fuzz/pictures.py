# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes small PNG and JPEG files as seeds of the mutators. JPEG is ITU-T T.81, baseline and progressive
(spectral selection), with the typical Huffman tables of its annex K and quantisation by 1."""
from __future__ import annotations

import math
import struct
import zlib


def png_chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(width: int, height: int, channels: int = 3, bits: int = 8, interlaced: bool = False) -> bytes:
    """Returns a PNG file: grey (1 channel), grey with alpha (2), colour (3) or colour with alpha (4). No
    filter makes its pattern trivial."""
    color = {1: 0, 2: 4, 3: 2, 4: 6}[channels]

    def rows(columns: range, lines: range) -> bytes:
        data = b""
        for y in lines:
            data += bytes([y % 5])
            data += bytes(
                (x * 37 + y * 59 + c * 11) & 255 for x in columns for c in range(channels * bits // 8)
            )
        return data

    if interlaced:
        passes = [
            (0, 8, 0, 8),
            (4, 8, 0, 8),
            (0, 4, 4, 8),
            (2, 4, 0, 4),
            (0, 2, 2, 4),
            (1, 2, 0, 2),
            (0, 1, 1, 2),
        ]
        data = b"".join(
            rows(range(x, width, dx), range(y, height, dy)) for x, dx, y, dy in passes if x < width
        )
    else:
        data = rows(range(width), range(height))
    return (
        b"\x89PNG\r\n\x1a\n"
        + png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, color, 0, 0, int(interlaced)))
        + png_chunk(b"IDAT", zlib.compress(data, 9))
        + png_chunk(b"IEND", b"")
    )


def png_palette(width: int, height: int) -> bytes:
    data = b"".join(b"\0" + bytes((x + y) % 4 for x in range(width)) for y in range(height))
    return (
        b"\x89PNG\r\n\x1a\n"
        + png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0))
        + png_chunk(b"PLTE", bytes(range(12)))
        + png_chunk(b"tRNS", b"\x80\xff")
        + png_chunk(b"IDAT", zlib.compress(data, 9))
        + png_chunk(b"IEND", b"")
    )


def png_bomb(side: int, channels: int = 4) -> bytes:
    """Returns a PNG of one colour: a few kilobytes of file, but side * side * channels bytes of picture."""
    color = {1: 0, 3: 2, 4: 6}[channels]
    line = zlib.compressobj(9)
    data = b"".join([line.compress(b"\0" * (1 + side * channels)) for _ in range(side)] + [line.flush()])
    return (
        b"\x89PNG\r\n\x1a\n"
        + png_chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, color, 0, 0, 0))
        + png_chunk(b"IDAT", data)
        + png_chunk(b"IEND", b"")
    )


DC_COUNTS = [0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0]
AC_COUNTS = [0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 0x7D]
AC_HEAD = bytes.fromhex(
    "0102030004110512213141061351610722711432 8191a1082342b1c11552d1f02433627282090a161718191a25262728292a"
    "3435363738393a434445464748494a535455565758595a636465666768696a"
    "737475767778797a838485868788898a92939495969798999a"
    "a2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9da"
    "e1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9fa"
)


def huffman(counts: list[int], symbols: bytes) -> dict[int, tuple[int, int]]:
    codes, code, k = {}, 0, 0
    for length, count in enumerate(counts, 1):
        for _ in range(count):
            codes[symbols[k]] = (code, length)
            code, k = code + 1, k + 1
        code <<= 1
    return codes


DC, AC = huffman(DC_COUNTS, bytes(range(12))), huffman(AC_COUNTS, AC_HEAD)
ZIGZAG = sorted(range(64), key=lambda k: (k // 8 + k % 8, (k // 8 if (k // 8 + k % 8) % 2 else k % 8)))


class Bits:
    def __init__(self):
        self.value, self.count = 0, 0

    def put(self, value: int, length: int) -> None:
        self.value, self.count = self.value << length | value & (1 << length) - 1, self.count + length

    def coefficient(self, codes: dict, run: int, value: int) -> None:
        size = abs(value).bit_length()
        self.put(*codes[run << 4 | size])
        self.put(value if value > 0 else value - 1, size)

    def bytes(self) -> bytes:
        pad = -self.count % 8
        data = (self.value << pad | (1 << pad) - 1).to_bytes((self.count + pad) // 8, "big")
        return data.replace(b"\xff", b"\xff\0")


def block(bx: int, by: int, component: int) -> list[int]:
    """Returns the coefficients of 8 x 8 samples in zigzag order."""
    samples = [
        [(x * 9 + y * 5 + component * 40 + (x * y) % 7) % 200 - 100 for x in range(8 * bx, 8 * bx + 8)]
        for y in range(8 * by, 8 * by + 8)
    ]
    waves = [
        [math.cos((2 * i + 1) * u * math.pi / 16) * (math.sqrt(0.125) if u == 0 else 0.5) for i in range(8)]
        for u in range(8)
    ]
    lines = [[sum(row[i] * wave[i] for i in range(8)) for wave in waves] for row in samples]
    plane = [sum(lines[i][u] * waves[v][i] for i in range(8)) for v in range(8) for u in range(8)]
    return [round(plane[k]) for k in ZIGZAG]


def segment(marker: int, data: bytes) -> bytes:
    return struct.pack(">BBH", 255, marker, len(data) + 2) + data


def scan(blocks: list[tuple[int, list[int]]], components: list[int], first: int, last: int) -> bytes:
    bits, before = Bits(), {}
    for component, values in blocks:
        if first == 0:
            bits.coefficient(DC, 0, values[0] - before.get(component, 0))
            before[component] = values[0]
        if last == 0:
            continue
        run = 0
        for value in values[max(first, 1) : last + 1]:
            if value == 0:
                run += 1
                continue
            while run > 15:
                bits.put(*AC[0xF0])
                run -= 16
            bits.coefficient(AC, run, value)
            run = 0
        if run > 0:
            bits.put(*AC[0])
    head = (
        bytes([len(components)]) + b"".join(bytes([c + 1, 0]) for c in components) + bytes([first, last, 0])
    )
    return segment(0xDA, head) + bits.bytes()


def jpeg(blocks_x: int = 2, blocks_y: int = 1, components: int = 3, progressive: bool = False) -> bytes:
    tables = segment(0xDB, b"\0" + b"\1" * 64)
    tables += segment(0xC4, b"\0" + bytes(DC_COUNTS) + bytes(range(12))) + segment(
        0xC4, b"\x10" + bytes(AC_COUNTS) + AC_HEAD
    )
    frame = struct.pack(">BHHB", 8, 8 * blocks_y, 8 * blocks_x, components)
    frame += b"".join(bytes([c + 1, 0x11, 0]) for c in range(components))
    data = {c: [block(x, y, c) for y in range(blocks_y) for x in range(blocks_x)] for c in range(components)}
    woven = [(c, data[c][i]) for i in range(blocks_x * blocks_y) for c in range(components)]
    every = list(range(components))
    if progressive:
        scans = scan(woven, every, 0, 0) + b"".join(
            scan([(c, b) for b in data[c]], [c], first, last)
            for c in every
            for first, last in ((1, 5), (6, 63))
        )
    else:
        scans = scan(woven, every, 0, 63)
    head = b"\xff\xd8" + segment(0xE0, b"JFIF\0\1\1\0\0\1\0\1\0\0")
    return head + tables + segment(0xC2 if progressive else 0xC0, frame) + scans + b"\xff\xd9"
