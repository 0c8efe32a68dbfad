# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_village.py SOURCE: make_village.py makes the files of assets/examples/places/village that are there.

The map must be the same to the byte. Heights may differ by one step of 1/64 m, and one pixel in 10,000 of the
picture may differ: sines of other C libraries differ in their last bit. Compressed bytes are not compared.
"""

import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np


def heights(file: pathlib.Path) -> np.ndarray:
    """Reads the one strip of the GeoTIFF: deflated little-endian floats."""
    data = file.read_bytes()
    (start,) = struct.unpack_from("<I", data, 4)
    (count,) = struct.unpack_from("<H", data, start)
    tags = {}
    for i in range(count):
        tag, _, _, value = struct.unpack_from("<HHII", data, start + 2 + 12 * i)
        tags[tag] = value
    strip = zlib.decompress(data[tags[273] : tags[273] + tags[279]])
    return np.frombuffer(strip, "<f4").reshape(tags[257], tags[256])


def pixels(file: pathlib.Path) -> np.ndarray:
    """Reads the indices of the PNG, whose rows have no filter."""
    data, at, packed = file.read_bytes(), 8, b""
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        if data[at + 4 : at + 8] == b"IHDR":
            width, height = struct.unpack_from(">II", data, at + 8)
        if data[at + 4 : at + 8] == b"IDAT":
            packed += data[at + 8 : at + 8 + length]
        at += 12 + length
    return np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, width + 1)


def main(source: str) -> int:
    folder = pathlib.Path(source) / "assets/examples/places/village"
    with tempfile.TemporaryDirectory() as name:
        made = pathlib.Path(name)
        subprocess.run([sys.executable, "-B", str(folder / "make_village.py"), name], check=True)
        for file in ("village.osm", "village_ortho.pgw"):
            if (made / file).read_bytes() != (folder / file).read_bytes():
                print(f"{file} differs from what make_village.py makes")
                return 1
        off = np.abs(heights(made / "village_terrain.tif") - heights(folder / "village_terrain.tif")).max()
        differ = (pixels(made / "village_ortho.png") != pixels(folder / "village_ortho.png")).mean()
    print(f"heights are off by at most {off} m, and {differ:.2g} of the pixels differ")
    size = sum(file.stat().st_size for file in folder.iterdir())
    print(f"{size} bytes in all")
    return 0 if off <= 1 / 64 and differ <= 1e-4 and size < 400 * 1024 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
