# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the files of a data set, whose contents are not trusted. Paths must stay below the data set's folder,
must not contain a symbolic link, and must lead to plain files. Errors that parsers raise on damaged data
become a DatasetError that names the file.
"""
from __future__ import annotations

import contextlib
import json
import math
import os
import pathlib
import re
import stat
import struct
import tokenize
import zlib
from fractions import Fraction
from typing import Any, Iterator, List, Union

from .errors import DatasetError, Error

Path = Union[str, "os.PathLike[str]"]

#: Largest size of a file that is read as a whole, and of one array of a record, bytes.
LARGEST = 4 << 30
LARGEST_JSON = 64 << 20
MOST_SEQUENCES, MOST_TICKS, MOST_SENSORS, MOST_ARRAYS, MOST_AXES = 10**6, 10**12, 10**4, 256, 16

#: Exceptions that the parsers of Python and NumPy raise on damaged data.
NONSENSE = (
    ArithmeticError,
    AttributeError,
    EOFError,
    LookupError,
    MemoryError,
    RecursionError,
    SyntaxError,
    TypeError,
    ValueError,
    struct.error,
    tokenize.TokenError,
    zlib.error,
)


@contextlib.contextmanager
def interpreting(what: Any) -> Iterator[None]:
    """Converts exceptions that damaged data cause within the context to a DatasetError that begins with
    `what`, the file.
    """
    try:
        yield
    except (Error, OSError):
        raise
    except NONSENSE as error:
        raise DatasetError(f"{what}: is damaged: {type(error).__name__}: {str(error)[:200]}") from error


@contextlib.contextmanager
def reading(what: Any) -> Iterator[None]:
    """Converts exceptions like interpreting(), and also an OSError of reading the file."""
    try:
        with interpreting(what):
            yield
    except OSError as error:
        raise DatasetError(f"{what}: cannot be read: {error.strerror or error}") from error


def is_inside(relative: str) -> bool:
    """Returns whether `relative` can be a path below a folder."""
    parts = relative.split("/")
    return all(part not in ("", ".", "..") and "\\" not in part and part.isprintable() for part in parts)


def inside(folder: pathlib.Path, relative: str) -> pathlib.Path:
    """Returns folder / relative. Raises DatasetError if the path leads out of the folder or contains a
    symbolic link.
    """
    if not is_inside(relative):
        raise DatasetError(f"{folder}: expected a path below the data set's folder, found {relative[:200]!r}")
    path = folder
    for part in relative.split("/"):
        path = path / part
        with reading(path):
            if path.is_symlink():
                raise DatasetError(f"{path}: expected no symbolic link in a data set, found one")
    return path


def check_plain(path: Path, most: int = LARGEST) -> None:
    """Raises DatasetError unless `path` is a plain file of at most `most` bytes and no symbolic link."""
    with reading(path):
        status = os.lstat(path)
    if not stat.S_ISREG(status.st_mode):
        raise DatasetError(
            f"{path}: expected a file, found "
            + ("a symbolic link" if stat.S_ISLNK(status.st_mode) else "something else")
        )
    if status.st_size > most:
        raise DatasetError(f"{path}: expected at most {most} bytes, found {status.st_size}")


def read_bytes(path: Path, most: int = LARGEST) -> bytes:
    check_plain(path, most)
    with reading(path):
        return pathlib.Path(path).read_bytes()


def inflate(data: bytes, most: int) -> bytes:
    """Unpacks zlib's format. Raises ValueError if the data are incomplete or unpack to more than `most`
    bytes.
    """
    unpacker = zlib.decompressobj()
    plain = unpacker.decompress(data, most + 1)
    if len(plain) > most:
        raise ValueError(f"unpacks to more than {most} bytes")
    if not unpacker.eof:
        raise ValueError("the packed data are cut off")
    return plain


def _show(value: Any) -> str:
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    text = ascii(value)
    return text if len(text) <= 60 else text[:60] + "..."


class Field:
    """Holds a value of untrusted JSON. Getters raise DatasetError, which names the file, the field, and the
    expected and the found value.
    """

    def __init__(self, file: Any, value: Any, name: str = ""):
        self.file = file
        self.value = value
        self.name = name

    def fail(self, expected: str) -> DatasetError:
        name = ascii(self.name)[1:-1]
        return DatasetError(
            f"{self.file}: {name}{': ' if name else ''}expected {expected}, found {_show(self.value)}"
        )

    def __contains__(self, key: str) -> bool:
        return isinstance(self.value, dict) and key in self.value

    def __getitem__(self, key: str) -> "Field":
        if not isinstance(self.value, dict):
            raise self.fail("an object")
        if key not in self.value:
            raise DatasetError(
                f"{self.file}: {self.name}{'.' if self.name else ''}{key}: expected a value, found none"
            )
        return Field(self.file, self.value[key], f"{self.name}{'.' if self.name else ''}{key}")

    def items(self, most: int) -> List["Field"]:
        if not isinstance(self.value, list) or len(self.value) > most:
            raise self.fail(f"a list of at most {most}")
        return [Field(self.file, value, f"{self.name}[{i}]") for i, value in enumerate(self.value)]

    def object(self) -> dict:
        if not isinstance(self.value, dict):
            raise self.fail("an object")
        return self.value

    def text(self) -> str:
        if not isinstance(self.value, str):
            raise self.fail("a string")
        return self.value

    def integer(self, least: int, most: int) -> int:
        if not isinstance(self.value, int) or isinstance(self.value, bool) or not least <= self.value <= most:
            raise self.fail(f"an integer from {least} to {most}")
        return self.value

    def number(self, least: float, most: float) -> float:
        good = isinstance(self.value, (int, float)) and not isinstance(self.value, bool)
        if not good or not least <= self.value <= most:
            raise self.fail(f"a number from {least:g} to {most:g}")
        return self.value

    def rate(self) -> Fraction:
        """Returns a rate, which must be a positive rational number of Hz with numerator and denominator up to
        10^12."""
        text = self.text()
        if re.fullmatch(r"[0-9]{1,19}(/[0-9]{1,19}|\.[0-9]{1,19})?", text, re.ASCII) and not re.search(
            r"/0+$", text
        ):
            rate = Fraction(text)
            if 0 < rate.numerator <= 10**12 and rate.denominator <= 10**12:
                return rate
        raise self.fail("a positive rational number of Hz, of numbers up to 10^12")


def read_json(path: pathlib.Path) -> Field:
    """Returns the contents of a JSON file. Raises DatasetError if the file is too large or not JSON."""
    data = read_bytes(path, LARGEST_JSON)
    try:
        return Field(path, json.loads(data.decode("utf-8")))
    except json.JSONDecodeError as error:
        raise DatasetError(f"{path}:{error.lineno}: is no JSON: {error.msg}") from error
    except (ValueError, RecursionError) as error:  # no UTF-8, a number of too many digits, nested too deeply
        raise DatasetError(f"{path}: is no JSON: {error}") from error


def bytes_of_shape(shape: Any, itemsize: int) -> int:
    return math.prod([max(1, int(n)) for n in shape]) * itemsize
