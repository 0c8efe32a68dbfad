#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Holds greatx against a measured hallway: DICHASUS dc01 as NVlabs/diff-rt-calibration publishes it.

    python3 tests/peer/measured_hallway.py FOLDER -o out/hallway                   # every step: half an hour
    python3 tests/peer/measured_hallway.py FOLDER -o out/hallway --steps itu,ends  # some steps
    python3 tests/peer/measured_hallway.py FOLDER -o out/hallway --every 8         # every eighth cell

FOLDER has the measurements, their survey and the model; its licence allows evaluation alone, so that it is
not in this repository. Each step prints its errors and its time, and adds them to OUT/steps.json; pictures go
to OUT. docs/validation.md explains the steps. `--fit` calibrates the materials by `greatx calibrate` on the
cells of one half of a checkerboard and scores them on the other half.
"""

import argparse
import pathlib
import sys

import environment

PACKAGES = ("numpy==2.3.5", "matplotlib==3.10.7")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="the measurements")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, default=environment.ROOT / "build/release")
    parser.add_argument("--steps", help="names of steps, separated by commas (default: all)")
    parser.add_argument("--every", type=int, default=1, help="use every n-th cell")
    parser.add_argument("--places", type=int, default=7, help="positions in a cell")
    parser.add_argument("--fit", action="store_true", help="calibrate, and score what was held out")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def main():
    options = arguments()
    if not options.inside:
        command = [__file__, *sys.argv[1:], "--inside"]
        path = ("tests/peer", str(options.build.resolve() / "python"))
        return environment.run_inside("hallway", PACKAGES, command, python_path=path)
    from hallway import run

    return run.run(options)


if __name__ == "__main__":
    sys.exit(main())
