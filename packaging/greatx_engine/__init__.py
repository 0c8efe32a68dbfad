# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Holds the programs of greatx and the libraries that they and the module greatx._native need. Wheels with
the engine have this package beside the package greatx (docs/install.md).

    bin/      greatx and greatx-places
    lib/      libraries. Most have names of their own, so that a process may have other versions of them, too
    vulkan/   lavapipe.json, the description of the bundled Vulkan driver, Mesa's lavapipe
    share/    the manual page, completions, schemas, examples, documents, and proj/, the data of PROJ

The programs find all of it by their own place. Nothing here needs NumPy, so the command starts at once.
"""

import os
import pathlib
import sys

#: The folder of this package.
folder = pathlib.Path(__file__).resolve().parent
#: The program.
program = folder / "bin" / "greatx"
#: The description of the bundled driver: VK_DRIVER_FILES=FILE makes it the only one.
lavapipe = folder / "vulkan" / "lavapipe.json"


def main() -> None:
    """Replaces this process by the program, with the same arguments. It is the command `greatx`."""
    try:
        os.execv(program, ["greatx", *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"greatx: error: {program}: cannot be started: {error.strerror}; install the wheel again")
