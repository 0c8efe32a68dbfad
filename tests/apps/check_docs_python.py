# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_docs_python.py PROGRAM DATASET_MD README_MD PACKAGE: runs the Python code of two pages.

The block of docs/dataset.md runs on a data set with known values, which is made for the purpose. The block of
README.md runs on the first ticks of the default scenario with the built package. Without a compiled module
(PACKAGE is empty) it is left out. The listings of docs/tutorial.md are compared with the example that they
explain. The tests may not need the package torch, so a stand-in with NumPy's semantics takes its place.
Everything else is the pages' own text.
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
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [50, 0, 20]}, \
{t_s: 1, position_m: [60, 0, 20]}]}
    sensors: [{name: antenna, type: antenna}]
channels:
  - {name: csi, tx: bs/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 8, bandwidth_hz: 20e6}
"""


def block_with(page: str, word: str) -> str:
    blocks = re.findall(r"```python\n(.*?)```", pathlib.Path(page).read_text(), re.DOTALL)
    code = [block for block in blocks if word in block]
    assert len(code) == 1, f"{page} has {len(code)} blocks with {word}, expected one"
    return code[0]


def stand_in_for_torch() -> None:
    torch = types.ModuleType("torch")
    torch.from_numpy = numpy.asarray
    torch.Tensor = numpy.ndarray
    torch.utils = types.ModuleType("torch.utils")
    torch.utils.data = types.ModuleType("torch.utils.data")
    torch.utils.data.Dataset = object
    sys.modules.update({"torch": torch, "torch.utils": torch.utils, "torch.utils.data": torch.utils.data})


def check_dataset_page(page: str, program: str) -> None:
    pathlib.Path("dataset.yaml").write_text(SCENARIO)
    subprocess.run([program, "generate", "dataset.yaml", "-o", "out/demo", "-q"], check=True)
    scope: dict = {}
    exec(compile(block_with(page, "torch.from_numpy"), page, "exec"), scope)
    csi = scope["csi"]
    assert csi.shape == (3, 1, 1, 1, 4, 1, 8), csi.shape
    assert csi.dtype == numpy.complex64, csi.dtype
    # Free space: |H| = lambda / (4 pi d), where d is the distance from (0, 0, 10) to (50, 0, 20).
    expected = 299792458.0 / 3.5e9 / (4 * numpy.pi * numpy.hypot(50.0, 10.0))
    assert numpy.allclose(numpy.abs(csi[0]), expected, rtol=1e-5), (numpy.abs(csi[0]).ravel()[:4], expected)


def check_readme(page: str, program: str, package: str) -> None:
    sys.path.insert(0, package)
    subprocess.run([program, "generate", "--ticks", "13", "-o", "out/demo", "-q"], check=True)
    scope: dict = {}
    exec(compile(block_with(page, "greatx.load"), page, "exec"), scope)
    sample = scope["data"][12]
    assert scope["tick"]["uav/front"].rgb.shape == (480, 640, 3), scope["tick"]["uav/front"].rgb.shape
    assert sample["csi/cfr"].shape[-1] == 256 and sample["uav/front/depth"].shape == (480, 640)
    h = scope["h"]
    assert h.dtype == numpy.complex64 and h.shape[0] == 1 and numpy.all(numpy.isfinite(h)), (h.dtype, h.shape)


def check_tutorial(page: str) -> None:
    """Checks that python/examples/tutorial.py, which docs/tutorial.md tells to run, contains the page's
    listings."""
    text = (pathlib.Path(page).parent / "../python/examples/tutorial.py").resolve().read_text()
    listings = [
        code
        for code in re.findall(r"```python\n(.*?)```", pathlib.Path(page).read_text(), re.DOTALL)
        if not code.startswith(">>>")
    ]
    assert len(listings) >= 5, f"{page}: expected five listings or more, found {len(listings)}"
    for code in listings:
        assert code in text, f"{page}: not in tutorial.py:\n{code}"


def main(program: str, dataset_page: str, readme: str, package: str) -> int:
    stand_in_for_torch()
    check_tutorial(str(pathlib.Path(dataset_page).with_name("tutorial.md")))
    for check in (
        lambda: check_dataset_page(dataset_page, program),
        lambda: check_readme(readme, program, package) if package else None,
    ):
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            check()
            os.chdir("/")
    print(
        "the pages' Python works"
        + ("" if package else "; README.md was left out, there is no compiled module")
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:5]))
