"""Service calls that states of one run wait for; a tick of a tree waits for the calls of its checks."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Generator
from contextlib import contextmanager

from engine.node_path import is_inside


class PendingCalls:
    """Pending calls of one run, by the path of the calling state; used on the loop thread."""

    def __init__(self) -> None:
        self._open = Counter[str]()
        self._waiters: list[asyncio.Future[None]] = []

    @contextmanager
    def of(self, path: str) -> Generator[None]:
        """Count a call of the state at `path` as pending inside the context."""
        self._open[path] += 1
        self._notify()
        try:
            yield
        finally:
            self._open[path] -= 1
            if not self._open[path]:
                del self._open[path]
            self._notify()

    def any_inside(self, path: str) -> bool:
        """Return whether the node at `path`, or one inside it, waits for an answer."""
        return any(is_inside(path, each) for each in self._open)

    @contextmanager
    def changed(self) -> Generator[asyncio.Future[None]]:
        """Provide a future that is done once a call has begun or ended; dropped on exit."""
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append(waiter)
        try:
            yield waiter
        finally:
            self._waiters.remove(waiter)

    def _notify(self) -> None:
        for waiter in self._waiters:
            if not waiter.done():
                waiter.set_result(None)
