"""Preempting tasks: asked once, in order, and waited for until their clean-up is done."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from engine.errors import NotStopped

OVERDUE_S = 5.0
"""How long a clean-up may take before somebody is told, and then again and again."""


@dataclass(frozen=True, kw_only=True)
class Overdue:
    """What becomes of tasks that take their time: `tell` names them, `abandon` says that they are given up."""

    tell: Callable[[str, float], None]
    abandon: Callable[[asyncio.Task[Any], float], None] = lambda task, waited_s: None
    abandon_after_s: float = math.inf


def being_cancelled() -> bool:
    """Tell whether the running branch has been asked to stop."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


async def preempt(tasks: Iterable[asyncio.Task[Any]], overdue: Overdue) -> None:
    """Cancel the unfinished tasks once, in the order given, and wait for all of them to end.

    Args:
        tasks: The tasks; their exceptions count as seen, whoever asked for the stop reads them.
        overdue: Told the name and the seconds waited of each task that takes its time.

    Raises:
        NotStopped: some have not ended in time and were abandoned; names them.
        CancelledError: the caller was cancelled meanwhile; the tasks have ended all the same.
    """
    asked = tuple(tasks)
    unfinished = {task for task in asked if not task.done()}
    for task in asked:
        task.cancel()
    cancelled: asyncio.CancelledError | None = None
    waited_s = 0.0
    while unfinished and waited_s < overdue.abandon_after_s:
        patience_s = min(OVERDUE_S, overdue.abandon_after_s - waited_s)
        try:
            _, unfinished = await asyncio.wait(unfinished, timeout=patience_s)
        except asyncio.CancelledError as error:
            cancelled = error
            continue
        waited_s += patience_s
        if waited_s < overdue.abandon_after_s:
            for late in sorted(task.get_name() for task in unfinished):
                overdue.tell(late, waited_s)
    late_tasks = [task for task in asked if task in unfinished]
    for task in late_tasks:
        overdue.abandon(task, waited_s)
    for task in asked:
        if task.done() and not task.cancelled():
            task.exception()
    if late_tasks:
        names = ", ".join(task.get_name() for task in late_tasks)
        raise NotStopped(
            f"{names} did not stop within {waited_s:g} s and was abandoned",
            hint="let the state's clean-up end, and CancelledError pass",
        )
    if cancelled is not None:
        raise cancelled
