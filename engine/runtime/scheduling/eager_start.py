"""Runs the first step of a task at once, so that branches are entered in document order.

A task begins in the next iteration of the loop. Of two branches started together, one with an inner task, as a timeout
needs it, would be entered after the other.
"""

from __future__ import annotations

import asyncio
from typing import Any

from engine.runtime.scheduling.ready_queue import ready_queue


def start_eagerly(task: asyncio.Task[Any]) -> None:
    """Run a task, which the running task has just created, up to its first wait.

    Like `eager_start` of later asyncio versions, but after the task object is available to other code.
    """
    loop = task.get_loop()
    current = asyncio.current_task(loop)
    assert current is not None, "only a task has branches"
    begin = ready_queue(loop).pop()
    # As in "Extending asyncio": leave one task before entering another.
    asyncio.tasks._leave_task(loop, current)  # pyright: ignore[reportAttributeAccessIssue]
    try:
        begin._run()
    finally:
        asyncio.tasks._enter_task(loop, current)  # pyright: ignore[reportAttributeAccessIssue]
