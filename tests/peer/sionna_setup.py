# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Sets up the environment of Sionna RT. Uses the standard library alone, because it runs before there is
one."""
import ctypes.util
import glob
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = "sionna-rt==2.2.0"


def find_llvm():
    """Returns the LLVM library for Dr.Jit's kernels, or None. libllvm15 fails on Sionna RT's kernels, 19 does
    not."""
    found = sorted(
        glob.glob("/usr/lib/*/libLLVM.so.19*")
        + glob.glob("/usr/lib/*/libLLVM-19.so*")
        + glob.glob("/usr/lib/llvm-19/lib/libLLVM*.so*")
    )
    return found[0] if found else ctypes.util.find_library("LLVM-19")


def enter(work):
    """Returns only in a process whose Python has sionna.rt. Makes the venv if it is missing."""
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        library = find_llvm()
        if library is None:
            sys.exit(
                "sionna_rt.py: no libLLVM 19 found: apt-get install libllvm19 (or set DRJIT_LIBLLVM_PATH)"
            )
        os.environ["DRJIT_LIBLLVM_PATH"] = library
    venv = work / "venv"
    python, marker = venv / "bin" / "python", venv / "installed"
    if not marker.exists() or marker.read_text() != PACKAGE:
        print(f"setting up {venv} with {PACKAGE}", file=sys.stderr)
        work.mkdir(parents=True, exist_ok=True)
        subprocess.run([sys.executable, "-m", "venv", venv], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", PACKAGE], check=True)
        marker.write_text(PACKAGE)
    if pathlib.Path(sys.prefix).resolve() != venv.resolve():
        os.execv(python, [str(python), *sys.argv])


def program(options):
    """Returns the path of the greatx to run."""
    for path in (
        [options.greatx]
        if options.greatx
        else [ROOT / "build" / "release" / "greatx", ROOT / "build" / "greatx"]
    ):
        if path.exists():
            return path.resolve()
    sys.exit("sionna_rt.py: greatx is not built: scripts/build.sh release greatx, or name it with --greatx")
