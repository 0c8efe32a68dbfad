# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the data sets of the task by the program greatx."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import sys
import time
from typing import Any, List, Sequence

import greatx
from greatx.errors import Error

from .settings import Data

SCENARIO = pathlib.Path(__file__).with_name("scenario.yaml")
#: python/tasks/throughput is below it.
PROJECT = pathlib.Path(__file__).resolve().parents[3]


def program() -> str:
    """Returns the program: $GREATX_PROGRAM, that of the release build, or greatx of the path."""
    built = PROJECT / "build" / "release" / "greatx"
    found = os.environ.get("GREATX_PROGRAM") or (str(built) if built.is_file() else shutil.which("greatx"))
    if not found:
        raise Error(
            f"expected the program greatx at {built} (./run.sh builds it), on the path, or in "
            "$GREATX_PROGRAM, found none"
        )
    return found


def generate(out: pathlib.Path, data: Data, storage: str) -> greatx.Dataset:
    """Returns the data set of a kind of storage in `out`, made or finished if it is not there."""
    folder = out / f"data_{storage}"
    if not (folder / "manifest.json").is_file():
        begin = time.monotonic()
        command: List[str] = [program(), "generate", str(SCENARIO), "-o", str(folder), "-q", "--resume"]
        command += ["--compression", storage, "--sequences", str(data.sequences), "--ticks", str(data.ticks)]
        command += ["--seed", str(data.seed)]
        print(f"data set of {data.sequences * data.ticks} items, storage {storage}", file=sys.stderr)
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            raise Error(f"{' '.join(command)}: {done.stderr.strip()[-500:]}")
        print(f"  took {time.monotonic() - begin:.0f} s", file=sys.stderr)
    return greatx.load(folder)


def bytes_of(dataset: greatx.Dataset, arrays: Sequence[str]) -> int:
    """Returns the bytes of the files that hold arrays, "SENSOR/ARRAY", in all sequences."""
    return sum(
        _bytes(sequence[sensor], array)
        for sequence in dataset.sequences
        for sensor, array in (name.rsplit("/", 1) for name in arrays)
    )


def _bytes(sensor: Any, array: str) -> int:
    output, _ = sensor.info.locate(array)
    base = sensor.sequence.path / sensor.name / output.name
    if base.is_dir():
        return sum(entry.stat().st_size for entry in base.iterdir())
    names = (f"{base.name}.npy", f"{base.name}_offsets.npy", f"{base.name}.h5")
    total = sum(f.stat().st_size for f in base.parent.iterdir() if f.name in names)
    return total // len(output.arrays)  # several arrays share a packed file
