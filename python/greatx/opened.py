# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Keeps the arrays that were used last open, and lets go of others, so that any number of data sets can be
read by a process that may open few files.
"""

from __future__ import annotations

import collections
import threading
from typing import Any, Callable, Hashable, Tuple

#: Arrays that stay open. An array takes up to two file handles; Linux allows a process 1024 by default.
MOST_OPEN = 256


class OpenArrays:
    """Holds opened objects by key. Beyond `most`, lets go of those that were used longest ago; their files
    close when nothing else refers to them. A pickled or forked copy opens files of its own.
    """

    def __init__(self, most: int = MOST_OPEN):
        if most < 1:
            raise ValueError(f"expected 1 or more open arrays, found {most}")
        self.most = most
        self._objects: "collections.OrderedDict[Hashable, Any]" = collections.OrderedDict()
        self._lock = threading.RLock()

    def get(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Returns the object of this key; calls make() if there is none."""
        with self._lock:
            if key in self._objects:
                self._objects.move_to_end(key)
                return self._objects[key]
            made = make()
            self._objects[key] = made
            while len(self._objects) > self.most:
                self._objects.popitem(last=False)
            return made

    def drop(self, wanted: Callable[[Any], bool]) -> None:
        """Lets go of the objects whose keys are wanted."""
        with self._lock:
            for key in [k for k in self._objects if wanted(k)]:
                del self._objects[key]

    def __len__(self) -> int:
        return len(self._objects)

    def __reduce__(self) -> Tuple[Any, Tuple[int]]:
        return OpenArrays, (self.most,)
