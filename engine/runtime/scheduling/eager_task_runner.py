"""Runs coroutines eagerly, one after the other, in one reusable task; a coroutine that has to wait keeps the task.

A coroutine that ends in its first step, like most checks of a behavior tree, needs no task, but this is not known in
advance. Its first step cannot be moved into a task afterwards: resources opened there, as by `asyncio.timeout`, belong
to the task that ran. So one task executes the coroutines and the decisions between them in sequence, and a coroutine
that has to wait keeps it.
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
    """Runs pieces of work between the steps of the owning task; end it with `close`.

    Args:
        activity: Registers the task of each node.
        loop: The running loop.
        following: Called immediately with the result of a piece; returns the next piece, or None.
    """

    def __init__(
        self, activity: ActiveNodes, loop: asyncio.AbstractEventLoop, following: Callable[[T], Piece[T] | None]
    ) -> None:
        self._activity = activity
        self._loop = loop
        self._following = following
        self._task: asyncio.Task[T] | None = None
        """The free task for the next piece."""
        self._next: asyncio.Future[Piece[T] | None] | None = None
        """The future it awaits between pieces."""
        self._is_eager = False
        self._error: BaseException | None = None
        """The exception raised between two pieces."""

    def run(self, piece: Piece[T]) -> asyncio.Task[T] | None:
        """Run a piece and the following ones until one waits.

        Returns:
            The task of the piece that waits or has raised; None where no piece follows.

        Raises:
            BaseException: the exception of `following`.
        """
        task, self._is_eager = self._task, True
        if task is None or self._next is None or self._next.done():
            task = self._task = asyncio.create_task(self._execute(piece), name=piece[0])
        else:
            self._next.set_result(piece)
        try:
            start_eagerly(task)
        finally:
            self._is_eager = False
        if self._error is not None:
            raise self._taken_error()
        if self._next is not None and not self._next.done():
            return None
        self._task = self._next = None
        task.add_done_callback(lambda done: self._activity.leave(done.get_name(), done))
        return task

    def close(self) -> None:
        """Run no further pieces; a piece that kept its task continues."""
        if self._task is not None and self._next is not None and not self._next.done():
            self._next.set_result(None)
            start_eagerly(self._task)
        self._task = self._next = None

    async def _execute(self, piece: Piece[T]) -> T:
        task = asyncio.current_task(self._loop)
        assert task is not None, "it is one"
        branches = self._activity.branches
        path, work = piece
        while True:
            task.set_name(path)
            branches[path] = task
            ended = await work
            # A preempted task runs no further pieces.
            if not self._is_eager or task.cancelling() or is_preempted(task):
                return ended
            del branches[path]
            try:
                due = self._following(ended)
            except BaseException as error:
                # `run` raises it in the owning task, whatever it is.
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
