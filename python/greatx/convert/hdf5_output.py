# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Opens HDF5 files for writing so that a full disk is one error of the operating system.

HDF5 writes parts of a file when objects are closed, and h5py reports a failure there as several errors, some
of which cannot be caught. The file is therefore given to h5py as a Python object. The object keeps the first
error, drops everything that is written after it, and lets the caller raise the error at the end.
"""

from __future__ import annotations

import contextlib
import os
import pathlib
from typing import Any, Iterator, Optional


class _Guarded:
    """A file that remembers its first error."""

    def __init__(self, path: pathlib.Path):
        self._file = open(path, "w+b", buffering=0)
        self.error: Optional[OSError] = None

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def readinto(self, buffer: Any) -> int:
        return self._file.readinto(buffer) or 0

    def read(self, size: int = -1) -> bytes:
        return self._file.read(size) or b""

    def write(self, data: Any) -> int:
        view = memoryview(data).cast("B")
        done = 0
        while self.error is None and done < len(view):
            try:
                done += self._file.write(view[done:]) or 0
            except OSError as error:
                self.error = error
        return len(view)

    def truncate(self, size: Optional[int] = None) -> int:
        if self.error is None:
            try:
                return self._file.truncate(size)
            except OSError as error:
                self.error = error
        return 0

    def flush(self) -> None:
        pass

    def close(self) -> None:
        self._file.close()


class _Checked:
    """Passes attributes on to an h5py.File. `check` raises the first error of its file."""

    def __init__(self, file: Any, guarded: _Guarded, path: pathlib.Path):
        self.file, self._guarded, self._path = file, guarded, path

    def check(self) -> None:
        error = self._guarded.error
        if error is not None:
            raise OSError(error.errno, error.strerror, str(self._path))


@contextlib.contextmanager
def hdf5_file(h5py: Any, path: pathlib.Path) -> Iterator[_Checked]:
    """Gives `.file`, a new h5py.File, and `.check()`, which long loops call. Raises OSError if the file could
    not be written as a whole."""
    guarded = _Guarded(path)
    try:
        with h5py.File(guarded, "w", libver=("earliest", "v110")) as file:
            checked = _Checked(file, guarded, path)
            yield checked
        checked.check()
    finally:
        guarded.close()
