"""Runs pieces of work on the spot, one after the other, in a task that the first of them that waits takes with it.

What ends in its first step, as most checks of a behavior tree do, needs no task, but nobody knows beforehand. Its first
step cannot be moved into a task afterwards either: what it opens there, as `asyncio.timeout` does, belongs to the task
that ran. So a task carries one piece of work after the other and waits in between, and what has to wait keeps it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any, Generic, TypeVar

from engine.activity import Activity
from engine.first_step import step_now
from engine.preemption import being_cancelled

T = TypeVar("T")


class Carrier(Generic[T]):
    """Belongs to one task, which runs pieces of work in between its own steps; end it with `close`.

    Args:
        activity: Told which task carries which node.
        loop: The running one.
    """

    def __init__(self, activity: Activity, loop: asyncio.AbstractEventLoop) -> None:
        self._activity = activity
        self._loop = loop
        self._task: asyncio.Task[T] | None = None
        """The one that is free to carry what comes next."""
        self._next: asyncio.Future[Coroutine[Any, Any, T] | None] | None = None
        """What it waits for in between."""
        self._on_the_spot = False
        self._ended: T | None = None

    def run(self, path: str, work: Coroutine[Any, Any, T]) -> T | asyncio.Task[T]:
        """Run the work of the node at `path` up to where it first waits.

        Returns:
            What it has ended with; if it waits, or has raised, the task that it is carried by from now on.
        """
        task, self._ended, self._on_the_spot = self._task, None, True
        if task is None or self._next is None or self._next.done():
            task = self._task = asyncio.create_task(self._carry(work), name=path)
        else:
            task.set_name(path)
            self._next.set_result(work)
        self._activity.enter(path, task)
        try:
            step_now(task)
        finally:
            self._on_the_spot = False
        if self._ended is not None:
            self._activity.leave(path, task)
            return self._ended
        self._task = self._next = None
        task.add_done_callback(lambda done: self._activity.leave(path, done))
        return task

    def close(self) -> None:
        """Carry nothing any more; what has taken its task with it goes on."""
        if self._task is not None and self._next is not None and not self._next.done():
            self._next.set_result(None)
            step_now(self._task)
        self._task = self._next = None

    async def _carry(self, work: Coroutine[Any, Any, T]) -> T:
        while True:
            ended = await work
            # A task that was asked to end carries nothing else.
            if not self._on_the_spot or being_cancelled(self._loop):
                return ended
            self._ended, self._next = ended, self._loop.create_future()
            due = await self._next
            if due is None:
                return ended
            work = due
