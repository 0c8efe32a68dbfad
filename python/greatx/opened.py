# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Keeps the arrays that were used last open, and lets go of others, so that any number of data sets can be
read by a process that may open few files.
"""

from __future__ import annotations

import collections
import contextlib
from typing import Any, Callable, Hashable, Tuple

#: Arrays that stay open. An array takes up to two file handles; Linux allows a process 1024 by default.
MOST_OPEN = 256


class OpenArrays:
    """Holds opened objects by key. Beyond `most`, lets go of those that were used longest ago; their files
    close when nothing else refers to them. A pickled copy opens files of its own.

    Several threads may use it: two of them may then open an object twice, of which one stays. There is no
    lock, which a forked process could find held for ever.
    """

    def __init__(self, most: int = MOST_OPEN):
        if most < 1:
            raise ValueError(f"expected 1 or more open arrays, found {most}")
        self.most = most
        self._objects: "collections.OrderedDict[Hashable, Any]" = collections.OrderedDict()

    def get(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Returns the object of this key; calls make() if there is none."""
        try:
            found = self._objects[key]
            self._objects.move_to_end(key)
            return found
        except KeyError:
            pass
        made = make()
        self._objects[key] = made
        with contextlib.suppress(KeyError):  # another thread has taken the last one
            while len(self._objects) > self.most:
                self._objects.popitem(last=False)
        return made

    def drop(self, wanted: Callable[[Any], bool]) -> None:
        """Lets go of the objects whose keys are wanted."""
        for key in [k for k in list(self._objects) if wanted(k)]:
            self._objects.pop(key, None)

    def __len__(self) -> int:
        return len(self._objects)

    def __reduce__(self) -> Tuple[Any, Tuple[int]]:
        return OpenArrays, (self.most,)
