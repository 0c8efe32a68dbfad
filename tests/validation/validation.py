# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the figures of docs/validation.md and draws its pictures.

    PYTHONPATH=build/release/python python3 tests/validation/validation.py --section two_ray

It needs NumPy and a built greatx. Pictures are written to --pictures FOLDER (docs/images for the page).
"""
import argparse
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "peer")]

import corner
import street
import two_ray
import walls

SECTIONS = {
    "two_ray": two_ray.run,
    "street": street.run_street,
    "city": street.run_city,
    "effects": street.run_effects,
    "corner": corner.run_corner,
    "edge": corner.run_edge,
    "walls": walls.run,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--section", choices=SECTIONS, help="one section (default: all)")
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for the pictures (default: none)")
    parser.add_argument(
        "--quick", action="store_true", help="without `city`, `effects` and the slowest row of `corner`"
    )
    options = parser.parse_args()

    def draw(name, text):
        if options.pictures:
            options.pictures.mkdir(parents=True, exist_ok=True)
            (options.pictures / f"validation_{name}").write_text(text)

    for name in [options.section] if options.section else SECTIONS:
        if options.quick and name in ("city", "effects"):
            continue
        more = {"quick": True} if options.quick and name == "corner" else {}
        started = time.perf_counter()
        SECTIONS[name](print, draw, **more)
        print(f"{name}  {time.perf_counter() - started:.1f} s")


if __name__ == "__main__":
    main()
