# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Errors that describe a fault in the data or the arguments, and its place."""


class Error(ValueError):
    """Reports bad input to a simulation. The message names the file or argument, the expected and the found
    value."""


class DatasetError(Error):
    """Reports a data set that cannot be read as requested. The message names the file, the expected and the
    found value.
    """
