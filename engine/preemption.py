"""Preemption of tasks: each is cancelled once, in order, and awaited until its clean-up ends.

A task is cancelled once: a second preemption during its clean-up waits for the same clean-up. A task that is preempted
by an order of the operator continues after its clean-up, unless it has been preempted for another reason meanwhile.
"""

from __future__ import annotations

import asyncio
import math
from asyncio import current_task
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from engine.errors import NotStopped

OVERDUE_S = 5.0
"""Duration of a clean-up after which it is reported, and the period of further reports."""


@dataclass(frozen=True, kw_only=True)
class OverduePolicy:
    """Handling of tasks that do not end in time: `report` reports them, `abandon` is called when one is abandoned.

    Time in which a task `stands_still`, as in a pause, is not counted.
    """

    report: Callable[[str, float], None]
    abandon: Callable[[asyncio.Task[Any], float], None] = lambda _task, _waited_s: None
    abandon_after_s: float = math.inf
    stands_still: Callable[[str], bool] = lambda _task: False


_ASKED: set[asyncio.Task[Any]] = set()
"""The preempted tasks that have not ended; independent of a task's own cancellation count, which a state may change."""
_FOR_ORDERS: set[asyncio.Task[Any]] = set()
"""Those of them that clean up for an order and continue afterwards."""


def being_cancelled(loop: asyncio.AbstractEventLoop) -> bool:
    """Return whether the running branch is preempted.

    Args:
        loop: The running loop; looking it up would dominate the cost of a state that ends at once.
    """
    task = current_task(loop)
    return task is not None and (task.cancelling() > 0 or task in _ASKED)


def is_preempted(task: asyncio.Task[Any]) -> bool:
    """Return whether a task is preempted and has not ended."""
    return task in _ASKED


def preempt_for_order(task: asyncio.Task[Any]) -> None:
    """Preempt a task for an order, unless it is already preempted; see `take_order_preemption`."""
    if _ask(task):
        _FOR_ORDERS.add(task)


def preempt_finally(task: asyncio.Task[Any]) -> None:
    """Preempt a task for good; an active clean-up for an order becomes its last one."""
    _ask(task)
    _FOR_ORDERS.discard(task)


def take_order_preemption() -> bool:
    """Return, once after the clean-up, whether the running branch was preempted only by an order."""
    task = asyncio.current_task()
    if task is None or task not in _FOR_ORDERS:
        return False
    _forget(task)
    while task.cancelling():
        task.uncancel()
    return True


def _ask(task: asyncio.Task[Any]) -> bool:
    if task.done() or task in _ASKED:
        return False
    _ASKED.add(task)
    task.add_done_callback(_forget)
    task.cancel()
    return True


def _forget(task: asyncio.Task[Any]) -> None:
    task.remove_done_callback(_forget)
    _ASKED.discard(task)
    _FOR_ORDERS.discard(task)


async def preempt(tasks: Iterable[asyncio.Task[Any]], overdue: OverduePolicy) -> None:
    """Cancel the unfinished tasks once, in the order given, and wait for all of them to end.

    Args:
        tasks: The tasks; their exceptions are marked as retrieved, the caller raises them with `raise_failure`.
        overdue: Receives the name and the waited seconds of each overdue task.

    Raises:
        NotStopped: tasks have not ended in time and were abandoned; the message names them.
        CancelledError: the caller was cancelled meanwhile; the tasks have ended nevertheless.
    """
    preempted = tuple(tasks)
    unfinished = {task for task in preempted if not task.done()}
    for task in preempted:
        preempt_finally(task)
    cancelled: asyncio.CancelledError | None = None
    waited_s = 0.0
    while unfinished and waited_s < overdue.abandon_after_s:
        patience_s = min(OVERDUE_S, overdue.abandon_after_s - waited_s)
        try:
            _, unfinished = await asyncio.wait(unfinished, timeout=patience_s)
        except asyncio.CancelledError as error:
            cancelled = error
            continue
        if any(overdue.stands_still(task.get_name()) for task in unfinished):
            continue
        waited_s += patience_s
        if waited_s < overdue.abandon_after_s:
            for late in sorted(task.get_name() for task in unfinished):
                overdue.report(late, waited_s)
    late_tasks = [task for task in preempted if task in unfinished]
    for task in late_tasks:
        overdue.abandon(task, waited_s)
    for task in preempted:
        if task.done() and not task.cancelled():
            task.exception()
    if late_tasks:
        names = ", ".join(task.get_name() for task in late_tasks)
        raise NotStopped(
            f"{names} did not stop within {waited_s:g} s and was abandoned",
            hint="end the state's clean-up in time and do not suppress CancelledError",
        )
    if cancelled is not None:
        raise cancelled


class BackgroundPreemptions:
    """Preemptions that run in the background, each limited and reported as by `preempt`.

    Args:
        overdue: Handling of overdue tasks.
        on_failure: Called when a task was abandoned; `raise_failure` raises its error.
    """

    def __init__(self, overdue: OverduePolicy, on_failure: Callable[[], None]) -> None:
        self._overdue = overdue
        self._on_failure = on_failure
        self._waits: dict[asyncio.Task[Any], asyncio.Task[None]] = {}

    def __contains__(self, task: asyncio.Task[Any]) -> bool:
        """Return whether a task is preempted by this object."""
        return task in self._waits

    def begin(self, task: asyncio.Task[Any]) -> None:
        """Preempt a task, unless it was preempted before."""
        if task in self._waits:
            return
        preempt_finally(task)
        wait = asyncio.create_task(preempt((task,), self._overdue), name=f"preempt {task.get_name()}")
        wait.add_done_callback(self._ended)
        self._waits[task] = wait

    def raise_failure(self) -> None:
        """Raise NotStopped if a task was abandoned."""
        raise_failure(wait for wait in self._waits.values() if wait.done())

    async def finish(self, tasks: Iterable[asyncio.Task[Any]]) -> None:
        """Return when those of `tasks` that are preempted by this object have ended.

        Raises:
            NotStopped: a task was abandoned.
            CancelledError: the caller was cancelled meanwhile; the tasks have ended nevertheless.
        """
        waits = [self._waits[task] for task in tasks if task in self._waits]
        cancelled: asyncio.CancelledError | None = None
        while unfinished := [wait for wait in waits if not wait.done()]:
            try:
                await asyncio.wait(unfinished)
            except asyncio.CancelledError as error:
                cancelled = error
        self.raise_failure()
        if cancelled is not None:
            raise cancelled

    def _ended(self, wait: asyncio.Task[None]) -> None:
        if not wait.cancelled() and wait.exception() is not None:
            self._on_failure()


def raise_failure(tasks: Iterable[asyncio.Task[Any]]) -> None:
    """Raise the error, with its cause, of the first of these ended tasks that has one."""
    for task in tasks:
        if not task.cancelled() and (error := task.exception()) is not None:
            raise error from error.__cause__
