# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What checks by other tools share: an environment with packages from PyPI, and a table of differences. It
uses the standard library alone where it runs before there is an environment.
"""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run_inside(name, packages, command, python_path=("python",)):
    """Runs `command` (a script and its arguments) by the Python of the environment build/peer/NAME, which is
    made anew if it does not have just these packages. `python_path`: folders of the project whose modules the
    script imports. Returns the exit code.
    """
    environment = ROOT / "build/peer" / name
    python, stamp = environment / "bin/python", environment / "packages.txt"
    if not stamp.is_file() or stamp.read_text().split() != list(packages):
        print(f"setting up {environment}", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", environment], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, *packages], check=True)
        stamp.write_text("\n".join(packages))
    path = os.pathsep.join(str(ROOT / folder) for folder in python_path)
    variables = {**os.environ, "PYTHONPATH": path, "MPLBACKEND": "Agg"}
    return subprocess.run([python, *command], env=variables).returncode


class Worst:
    """Keeps the largest value of each named difference and its bound."""

    def __init__(self):
        self.rows = {}

    def add(self, name, value, bound):
        import numpy as np

        count, worst, _ = self.rows.get(name, (0, 0.0, bound))
        value = float(np.max(value, initial=0.0))
        self.rows[name] = (count + 1, value if not value <= worst else worst, bound)

    def differs(self, name, found, wanted):
        """Counts arrays that differ in type, shape or any bit."""
        import numpy as np

        found, wanted = np.asarray(found), np.asarray(wanted)
        same = (found.dtype, found.shape, found.tobytes()) == (wanted.dtype, wanted.shape, wanted.tobytes())
        self.add(f"{name}: arrays that differ", float(not same), 0)

    def failed(self):
        """Prints all rows. Returns the number of those that exceed their bound."""
        bad = 0
        for name, (count, worst, bound) in self.rows.items():
            bad += not worst <= bound
            print(
                f"{'ok' if worst <= bound else 'FAIL':4} {name:72} "
                f"{worst:9.2e} <= {bound:.0e}  ({count} compared)"
            )
        return bad
