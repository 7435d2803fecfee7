"""Runs the first step of a task at once, so that branches are entered in document order.

A task begins in the next turn of the loop. Of two branches that are started together the one with a task inside it,
as a timeout needs it, would be entered after the other.
"""

from __future__ import annotations

import asyncio
from typing import Any

from engine.runtime.scheduling.ready_queue import ready_queue


def start_eagerly(task: asyncio.Task[Any]) -> None:
    """Run a task that was made a moment ago, by the running task, up to where it first waits.

    Does what `eager_start` of later versions of asyncio does, after the task is known by whoever asks for it.
    """
    loop = task.get_loop()
    current = asyncio.current_task(loop)
    assert current is not None, "only a task has branches"
    begin = ready_queue(loop).pop()
    # As in "Extending asyncio": one task is left before another is entered.
    asyncio.tasks._leave_task(loop, current)  # pyright: ignore[reportAttributeAccessIssue]
    try:
        begin._run()
    finally:
        asyncio.tasks._enter_task(loop, current)  # pyright: ignore[reportAttributeAccessIssue]
