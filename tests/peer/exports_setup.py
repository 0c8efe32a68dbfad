# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What the checks of the exporters share: their data sets.

The first data set is the asymmetric drive of python/tests/export_scene.py, or the rig of
python/tests/support.py, which has every kind of sensor and is asymmetric, too. With `--scenes FOLDER` a few
ticks of assets/examples/etoile_seven.yaml follow, with the file etoile.glb of FOLDER.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

from environment import ROOT, run_inside

#: Tools that read data sets of drives.
DRIVING = ("pykitti==0.3.1", "nuscenes-devkit==1.2.0", "pycocotools==2.0.11")
CAMERA = "nodes[uav].sensors[front].outputs=[rgb, depth, ids, boxes]"
RADAR = "nodes[uav].sensors[radar].outputs=[range_doppler, range_azimuth, detections, cube]"


def main(script, check, environment, packages, of_rig=True):
    """Runs `check(folder, data_sets, program)` inside an environment with the packages, which the first call
    makes below build/peer/. Returns the exit code. `data_sets` are folders by name, and `folder` is an empty
    folder for what is converted."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("--program", default=ROOT / "build/release/greatx", type=pathlib.Path)
    parser.add_argument("--scenes", type=pathlib.Path, help="folder with etoile.glb")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if not given.inside:
        command = [script, "--inside", "--program", given.program.resolve()]
        if given.scenes is not None:
            command += ["--scenes", given.scenes.resolve()]
        return run_inside(environment, packages, command, ("python", "python/tests"))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        return check(folder, _data_sets(folder, given, of_rig), given.program)


def _data_sets(folder, given, of_rig):
    if of_rig:
        from support import RIG as scenario
    else:
        from export_scene import SCENE as scenario
    name = "rig" if of_rig else "asymmetric"
    (folder / f"{name}.yaml").write_text(scenario)
    made = {name: folder / name}
    more = ["--sequences", "2"] if of_rig else []
    _generate(given.program, folder / f"{name}.yaml", made[name], *more)
    if given.scenes is not None:
        made["etoile"] = folder / "etoile"
        more = (
            ["--ticks", "6", "--set", CAMERA, "--set", RADAR]
            if of_rig
            else ["--ticks", "11", "--set", CAMERA]
        )
        scenario = ROOT / "assets/examples/etoile_seven.yaml"
        _generate(given.program, scenario, made["etoile"], "--assets", given.scenes, *more)
    return made


def _generate(program, scenario, out, *more):
    subprocess.run(
        [program, "generate", scenario, "-o", out, "-q", *more], check=True, stderr=subprocess.DEVNULL
    )
