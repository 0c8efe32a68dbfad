# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What the checks of the exporters share: an environment with the tools, data sets, a table of differences.

The data sets are that of python/tests/export_scene.py, which is asymmetric, and, with `--scenes FOLDER`, a
few ticks of assets/examples/etoile_seven.yaml with the file etoile.glb of FOLDER.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / "build/peer/exports"
PACKAGES = ("pykitti==0.3.1", "nuscenes-devkit==1.2.0", "pycocotools==2.0.11")


def main(script, check):
    """Runs `check(folder, data_sets)` inside the environment, which the first call sets up. Returns the exit
    code. `data_sets` are folders by name, and `folder` is an empty folder for what is converted."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("--program", default=ROOT / "build/release/greatx", type=pathlib.Path)
    parser.add_argument("--scenes", type=pathlib.Path, help="folder with etoile.glb")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if not given.inside:
        return _outside(script, given)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        data_sets = {"asymmetric": folder / "asymmetric"}
        (folder / "scene.yaml").write_text(_scenario())
        _generate(given.program, folder / "scene.yaml", data_sets["asymmetric"])
        if given.scenes is not None:
            data_sets["etoile"] = folder / "etoile"
            outputs = "nodes[uav].sensors[front].outputs=[rgb, depth, ids, boxes]"
            more = ["--assets", given.scenes, "--ticks", "11", "--set", outputs]
            _generate(given.program, ROOT / "assets/examples/etoile_seven.yaml", data_sets["etoile"], *more)
        return check(folder, data_sets)


def _outside(script, given):
    python = ENVIRONMENT / "bin/python"
    stamp = ENVIRONMENT / ("+".join(PACKAGES) + ".stamp")
    if not stamp.is_file():
        print(f"setting up {ENVIRONMENT}", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", ENVIRONMENT], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, *PACKAGES], check=True)
        stamp.touch()
    command = [python, script, "--inside", "--program", given.program.resolve()]
    if given.scenes is not None:
        command += ["--scenes", given.scenes.resolve()]
    paths = [str(ROOT / "python"), str(ROOT / "python/tests")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "MPLBACKEND": "Agg"}
    return subprocess.run(command, env=environment).returncode


def _scenario():
    from export_scene import SCENE

    return SCENE


def _generate(program, scenario, out, *more):
    subprocess.run(
        [program, "generate", scenario, "-o", out, "-q", *more], check=True, stderr=subprocess.DEVNULL
    )


class Worst:
    """Keeps the largest value of each named difference and its bound."""

    def __init__(self):
        self.rows = {}

    def add(self, name, value, bound):
        import numpy as np

        count, worst, _ = self.rows.get(name, (0, 0.0, bound))
        value = float(np.max(value, initial=0.0))
        self.rows[name] = (count + 1, value if not value <= worst else worst, bound)

    def failed(self):
        """Prints all rows. Returns the number of those that exceed their bound."""
        bad = 0
        for name, (count, worst, bound) in self.rows.items():
            bad += not worst <= bound
            print(
                f"{'ok' if worst <= bound else 'FAIL':4} {name:66} "
                f"{worst:9.2e} <= {bound:.0e}  ({count} compared)"
            )
        return bad
