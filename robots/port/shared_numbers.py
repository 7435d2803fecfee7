"""Numbers that one process writes and another reads at any time, lock-free and wait-free.

One writer, two copies: the writer fills the older copy, then increments the count that
selects the newer one. A writer killed or suspended in mid-write corrupts only the copy that nobody
reads. Plain aligned 8-byte stores in program order suffice on x86-64.
"""

from __future__ import annotations

import mmap
import os

import numpy as np

from robots.port import Array

_COUNT_BYTES = 8
# A reader superseded by two writes while it copies retries; it never needs more retries than this.
_TRIES = 100


class SharedNumbers:
    """A double-buffered float64 array in a shared file, with its write count."""

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
        """Return a consistent copy of the latest numbers, without waiting for the writer."""
        for _ in range(_TRIES):
            count = int(self._count[0])
            copy = self._copies[count % 2].copy()
            if int(self._count[0]) == count:
                self._last = copy
                break
        return self._last.copy()

    def close(self) -> None:
        """Release the memory."""
        del self._count, self._copies
        self._memory.close()
