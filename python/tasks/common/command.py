# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The command line of a task: its options, its folder, its device."""
from __future__ import annotations

import argparse
import dataclasses
import json
import pathlib
import platform
import sys
from typing import Any, Callable, Dict, List, Optional

import torch

import greatx
from greatx.errors import Error

from .config import changed, load_config, to_dict
from .files import write_text


@dataclasses.dataclass(frozen=True)
class Context:
    """What a run of a task is asked for."""

    config: Any  #: the task's dataclass
    preset: str  #: "published", "small" or "quick"
    out: pathlib.Path  #: the run's folder, which exists
    seeds: List[int]
    device: torch.device
    tensorboard: bool


def parser(doc: str, data_help: Optional[str]) -> argparse.ArgumentParser:
    """Returns a parser with the options that all tasks share. The first line of `doc` describes the task.
    Without `data_help`, the task takes no data.
    """
    out = argparse.ArgumentParser(
        description=doc.strip(), formatter_class=argparse.RawDescriptionHelpFormatter
    )
    if data_help is not None:
        out.add_argument("data", type=pathlib.Path, metavar="DATA", help=data_help)
    out.add_argument("-o", "--out", type=pathlib.Path, required=True, help="folder of the results")
    size = out.add_mutually_exclusive_group()
    size.add_argument("--small", action="store_true", help="the reduced size, for two cores")
    size.add_argument(
        "--quick", action="store_true", help="the size of the tests, whose figures mean nothing"
    )
    out.add_argument("--set", action="append", default=[], metavar="FIELD=VALUE", dest="sets")
    out.add_argument("--seeds", type=int, nargs="+", default=None, help="seeds of the trainings (1 2 3)")
    out.add_argument("--device", default="auto", help="auto (a GPU if there is one), cpu, or a name of torch")
    out.add_argument("--threads", type=int, default=None, help="threads of the CPU (torch's own number)")
    out.add_argument("--tensorboard", action="store_true", help="write TensorBoard's files, too")
    return out


def start(options: argparse.Namespace, cls: type, folder: pathlib.Path) -> Context:
    """Reads the configuration of the task in `folder`, makes the folder of the run or finds it with the same
    configuration, and prepares torch. Raises Error if the folder holds a run of another configuration.
    """
    preset = "small" if options.small else "quick" if options.quick else None
    config = load_config(cls, folder, preset, options.sets)
    seeds = options.seeds or ([1] if options.quick else [1, 2, 3])
    if len(set(seeds)) != len(seeds) or min(seeds) < 0:
        raise Error(f"--seeds: expected different numbers from 0 on, found {seeds}")
    if options.threads is not None:
        if options.threads < 1:
            raise Error(f"--threads: expected 1 or more, found {options.threads}")
        torch.set_num_threads(options.threads)
    device = find_device(options.device)
    deterministic()
    data = getattr(options, "data", None)
    request = {"config": to_dict(config), "data": None if data is None else str(data.resolve())}
    _claim(options.out, request)
    return Context(config, preset or "published", options.out, seeds, device, options.tensorboard)


def find_device(name: str) -> torch.device:
    """Returns the device of a name; "auto" is the first GPU, or the CPU without one. Raises Error."""
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    try:
        device = torch.device(name)
        torch.zeros(1, device=device)
    except (RuntimeError, AssertionError) as error:
        raise Error(f"--device {name}: expected auto, cpu or a device that is here: {error}") from None
    return device


def deterministic() -> None:
    """Makes torch choose kernels with the same result in every run, on the CPU and on a GPU."""
    torch.use_deterministic_algorithms(True, warn_only=True)
    torch.backends.cudnn.benchmark = False
    torch.backends.cudnn.deterministic = True


def _claim(out: pathlib.Path, request: Dict[str, Any]) -> None:
    path = out / "request.json"
    if path.is_file():
        found = changed(json.loads(json.dumps(request)), json.loads(path.read_text()))
        if found is not None:
            name, now, then = found
            raise Error(
                f"{out}: holds a run with {name} = {then!r}, and this one has {now!r}: expected the same "
                "(the run then goes on), or another folder"
            )
        return
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise Error(f"{out}: expected a folder of this task, or none, found other files")
    out.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(request, indent=1) + "\n")


def machine(device: torch.device) -> Dict[str, Any]:
    """Returns the device, the number of threads and the versions, for reports."""
    name = torch.cuda.get_device_name(device) if device.type == "cuda" else _processor()
    return {
        "device": f"{device.type}: {name}",
        "threads": torch.get_num_threads(),
        "torch": torch.__version__,
        "python": platform.python_version(),
        "greatx": greatx.__version__,
    }


def _processor() -> str:
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def main(function: Callable[[], None]) -> None:
    """Runs a task. An error of greatx is printed in one line, with exit code 2; Ctrl-C gives 130."""
    try:
        function()
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("stopped; the same command goes on after the last epoch", file=sys.stderr)
        sys.exit(130)
