"""Keeps Python from looking for cyclic garbage while a document is read, checked or planned.

Each full look passes over everything that was read and holds every thread, the event loop too: 0.3 s
for 10,000 states, several times in one reading. What is read has no cycles and goes without it.

Each pause starts the counts of the collector anew, so what has cycles would never be looked for where one
document is read after the other. Here it is: what is young before each pause, everything after so many of them.
"""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")
FULL_EVERY = 2_000
"""Pauses between two full looks: what one pause makes old by mistake is small, and a full look holds every thread."""
_YOUNG = 1


class _Pause:
    """Counts who works, in whatever thread; the collector goes on after the last one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._working = 0
        self._was_enabled = False
        self._ended = 0
        self._counts_stay = False

    def begin(self) -> None:
        """Stop the collector."""
        if gc.isenabled() and not self._counts_stay:
            gc.collect(_YOUNG)
        with self._lock:
            if self._working == 0:
                self._was_enabled = gc.isenabled()
                gc.disable()
            self._working += 1

    def end(self) -> None:
        """Let it go on, if it was."""
        due = False
        with self._lock:
            self._working -= 1
            if self._working == 0 and self._was_enabled:
                due = self._grow_old()
                gc.enable()
        if due:
            # Outside of the lock: what goes may run code that reads a document.
            gc.collect()

    def _grow_old(self) -> bool:
        """Make the next short look pass over what was read; return whether a full one is due."""
        self._counts_stay = gc.get_freeze_count() > 0
        if self._counts_stay:
            return False
        # There and back again, everything is in the oldest generation, without a look at it.
        gc.freeze()
        gc.unfreeze()
        self._ended += 1
        return self._ended % FULL_EVERY == 0


_PAUSE = _Pause()


@contextmanager
def collection_paused() -> Generator[None]:
    """Pause the collector inside; from any number of threads."""
    _PAUSE.begin()
    try:
        yield
    finally:
        _PAUSE.end()


def without_collection(work: Callable[P, T]) -> Callable[P, T]:
    """Pause the collector while a function works."""

    @wraps(work)
    def paused(*args: P.args, **kwargs: P.kwargs) -> T:
        with collection_paused():
            return work(*args, **kwargs)

    return paused
