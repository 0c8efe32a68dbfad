# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Errors that describe a fault in the data or the arguments, and its place."""

import difflib
import sys
import types
from typing import Iterable, Optional, Type


class Error(ValueError):
    """Reports bad input to a simulation. The message names the file or argument, the expected and the found
    value."""


class DatasetError(Error):
    """Reports a data set that cannot be read as requested. The message names the file, the expected and the
    found value.
    """


def print_errors_plainly() -> None:
    """For scripts: an error of greatx that nobody catches is from now on printed as one line without a
    traceback. So is a missing compiled module or package that a message of greatx names. The exit code stays
    1. Other errors keep their traceback.
    """
    before = sys.excepthook

    def hook(kind: Type[BaseException], error: BaseException, trace: Optional[types.TracebackType]) -> None:
        named = isinstance(error, ImportError) and str(error).startswith("greatx.")
        if isinstance(error, Error) or named:
            print(f"error: {error}", file=sys.stderr)
        else:
            before(kind, error, trace)

    sys.excepthook = hook


def nearest(word: object, names: Iterable[str]) -> str:
    """Returns " (did you mean 'x'?)" for the name that is most like the word; "" if none is like it."""
    close = difflib.get_close_matches(str(word), list(names), 1)
    return f" (did you mean {close[0]!r}?)" if close else ""
