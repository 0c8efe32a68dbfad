# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What exports_data.py, exports_mcap.py and exports_torch.py share: an environment and data sets.

The data sets are the rig of python/tests/support.py, which has every kind of sensor and is asymmetric, and,
with `--scenes FOLDER`, a few ticks of assets/examples/etoile_seven.yaml with the file etoile.glb of FOLDER.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(script, check, environment, packages):
    """Runs `check(folder, data_sets, program)` inside an environment with the packages, which the first call
    makes below build/peer/. Returns the exit code. `data_sets` are folders by name, and `folder` is an empty
    folder for what is converted."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("--program", default=ROOT / "build/release/greatx", type=pathlib.Path)
    parser.add_argument("--scenes", type=pathlib.Path, help="folder with etoile.glb")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if not given.inside:
        return _outside(script, given, ROOT / "build/peer" / environment, packages)
    sys.path.insert(0, str(ROOT / "python/tests"))
    from support import RIG

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        data_sets = {"rig": folder / "rig"}
        (folder / "rig.yaml").write_text(RIG)
        _generate(given.program, folder / "rig.yaml", data_sets["rig"], "--sequences", "2")
        if given.scenes is not None:
            data_sets["etoile"] = folder / "etoile"
            camera = "nodes[uav].sensors[front].outputs=[rgb, depth, ids, boxes]"
            radar = "nodes[uav].sensors[radar].outputs=[range_doppler, range_azimuth, detections, cube]"
            more = ["--assets", given.scenes, "--ticks", "6", "--set", camera, "--set", radar]
            _generate(given.program, ROOT / "assets/examples/etoile_seven.yaml", data_sets["etoile"], *more)
        return check(folder, data_sets, given.program)


def _outside(script, given, environment, packages):
    python, stamp = environment / "bin/python", environment / "packages.txt"
    if not stamp.is_file() or stamp.read_text().split() != list(packages):
        print(f"setting up {environment}", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", environment], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, *packages], check=True)
        stamp.write_text("\n".join(packages))
    command = [python, script, "--inside", "--program", given.program.resolve()]
    if given.scenes is not None:
        command += ["--scenes", given.scenes.resolve()]
    variables = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "MPLBACKEND": "Agg"}
    return subprocess.run(command, env=variables).returncode


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
