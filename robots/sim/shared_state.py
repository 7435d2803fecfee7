"""Numbers that one process writes and another reads at any time, without locks (seqlock).

One writer. The reader takes a copy between two equal, even counts. Plain aligned 8-byte stores in
program order are enough on x86-64 and, with a retry, harmless elsewhere: a torn copy is noticed by
its count.
"""

from __future__ import annotations

import mmap
import os
import tempfile

import numpy as np

from robots.port import Array

_COUNT_BYTES = 8
_TRIES = 1_000


def new_shared_file() -> int:
    """Return the descriptor of an unnamed file in memory; it vanishes with its last user."""
    if hasattr(os, "memfd_create"):
        return os.memfd_create("flexcell-world")
    with tempfile.TemporaryFile() as file:
        return os.dup(file.fileno())


class SharedNumbers:
    """An array of float64 in a shared file, and how often it was written."""

    def __init__(self, descriptor: int, size: int) -> None:
        length = _COUNT_BYTES * (1 + size)
        if os.fstat(descriptor).st_size < length:
            os.ftruncate(descriptor, length)
        self._memory = mmap.mmap(descriptor, length)
        self._count = np.frombuffer(self._memory, dtype=np.int64, count=1)
        self._values = np.frombuffer(self._memory, dtype=np.float64, count=size, offset=_COUNT_BYTES)
        self._last = np.zeros(size)

    def write(self, values: Array) -> None:
        """Replace the numbers; only one process may."""
        self._count[0] += 1
        self._values[:] = values
        self._count[0] += 1

    def read(self) -> Array:
        """Return a consistent copy of the newest numbers, of those last read when there is none to be had."""
        for _ in range(_TRIES):
            before = int(self._count[0])
            if before % 2 == 0:
                copy = self._values.copy()
                if int(self._count[0]) == before:
                    self._last = copy
                    return copy
            os.sched_yield()
        # The writer died, or was put to sleep, in mid-write: the numbers before that are still whole.
        return self._last.copy()

    def close(self) -> None:
        """Let go of the memory."""
        del self._count, self._values
        self._memory.close()
