# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the folder of an exporter whole or not at all, puts pictures into it, and shows progress.

An exporter writes below OUT.part beside OUT. When everything is written, the folder gets its name. If the
exporter fails or is interrupted, OUT.part is removed; if it is killed, OUT.part stays and the next run
removes it. OUT itself is therefore always complete.
"""

from __future__ import annotations

import contextlib
import errno
import os
import pathlib
import shutil
import signal
import sys
import threading
import time
from typing import Any, Iterator, Union

from ..files import check_plain

#: File in an unfinished folder, by which a later run knows that it may remove the folder.
MARK = ".greatx-unfinished"


def _take(path: pathlib.Path, out: pathlib.Path) -> None:
    """Makes the unfinished folder anew. Raises FileExistsError if there is something that is none."""
    if path.is_symlink() or path.exists():
        if path.is_symlink() or not (path / MARK).is_file():
            raise FileExistsError(
                f"{path}: exists, but is no unfinished export of {out}; nothing is overwritten"
            )
        shutil.rmtree(path)
    path.mkdir(parents=True)
    (path / MARK).touch()


@contextlib.contextmanager
def terminated_as_interrupted() -> Iterator[None]:
    """Turns SIGTERM into KeyboardInterrupt, so that the unfinished folder is removed. Signals can be handled
    in the main thread alone."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(number: int, frame: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before if before is not None else signal.SIG_DFL)


@contextlib.contextmanager
def new_folder(out: Union[str, "os.PathLike[str]"]) -> Iterator[pathlib.Path]:
    """Gives a folder to write into, which becomes `out` at the end of the context. Raises FileExistsError if
    `out` exists and is not an empty folder."""
    target = pathlib.Path(os.path.abspath(out))
    if target.is_symlink() or target.exists():
        if target.is_symlink() or not target.is_dir() or any(target.iterdir()):
            raise FileExistsError(f"{out}: exists and is no empty folder; nothing is overwritten")
    part = target.with_name(target.name + ".part")
    _take(part, target)
    try:
        with terminated_as_interrupted():
            yield part
            (part / MARK).unlink()
            if target.is_dir():
                target.rmdir()  # it is empty
            os.rename(part, target)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        raise


def place(source: pathlib.Path, target: pathlib.Path, link: bool) -> None:
    """Copies a file byte by byte, or makes a hard link to it if `link` is set and both are on one file
    system. The source must be a plain file of the data set."""
    check_plain(source)
    target.parent.mkdir(parents=True, exist_ok=True)
    if link:
        try:
            os.link(source, target)
            return
        except OSError as error:
            if error.errno not in (errno.EXDEV, errno.EPERM, errno.EOPNOTSUPP, errno.EMLINK):
                raise
    shutil.copyfile(source, target)


class Progress:
    """Shows on a terminal how many of `total` steps are done, and an estimate of the time that is left. The
    first line comes after two seconds, so that short conversions print nothing."""

    def __init__(self, total: int, what: str):
        self._total, self._what = total, what
        self._done, self._begin, self._shown = 0, time.monotonic(), 0.0
        self._on = sys.stderr.isatty()

    def step(self) -> None:
        self._done += 1
        now = time.monotonic()
        if not self._on or now - self._begin < 2.0 or now - max(self._shown, 0.0) < 0.5:
            return
        self._shown = now
        left = (now - self._begin) / self._done * (self._total - self._done)
        text = f"{self._done} of {self._total} {self._what}, about {left:.0f} s left"
        print(f"\r{text:<70}", end="\n" if self._done == self._total else "", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self._shown and self._done < self._total:
            print(file=sys.stderr)
