"""Waits until everything that is ready at one instant of a run has run, so that decisions see all of it."""

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
"""A run that is never quiet is decided on after this time; in virtual time it would stand still, and say so."""
_OWNER: ContextVar[Settlement | None] = ContextVar("settlement", default=None)


class Settlement:
    """Tells the containers of one run when all else in it waits for something that is yet to come; on the loop thread.

    On a virtual loop that is so when nothing at all is ready. On a real one others are always busy,
    so what belongs to the run is known by its context, which every task and callback inherits from
    the one that made it. What was ready beside it at that moment has run as well: two robots that end
    in one turn of the loop end at one instant.
    """

    def __init__(self) -> None:
        self._waiters: list[tuple[Rank, asyncio.Future[None]]] = []
        self._since_s: float | None = None
        self._nobodys = Context()

    @contextmanager
    def owned(self) -> Generator[None]:
        """Have the tasks that are made inside, and all that comes of them, belong to this run."""
        token = _OWNER.set(self)
        try:
            yield
        finally:
            _OWNER.reset(token)

    async def settled(self, path: str | None, *, around: bool = False) -> None:
        """Return when the present instant has played out, and all that decides inside of `path` has decided.

        Args:
            path: The container that is to decide; None for who looks at the run as a whole.
            around: Whether what decides is around that container, as its timeout is.
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
            self._look_later(loop, since_s=loop.time())
        try:
            await waiter
        finally:
            self._waiters.remove(entry)

    def _look_later(self, loop: asyncio.AbstractEventLoop, *, since_s: float) -> None:
        self._since_s = since_s
        # At the end of the queue: all that is ready now goes before.
        loop.call_soon(self._look, loop, context=self._nobodys)

    def _look(self, loop: asyncio.AbstractEventLoop) -> None:
        since_s, self._since_s = self._since_s or 0.0, None
        due = [entry for entry in self._waiters if not entry[1].done()]
        if not due:
            return
        if self._is_busy(loop) and loop.time() - since_s < _LONGEST_S:
            self._look_later(loop, since_s=since_s)
            return
        max(due, key=lambda entry: entry[0])[1].set_result(None)
        self._look_later(loop, since_s=loop.time())

    def _is_busy(self, loop: asyncio.AbstractEventLoop) -> bool:
        return any(_owner(handle) is self for handle in ready_queue(loop))


def _owner(handle: Handle) -> Settlement | None:
    context = cast("Context | None", getattr(handle, "_context", None))
    return context.get(_OWNER) if context is not None else None
