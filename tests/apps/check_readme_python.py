# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_readme_python.py README PROGRAM: runs the README's lines of Python on a data set made for the purpose.

torch is not a package that the tests may need, so a stand-in with NumPy's semantics takes the place of
torch.from_numpy; everything before it is the README's own text.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import types

import numpy

SCENARIO = """
greatx: 1
name: readme
ticks: 3
tick_rate_hz: 10
nodes:
  - name: bs
    trajectory: {type: static, position_m: [0, 0, 10]}
    sensors: [{name: panel, type: antenna, rows: 2, columns: 2}]
  - name: uav
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [50, 0, 20]}, {t_s: 1, position_m: [60, 0, 20]}]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 8, bandwidth_hz: 20e6}
"""


def main(readme: str, program: str) -> int:
    blocks = re.findall(r"```python\n(.*?)```", pathlib.Path(readme).read_text(), re.DOTALL)
    code = [block for block in blocks if "torch.from_numpy" in block]
    assert len(code) == 1, f"the README has {len(code)} blocks with torch.from_numpy, expected one"
    with tempfile.TemporaryDirectory() as folder:
        scenario = pathlib.Path(folder, "readme.yaml")
        scenario.write_text(SCENARIO)
        subprocess.run([program, "generate", scenario, "-o", os.path.join(folder, "out/demo"), "-q"], check=True)
        os.chdir(folder)
        sys.modules["torch"] = types.SimpleNamespace(from_numpy=numpy.asarray)
        scope: dict = {}
        exec(compile(code[0], "README.md", "exec"), scope)
        csi = scope["csi"]
        assert csi.shape == (3, 1, 1, 1, 4, 1, 8), csi.shape
        assert csi.dtype == numpy.complex64, csi.dtype
        # Free space: |H| = lambda / (4 pi d), d from (0, 0, 10) to (50, 0, 20).
        expected = 299792458.0 / 3.5e9 / (4 * numpy.pi * numpy.hypot(50.0, 10.0))
        assert numpy.allclose(numpy.abs(csi[0]), expected, rtol=1e-5), (numpy.abs(csi[0]).ravel()[:4], expected)
    print("the README's lines work")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
