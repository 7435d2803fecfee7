"""Numbers that one process writes and another reads at any time, without locks and without waiting.

One writer. There are two copies: the writer fills the one that is not the newest, then raises the count that
names the newest. A writer that was killed or suspended in mid-write has spoiled only the copy that nobody
reads. Plain aligned 8-byte stores in program order are enough on x86-64.
"""

from __future__ import annotations

import mmap
import os

import numpy as np

from robots.port import Array

_COUNT_BYTES = 8
# A reader that is overtaken by two writes while it copies looks again; more often than this it never is.
_TRIES = 100


class SharedNumbers:
    """An array of float64 in a shared file, twice, and how often it was written."""

    def __init__(self, descriptor: int, size: int) -> None:
        length = _COUNT_BYTES + 2 * 8 * size
        if os.fstat(descriptor).st_size < length:
            os.ftruncate(descriptor, length)
        self._memory = mmap.mmap(descriptor, length)
        self._count = np.frombuffer(self._memory, dtype=np.int64, count=1)
        self._copies = np.frombuffer(self._memory, dtype=np.float64, count=2 * size, offset=_COUNT_BYTES).reshape(2, -1)
        self._last = np.zeros(size)

    def write(self, values: Array) -> None:
        """Replace the numbers; only one process may."""
        count = int(self._count[0]) + 1
        self._copies[count % 2] = values
        self._count[0] = count

    def read(self) -> Array:
        """Return a consistent copy of the newest numbers, without ever waiting for the writer."""
        for _ in range(_TRIES):
            count = int(self._count[0])
            copy = self._copies[count % 2].copy()
            if int(self._count[0]) == count:
                self._last = copy
                break
        return self._last.copy()

    def close(self) -> None:
        """Let go of the memory."""
        del self._count, self._copies
        self._memory.close()
