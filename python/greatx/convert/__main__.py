# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The command python3 -m greatx.convert. Its exit codes are those of greatx: 0 for success, 1 for faulty
input or data, or if a package is missing that the converter needs, 130 if somebody stops it.
"""

from __future__ import annotations

import argparse
import pathlib
import re
import sys
from typing import List, NoReturn, Optional

from .. import Campaign, DatasetError, load
from ..errors import nearest
from ..files import interpreting
from .catalogue import COMMANDS


class _Parser(argparse.ArgumentParser):
    """A parser that ends like greatx: a wrong argument has the exit code 1, and a name comes with the one
    that was probably meant."""

    def error(self, message: str) -> NoReturn:
        found = re.search(r"invalid choice: '(.*?)'", message)
        names = [name for name in re.findall(r"'(.*?)'", message[found.end() :])] if found else []
        hint = nearest(found[1], names) if found else ""
        self.exit(1, f"error: {message}{hint}\n`{self.prog} --help` tells what there is.\n")


def _words(error: Exception, out: str) -> str:
    """Returns the message of an error. A write that fails, as on a full disk or at a limit on the size of
    files, names no file, so that the message names OUT."""
    if not isinstance(error, OSError) or error.errno is None or error.filename is not None:
        return str(error)
    return f"{out}: cannot be written: {error.strerror}; nothing of it is left"


def main(arguments: Optional[List[str]] = None) -> int:
    parser = _Parser(
        prog="python3 -m greatx.convert",
        description="Writes a data set in the conventions of another tool (docs/exports.md). Nothing is "
        "normalised.",
    )
    commands = parser.add_subparsers(dest="to", required=True, metavar="TOOL")
    by_name = {command.name: command for command in COMMANDS}
    for command in COMMANDS:
        sub = commands.add_parser(command.name, help=command.help, description=command.help)
        sub.add_argument("DIR", help="the data set")
        sub.add_argument("OUT", help=command.out_help)
        command.arguments(sub)
    given = parser.parse_args(arguments)
    try:
        with interpreting(given.DIR):
            dataset = load(given.DIR)
            if isinstance(dataset, Campaign):
                raise DatasetError(
                    f"{given.DIR}: expected a data set, found a campaign; convert one of its cells, as "
                    f"{pathlib.Path(given.DIR, 'data', dataset.cells[0])}"
                )
            summary = by_name[given.to].run(dataset, given)
    except (DatasetError, OSError, ImportError) as error:
        print(f"error: {_words(error, given.OUT)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"error: interrupted; {given.OUT} is not made", file=sys.stderr)
        return 130
    print(f"{given.OUT}: " + ", ".join(f"{value} {key}" for key, value in summary.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
