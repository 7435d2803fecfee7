"""Runs coroutines eagerly, one after the other, in one reusable task; a coroutine that has to wait keeps the task.

What ends in its first step, as most checks of a behavior tree do, needs no task, but nobody knows beforehand. Its first
step cannot be moved into a task afterwards either: what it opens there, as `asyncio.timeout` does, belongs to the task
that ran. So a task carries one piece of work after the other and what is decided in between, and what has to wait keeps
it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, Generic, TypeVar

from engine.preemption import is_preempted
from engine.runtime.scheduling.active_nodes import ActiveNodes
from engine.runtime.scheduling.eager_start import start_eagerly

T = TypeVar("T")
Piece = tuple[str, Coroutine[Any, Any, T]]
"""A node path, and the work of that node."""


class EagerTaskRunner(Generic[T]):
    """Belongs to one task, which runs pieces of work in between its own steps; end it with `close`.

    Args:
        activity: Told which task carries which node.
        loop: The running one.
        following: Called on the spot with what a piece has ended with; gives the next one, or None.
    """

    def __init__(
        self, activity: ActiveNodes, loop: asyncio.AbstractEventLoop, following: Callable[[T], Piece[T] | None]
    ) -> None:
        self._activity = activity
        self._loop = loop
        self._following = following
        self._task: asyncio.Task[T] | None = None
        """The one that is free to carry what comes next."""
        self._next: asyncio.Future[Piece[T] | None] | None = None
        """What it waits for in between."""
        self._on_the_spot = False
        self._error: BaseException | None = None
        """What was raised between two pieces."""

    def run(self, piece: Piece[T]) -> asyncio.Task[T] | None:
        """Run a piece, and those that follow, up to where one waits.

        Returns:
            The task that carries the one that waits, or has raised, from now on; None where nothing follows any more.

        Raises:
            BaseException: what `following` has raised.
        """
        task, self._on_the_spot = self._task, True
        if task is None or self._next is None or self._next.done():
            task = self._task = asyncio.create_task(self._carry(piece), name=piece[0])
        else:
            self._next.set_result(piece)
        try:
            start_eagerly(task)
        finally:
            self._on_the_spot = False
        if self._error is not None:
            raise self._taken_error()
        if self._next is not None and not self._next.done():
            return None
        self._task = self._next = None
        task.add_done_callback(lambda done: self._activity.leave(done.get_name(), done))
        return task

    def close(self) -> None:
        """Carry nothing any more; what has taken its task with it goes on."""
        if self._task is not None and self._next is not None and not self._next.done():
            self._next.set_result(None)
            start_eagerly(self._task)
        self._task = self._next = None

    async def _carry(self, piece: Piece[T]) -> T:
        task = asyncio.current_task(self._loop)
        assert task is not None, "it is one"
        branches = self._activity.branches
        path, work = piece
        while True:
            task.set_name(path)
            branches[path] = task
            ended = await work
            # A task that was asked to end carries nothing else.
            if not self._on_the_spot or task.cancelling() or is_preempted(task):
                return ended
            del branches[path]
            try:
                due = self._following(ended)
            except BaseException as error:
                # `run` raises it: whoever has this carried is to meet it, whatever it is.
                self._error, due = error, None
            if due is None:
                self._next = self._loop.create_future()
                due = await self._next
                if due is None:
                    return ended
            path, work = due

    def _taken_error(self) -> BaseException:
        error, self._error = self._error, None
        assert error is not None, "there is one"
        return error
