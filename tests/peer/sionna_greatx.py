# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Asks greatx for its paths and channels by its commands."""
import json
import shutil
import subprocess

import numpy as np

from sionna_paths import Path

SCENARIO = """greatx: 1
name: {name}
seed: 1
ticks: 1
tick_rate_hz: 10
scene: {{file: {scene}.glb, origin_m: [0, 0, 0]}}
nodes:
  - name: tx
    trajectory: {{type: static, position_m: [{tx}]}}
    sensors: [{{name: antenna, type: antenna{tx_antenna}}}]
{receivers}channels:
  - {{name: csi, tx: tx/antenna, rx: [{names}], rate_hz: 10, carrier_hz: {carrier}, bandwidth_hz: 100e6,
     subcarriers: 256, max_depth: {depth}, max_transmissions: {walls}, max_paths: 16384}}
effects: {{gas: off, finite_reflectors: off, diffraction: {diffraction}{more}}}
"""
RECEIVER = """  - name: rx{i}
    trajectory: {{type: static, position_m: [{p}]}}
    sensors: [{{name: antenna, type: antenna{antenna}}}]
"""


def triple(position):
    return ", ".join(repr(float(x)) for x in position)


class Greatx:
    def __init__(self, program, work, scene_file):
        self.program, self.work = program, work
        self.scenes = work / "scenes"
        self.scenes.mkdir(parents=True, exist_ok=True)
        self.scene = scene_file.stem
        self.run("scene", "import", scene_file, "-o", self.scenes / f"{self.scene}.glb")

    def run(self, *words):
        done = subprocess.run([str(self.program), *map(str, words)], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(
                f"greatx {' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}"
            )
        return done.stdout

    def scenario(self, case, receivers, tx_antenna="", rx_antenna="", more=""):
        file = self.work / f"{case.name}.yaml"
        file.write_text(
            SCENARIO.format(
                name=case.name,
                scene=self.scene,
                tx=triple(case.transmitter),
                tx_antenna=tx_antenna,
                receivers="".join(
                    RECEIVER.format(i=i, p=triple(p), antenna=rx_antenna) for i, p in enumerate(receivers)
                ),
                names=", ".join(f"rx{i}/antenna" for i in range(len(receivers))),
                carrier=repr(float(case.carrier_hz)),
                depth=case.depth,
                walls=case.walls,
                diffraction="on" if case.diffraction else "off",
                more=more,
            )
        )
        return file

    def points_file(self, case, receivers):
        file = self.work / f"{case.name}.csv"
        file.write_text("x_m,y_m,z_m\n" + "".join(triple(p).replace(" ", "") + "\n" for p in receivers))
        return file

    def answer(self, case, receivers):
        return json.loads(
            self.run(
                "paths",
                self.scenario(case, receivers[:1]),
                "--assets",
                self.scenes,
                "--receivers",
                self.points_file(case, receivers),
                "--json",
            )
        )

    def paths(self, case, receivers):
        scale = case.wavelength / (4 * np.pi)
        out = []
        for r in self.answer(case, receivers)["receivers"]:
            for p in r["paths"]:
                transfer = np.array(p["transfer_per_m"], float)
                angles = [
                    np.array([p[k]["zenith_rad"], p[k]["azimuth_rad"]]) for k in ("departure", "arrival")
                ]
                out.append(
                    Path(
                        r["index"],
                        "" if p["chain"] == "LoS" else p["chain"],
                        np.array(p["vertices_m"], float),
                        p["delay_s"],
                        *angles,
                        scale * (transfer[:, 0] + 1j * transfer[:, 1]).reshape(2, 2),
                        [i["materials"][0] for i in p["interactions"]],
                        p["id"],
                    )
                )
        return out

    def response(self, case, receivers, tx_antenna="", rx_antenna="", more=""):
        """Returns H [rx, rx_ant, tx_ant, subcarrier] of a generated data set."""
        folder = self.work / f"dataset_{case.name}"
        shutil.rmtree(folder, ignore_errors=True)
        self.run(
            "generate",
            self.scenario(case, receivers, tx_antenna, rx_antenna, more),
            "--assets",
            self.scenes,
            "-o",
            folder,
        )
        return np.load(folder / "sequence_0000" / "csi" / "cfr.npy")[0, :, :, 0, :, 0, :]

    def recall(self, case, receivers):
        """Returns the figures of `greatx bench --recall`: found, missing, doubled and extra paths, compared
        with greatx's exhaustive reference."""
        return json.loads(
            self.run(
                "bench",
                self.scenario(case, receivers[:1]),
                "--assets",
                self.scenes,
                "--recall",
                "--receivers",
                self.points_file(case, receivers),
                "--depth",
                case.depth,
                "--walls",
                case.walls,
                "--max-rays",
                0,
                "--json",
            )
        )
