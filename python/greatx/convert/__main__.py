# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The command python3 -m greatx.convert. Its exit codes are those of greatx: 0 for success, 1 for faulty
input or data.
"""
from __future__ import annotations

import argparse
import sys
from typing import List, Optional

from .. import DatasetError, load
from .deepmimo import LAYOUTS, write_deepmimo
from .sionna import write_sionna


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python3 -m greatx.convert",
        description="Writes a data set's channel in the "
        "conventions of another tool (docs/converters.md). Nothing is normalised.",
    )
    commands = parser.add_subparsers(dest="to", required=True, metavar="deepmimo|sionna")
    for name, help_text in (
        ("deepmimo", "a scenario that DeepMIMO 4 loads"),
        ("sionna", "Sionna RT's arrays, .npz"),
    ):
        command = commands.add_parser(name, help=help_text, description=help_text)
        command.add_argument("DIR", help="the data set")
        command.add_argument("OUT", help="folder to make; it must not exist or be empty")
        command.add_argument("--channel", help="name of the channel; needed if there are several")
        command.add_argument(
            "--sequence",
            type=int,
            help="number of the sequence"
            + ("; needed if there are several" if name == "deepmimo" else "; default: all"),
        )
    commands.choices["deepmimo"].add_argument(
        "--layout",
        choices=LAYOUTS,
        default=LAYOUTS[0],
        help="ticks as snapshots of "
        "a dynamic scenario, or as users of a static one (default: %(default)s)",
    )
    given = parser.parse_args(arguments)
    try:
        dataset = load(given.DIR)
        if given.to == "deepmimo":
            summary = write_deepmimo(dataset, given.OUT, given.channel, given.sequence, given.layout)
        else:
            summary = write_sionna(dataset, given.OUT, given.channel, given.sequence)
    except (DatasetError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print(f"{given.OUT}: " + ", ".join(f"{value} {key}" for key, value in summary.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
