# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the program on a case, in a folder of its own and within limits, and judges how the program ends."""
from __future__ import annotations

import dataclasses
import hashlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from case import OUTSIDE, Case
import pictures
import seeds

SECRET = "the-secret-that-no-input-may-reach-7f3a9c"
PRINTED_MOST = 4 << 20


@dataclasses.dataclass
class Limits:
    memory_mib: int = 4096  # address space; 0: unlimited
    cpu_s: int = 20
    wall_s: int = 60
    idle_s: int = 8  # longest time without use of the processor
    file_mib: int = 512
    python: str = ""  # folder of the Python package, for cases of kind `python`


@dataclasses.dataclass
class Verdict:
    fault: str  # empty if there is none
    exit: int
    printed: str
    seconds: float
    memory_mib: float


def is_sanitized(program: str) -> bool:
    return b"__asan_init" in pathlib.Path(program).read_bytes()


def environment(folder: pathlib.Path | None = None) -> dict[str, str]:
    """Returns the caller's environment without the caches that greatx keeps between runs. The driver's shader
    cache stays, because otherwise every start would compile the shaders again."""
    env = dict(
        os.environ,
        GREATX_CACHE="off",
        MESA_SHADER_CACHE_DIR=os.environ.get(
            "MESA_SHADER_CACHE_DIR", os.path.join(os.path.expanduser("~"), ".cache")
        ),
    )
    env.setdefault("ASAN_OPTIONS", "detect_leaks=0")
    env["UBSAN_OPTIONS"] = env.get("UBSAN_OPTIONS", "") + ":print_stacktrace=1"
    if folder is not None:
        env.update(
            HOME=str(folder / "home"), TMPDIR=str(folder / "home"), XDG_CACHE_HOME=str(folder / "home")
        )
    return env


def limiter(limits: Limits):
    def limit() -> None:
        if limits.memory_mib > 0:
            resource.setrlimit(resource.RLIMIT_AS, (limits.memory_mib << 20,) * 2)
        resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu_s, limits.cpu_s + 5))
        resource.setrlimit(resource.RLIMIT_FSIZE, (limits.file_mib << 20,) * 2)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    return limit


def snapshot(folder: pathlib.Path) -> dict[str, tuple]:
    """Returns the kind, size and time of change of everything below a folder. Does not follow links."""
    found = {}
    for root, folders, files in os.walk(os.fsencode(folder)):
        for name in folders + files:
            status = os.lstat(os.path.join(root, name))
            kind = status.st_mode
            found[
                os.path.relpath(os.path.join(root, name), os.fsencode(folder)).decode("utf-8", "replace")
            ] = (
                kind,
                status.st_size if not os.path.isdir(os.path.join(root, name)) else 0,
                status.st_mtime_ns if not os.path.isdir(os.path.join(root, name)) else 0,
            )
    return found


def difference(before: dict, after: dict) -> str:
    changed = [name for name in sorted(before.keys() | after.keys()) if before.get(name) != after.get(name)]
    return ", ".join(changed[:5])


def build_outside(folder: pathlib.Path) -> None:
    """Writes files beside the working folder that an escape would reach. They are sound files of several
    kinds."""
    folder.mkdir()
    (folder / "secret.txt").write_text(SECRET + "\n")
    (folder / "secret.png").write_bytes(pictures.png(4, 4))
    (folder / "secret.ply").write_bytes(seeds.plys()[0].data)
    (folder / "secret.bin").write_bytes(bytes(4096))


def unprintable(data: bytes) -> str:
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        return (
            f"no UTF-8 at byte {error.start} of what is printed: "
            f"{data[max(error.start - 20, 0):error.start + 10]!r}"
        )
    for at, c in enumerate(text):
        if (
            (ord(c) < 32 and c not in "\n\t")
            or 127 <= ord(c) < 160
            or ord(c) in (0x202A, 0x202B, 0x202C, 0x202D, 0x202E)
        ):
            return f"control character {ord(c):#x} in what is printed: {text[max(at - 20, 0):at + 10]!r}"
    return ""


def names_a_file(case: Case, printed: str) -> bool:
    names = [argument for argument in case.command if not argument.startswith("-")][1:]
    for name in case.files:
        names += [part for part in name.split("/") if part]
    names = [name for name in names if len(name) > 2 and name != "data"]  # "data" occurs in messages anyway
    return any(name in printed for name in [*names, "data/", "data:"])


def judge(
    case: Case, code: int, stdout: bytes, stderr: bytes, timed_out: bool, changes: str, sanitized: bool
) -> str:
    """Returns the first fault as `cause: detail`, or an empty string if there is none."""
    printed = (stdout + stderr).decode("utf-8", "replace")
    if sanitized and (b"AddressSanitizer" in stderr or b"runtime error:" in stderr):
        lines = [
            text
            for text in stderr.decode("utf-8", "replace").splitlines()
            if "ERROR: Add" in text or "runtime error:" in text
        ]
        return f"sanitizer: {lines[0] if lines else ''}"
    if timed_out:
        return "hang: killed at a limit of time"
    if code < 0:
        name = signal.Signals(-code).name
        return (
            f"hang: {name}, the limit of processor time"
            if name in ("SIGXCPU", "SIGKILL")
            else f"signal: {name}"
        )
    if code not in case.exit:
        last = [text for text in stderr.decode("utf-8", "replace").splitlines() if text]
        return f"exit: {code}, expected {' or '.join(map(str, case.exit))}: {(last or [''])[-1][:160]}"
    if b"Traceback (most recent call last)" in stderr:
        return "exit: a traceback: " + stderr.decode("utf-8", "replace").strip().splitlines()[-1][:160]
    if changes:
        return f"touched: {changes}"
    if unprintable(stdout + stderr):
        return "print: " + unprintable(stdout + stderr)
    if case.secret and (SECRET in printed or hashlib.sha256((SECRET + "\n").encode()).hexdigest() in printed):
        return "escape: what lies outside the folder is read, and shown"
    if code == 1 and case.names_file and not names_a_file(case, printed):
        return f"unnamed: {printed.strip()[:160]}"
    return ""


def wait(process: subprocess.Popen, limits: Limits) -> tuple[int, resource.struct_rusage, bool]:
    """Waits for the process. Returns its exit code, its usage, and whether it had to be killed: at the limit
    of time, or after so long without activity that it must be waiting for something that never comes (a
    FIFO).
    """
    begin = active = time.monotonic()
    ticks = ""
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid != 0:
            return os.waitstatus_to_exitcode(status), usage, False
        now = time.monotonic()
        stat = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        if ticks != " ".join(stat[11:13]) or stat[0] == "R":
            active, ticks = now, " ".join(stat[11:13])
        if now - begin > limits.wall_s or now - active > limits.idle_s:
            os.killpg(process.pid, signal.SIGKILL)
            _, status, usage = os.wait4(process.pid, 0)
            return os.waitstatus_to_exitcode(status), usage, True
        time.sleep(min(0.02, 0.002 + 0.1 * (now - begin)))


def run(
    program: str, case: Case, limits: Limits, sanitized: bool, into: pathlib.Path | None = None
) -> Verdict:
    folder = into or pathlib.Path(tempfile.mkdtemp(prefix="greatx_fuzz_"))
    work, outside = folder / "work", folder / "outside"
    for name in ("work", "home", "work/out"):
        (folder / name).mkdir(parents=True)
    build_outside(outside)
    case.lay_out(work, outside)
    inputs = snapshot(work) if case.keeps_files else {}
    around = {**snapshot(outside), **{name: 0 for name in os.listdir(folder)}}
    env = {**environment(folder), **case.env}
    begins = [program]
    if case.kind == "python":
        begins, env["PYTHONPATH"] = [
            sys.executable,
            str(pathlib.Path(__file__).with_name("read_dataset.py")),
        ], limits.python
    command = begins + [argument.replace(OUTSIDE, str(outside)) for argument in case.command]
    begin = time.monotonic()
    with open(folder / "stdout", "wb") as out, open(folder / "stderr", "wb") as err:
        process = subprocess.Popen(
            command,
            cwd=work,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            start_new_session=True,
            preexec_fn=limiter(limits),
        )
        code, usage, timed_out = wait(process, limits)
    process.returncode = code
    seconds = time.monotonic() - begin
    changes = difference(
        around,
        {**snapshot(outside), **{name: 0 for name in os.listdir(folder) if name not in ("stdout", "stderr")}},
    )
    if case.keeps_files and not changes:
        now = snapshot(work)
        changes = difference(
            inputs, {name: value for name, value in now.items() if not name.startswith("out/")}
        )
    with open(folder / "stdout", "rb") as out, open(folder / "stderr", "rb") as err:
        stdout, stderr = out.read(PRINTED_MOST), err.read(PRINTED_MOST)
    fault = judge(case, code, stdout, stderr, timed_out, changes, sanitized)
    if into is None:
        shutil.rmtree(folder, ignore_errors=True)
    return Verdict(
        fault, code, (stdout + stderr).decode("utf-8", "backslashreplace"), seconds, usage.ru_maxrss / 1024
    )
