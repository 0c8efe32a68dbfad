# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the task from its folder: python3 python/tasks/blockage DATA -o OUT."""
import pathlib
import sys

# Behind the others, because the package of a build has the compiled module, and the sources have not.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))

from tasks.blockage.experiment import run  # noqa: E402
from tasks.common.command import main  # noqa: E402

if __name__ == "__main__":
    main(run)
