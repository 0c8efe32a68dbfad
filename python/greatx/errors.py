# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Errors that tell what is wrong with the data or the arguments, and where."""


class Error(ValueError):
    """Bad input to a simulation: the message names the file or argument, what was expected and what was
    found."""


class DatasetError(Error):
    """A data set that cannot be read as asked: the message names the file, what was expected and what was
    found."""
