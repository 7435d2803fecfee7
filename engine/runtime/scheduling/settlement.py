"""Waits until everything ready at one instant of a run has run, so that decisions consider all of it."""

from __future__ import annotations

import asyncio
from asyncio import Handle
from collections.abc import Generator
from contextlib import contextmanager
from contextvars import Context, ContextVar
from typing import cast

from engine.clock import Rank, VirtualLoop
from engine.runtime.scheduling.ready_queue import ready_queue

_LONGEST_S = 0.05
"""Maximum wait on a real clock for a run that never settles; in virtual time such a run is an error."""
_OWNER: ContextVar[Settlement | None] = ContextVar("settlement", default=None)


class Settlement:
    """Lets containers of one run wait until everything else in it waits; used on the loop thread.

    On a virtual loop this holds when nothing is ready. On a real loop other work is always ready, so work of the run is
    identified by its context, which every task and callback inherits from its creator. Other work that was ready at
    that time has run as well: two robots that finish in one iteration of the loop finish at one instant.
    """

    def __init__(self) -> None:
        self._waiters: list[tuple[Rank, asyncio.Future[None]]] = []
        self._since_s: float | None = None
        self._unowned = Context()

    @contextmanager
    def owned(self) -> Generator[None]:
        """Assign tasks created inside, and their descendants, to this run."""
        token = _OWNER.set(self)
        try:
            yield
        finally:
            _OWNER.reset(token)

    async def settled(self, path: str | None, *, around: bool = False) -> None:
        """Return when the current instant is complete, and all decisions inside `path` are made.

        Args:
            path: The container that decides; None for the run as a whole.
            around: Whether the decision is made around that container, as by its timeout.
        """
        rank = (path.count("/") if path is not None else -1, not around)
        loop = asyncio.get_running_loop()
        if isinstance(loop, VirtualLoop):
            await loop.idle(rank)
            return
        waiter: asyncio.Future[None] = loop.create_future()
        entry = (rank, waiter)
        self._waiters.append(entry)
        if self._since_s is None:
            self._check_later(loop, since_s=loop.time())
        try:
            await waiter
        finally:
            self._waiters.remove(entry)

    def _check_later(self, loop: asyncio.AbstractEventLoop, *, since_s: float) -> None:
        self._since_s = since_s
        # At the end of the queue: everything ready now runs first.
        loop.call_soon(self._check, loop, context=self._unowned)

    def _check(self, loop: asyncio.AbstractEventLoop) -> None:
        since_s, self._since_s = self._since_s or 0.0, None
        due = [entry for entry in self._waiters if not entry[1].done()]
        if not due:
            return
        if self._is_busy(loop) and loop.time() - since_s < _LONGEST_S:
            self._check_later(loop, since_s=since_s)
            return
        max(due, key=lambda entry: entry[0])[1].set_result(None)
        self._check_later(loop, since_s=loop.time())

    def _is_busy(self, loop: asyncio.AbstractEventLoop) -> bool:
        return any(_owner(handle) is self for handle in ready_queue(loop))


def _owner(handle: Handle) -> Settlement | None:
    context = cast("Context | None", getattr(handle, "_context", None))
    return context.get(_OWNER) if context is not None else None
