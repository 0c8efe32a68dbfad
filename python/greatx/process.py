# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Guards objects of the engine against use in a forked process. Such objects belong to the process that made
them, because their threads and their device do not survive fork().
"""
from __future__ import annotations

import os
from typing import Any

from .errors import Error


class Owned:
    """Passes attributes on to an object of the engine. Raises Error if this process is a fork of the one that
    made the object, because the call would wait for ever.
    """

    def __init__(self, native: Any):
        self._native = native
        self._process = os.getpid()

    def __getattr__(self, name: str) -> Any:
        fields = self.__dict__
        if name.startswith("_") or "_native" not in fields:
            raise AttributeError(name)
        if os.getpid() != fields["_process"]:
            raise Error(
                f"this simulation was made by process {fields['_process']}, "
                f"of which process {os.getpid()} is a fork: its device cannot be used here. "
                "Make a greatx.Simulation in each process, or start processes by 'spawn' "
                "(multiprocessing.set_start_method)"
            )
        return getattr(fields["_native"], name)
