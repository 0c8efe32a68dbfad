#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Compares greatx with Sionna RT 2.2.0 on the same scenes and nodes, path by path and by cost
(docs/sionna.md).

    python3 tests/peer/sionna_rt.py                  compare on all cases (minutes)
    python3 tests/peer/sionna_rt.py --case etoile    one of them (--list names them)
    python3 tests/peer/sionna_rt.py --table          time and memory, in Markdown: needs a quiet machine

The first call sets up an environment of its own (a venv with sionna-rt, some 600 MB) below the build folder.
The script needs Debian's libllvm19 (apt-get install libllvm19), python3-venv and a built greatx. It is not
part of ./test.sh."""
import argparse
import pathlib
import sys

import sionna_setup


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--greatx", type=pathlib.Path, help="the program (default: build/release/greatx)")
    parser.add_argument(
        "--work",
        type=pathlib.Path,
        default=sionna_setup.ROOT / "build" / "peer",
        help="venv, imported scenes, results (default: build/peer)",
    )
    parser.add_argument("--case", action="append", help="one case of the comparison (may be repeated)")
    parser.add_argument("--list", action="store_true", help="name the cases")
    parser.add_argument(
        "--samples", type=float, default=1e6, help="Sionna RT's rays a transmitter (its default: 1e6)"
    )
    parser.add_argument(
        "--no-search", action="store_true", help="do not look for the settings that find missing paths"
    )
    parser.add_argument("--json", type=pathlib.Path, help="write all figures here as well")
    parser.add_argument("--table", action="store_true", help="measure time and memory instead")
    parser.add_argument("--quick", action="store_true", help="of --table: fewer repetitions and no long rows")
    return parser.parse_args()


def main():
    options = arguments()
    sionna_setup.enter(options.work)  # returns inside the environment
    if options.table:
        import sionna_table

        return sionna_table.main(options)
    import sionna_compare

    return sionna_compare.main(options)


if __name__ == "__main__":
    sys.exit(main())
