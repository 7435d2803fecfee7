"""The services whose answers states of one run wait for: a tick of a tree waits for those of its checks."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Generator
from contextlib import contextmanager

from engine.node_path import is_inside


class PendingCalls:
    """By the path of the state that has asked; belongs to one run, used on the loop thread."""

    def __init__(self) -> None:
        self._open = Counter[str]()
        self._waiters: list[asyncio.Future[None]] = []

    @contextmanager
    def of(self, path: str) -> Generator[None]:
        """Count a call of the state at `path` as open while inside."""
        self._open[path] += 1
        self._tell()
        try:
            yield
        finally:
            self._open[path] -= 1
            if not self._open[path]:
                del self._open[path]
            self._tell()

    def any_inside(self, path: str) -> bool:
        """Tell whether the node at `path`, or one in it, waits for an answer."""
        return any(is_inside(path, each) for each in self._open)

    @contextmanager
    def changed(self) -> Generator[asyncio.Future[None]]:
        """Give a future that is done once a call was begun or has ended; forgotten at the end."""
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append(waiter)
        try:
            yield waiter
        finally:
            self._waiters.remove(waiter)

    def _tell(self) -> None:
        for waiter in self._waiters:
            if not waiter.done():
                waiter.set_result(None)
