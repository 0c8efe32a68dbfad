# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Asks Sionna RT for its paths."""
import pathlib
import re
import shutil

import mitsuba as mi
import numpy as np
import sionna.rt as rt

from sionna_paths import Path

LETTERS = {0: "", 1: "R", 2: "S", 4: "T", 8: "D"}


def scene_file(case, work):
    """Returns the scene's XML file. If the case names a material, returns a copy with this material."""
    file = pathlib.Path(getattr(rt.scene, case.scene))
    if not case.material:
        return file
    folder = work / "scenes" / f"{case.scene}_{case.material}"
    shutil.copytree(file.parent, folder, dirs_exist_ok=True)
    copy = folder / f"{folder.name}.xml"
    text, changes = re.subn(
        r'(<string name="type" value=)"[a-z_]+"', rf'\1"{case.material}"', file.read_text()
    )
    assert changes > 0
    copy.write_text(text)
    return copy


class Sionna:
    """Holds a scene with one transmitter and any number of receivers."""

    def __init__(self, case, work):
        self.case = case
        self.scene = rt.load_scene(str(scene_file(case, work)))
        self.scene.frequency = case.carrier_hz
        self.antennas("iso", "VH", 1, 1)
        self.scene.add(rt.Transmitter("tx", mi.Point3f(*case.transmitter)))

    def antennas(
        self, pattern, polarization, rows, columns, vertical=0.5, horizontal=0.5, receiver=("iso", "VH")
    ):
        """Sets the transmitter's array. The receivers have one element."""
        self.scene.tx_array = rt.PlanarArray(
            num_rows=rows,
            num_cols=columns,
            vertical_spacing=vertical,
            horizontal_spacing=horizontal,
            pattern=pattern,
            polarization=polarization,
        )
        self.scene.rx_array = rt.PlanarArray(
            num_rows=1, num_cols=1, pattern=receiver[0], polarization=receiver[1]
        )

    def place(self, receivers):
        for name in list(self.scene.receivers):
            self.scene.remove(name)
        for i, position in enumerate(receivers):
            self.scene.add(rt.Receiver(f"rx{i}", mi.Point3f(*map(float, position))))

    def solve(self, samples=1e6, deterministic=False, seed=42, synthetic_array=True, table=1e6):
        case = self.case
        solver = rt.PathSolver(deterministic=deterministic)
        return solver(
            self.scene,
            max_depth=case.depth,
            samples_per_src=int(samples),
            max_num_paths_per_src=int(table),
            specular_reflection=case.reflection,
            refraction=case.walls > 0,
            diffraction=case.diffraction,
            synthetic_array=synthetic_array,
            seed=seed,
        )

    def paths(self, receivers, first=0, **options):
        """Returns the Path objects of all receivers, solved in one call. Receivers are numbered from `first`
        on."""
        self.place(receivers)
        return self.extract(self.solve(**options), receivers, first)

    def each_alone(self, receivers, **options):
        """Returns the same, solved with one receiver in each call, which is Sionna RT's best setting."""
        out = []
        self.place(receivers[:1])
        device = self.scene.receivers["rx0"]
        for i, position in enumerate(receivers):
            device.position = mi.Point3f(*map(float, position))
            out += self.extract(self.solve(**options), [position], i)
        return out

    def extract(self, paths, receivers, first):
        valid = np.array(paths.valid)
        if valid.size == 0 or not valid.any():
            return []
        kinds, vertices = np.array(paths.interactions), np.array(paths.vertices, dtype=float)
        delay = np.array(paths.tau, dtype=float)
        angles = [np.array(a, dtype=float) for a in (paths.theta_t, paths.phi_t, paths.theta_r, paths.phi_r)]
        a = np.array(paths.a[0], dtype=float) + 1j * np.array(paths.a[1], dtype=float)
        out = []
        for r, t, i in np.argwhere(valid):
            letters = "".join(LETTERS[int(k)] for k in kinds[:, r, t, i])
            points = np.vstack(
                [self.case.transmitter, vertices[: len(letters), r, t, i], receivers[r]]
            ).astype(float)
            tz, ta, rz, ra = (v[r, t, i] for v in angles)
            out.append(
                Path(
                    int(r) + first,
                    letters,
                    points,
                    float(delay[r, t, i]),
                    np.array([tz, ta]),
                    np.array([rz, ra]),
                    a[r, :2, t, :2, i],
                )
            )
        return out
