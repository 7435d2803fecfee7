"""Preempting tasks: asked once, in order, and waited for until their clean-up is done."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from typing import Any

OVERDUE_S = 5.0
"""How long a clean-up may take before somebody is told, and then again and again."""


def being_cancelled() -> bool:
    """Tell whether the running branch has been asked to stop."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


async def preempt(tasks: Iterable[asyncio.Task[Any]], on_overdue: Callable[[str, float], None]) -> None:
    """Cancel the unfinished tasks once, in the order given, and wait for all of them to end.

    Args:
        tasks: The tasks; their exceptions count as seen, whoever asked for the stop reads them.
        on_overdue: Told the name and the seconds waited of each task that takes its time.

    Raises:
        CancelledError: the caller was cancelled meanwhile; the tasks have ended all the same.
    """
    asked = tuple(tasks)
    unfinished = {task for task in asked if not task.done()}
    for task in asked:
        task.cancel()
    cancelled: asyncio.CancelledError | None = None
    waited_s = 0.0
    while unfinished:
        try:
            _, unfinished = await asyncio.wait(unfinished, timeout=OVERDUE_S)
        except asyncio.CancelledError as error:
            cancelled = error
            continue
        waited_s += OVERDUE_S
        for late in sorted(task.get_name() for task in unfinished):
            on_overdue(late, waited_s)
    for task in asked:
        if not task.cancelled():
            task.exception()
    if cancelled is not None:
        raise cancelled
