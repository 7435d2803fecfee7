"""Runs first steps on the spot, so that what stands first is entered first, and what ends at once waits for nobody.

A task begins in the next turn of the loop. Of two branches that are started together the one with a task inside it,
as a timeout needs it, would be entered after the other.
"""

from __future__ import annotations

import asyncio
import types
from collections.abc import Coroutine, Generator
from typing import Any, TypeVar

from engine.ready_queue import ready_queue

T = TypeVar("T")


@types.coroutine
def after_first_step(begun: Coroutine[Any, Any, T], awaited: Any) -> Generator[Any, Any, T]:
    """Go on, in the same task, with a coroutine whose first step gave `awaited` to wait for."""
    while True:
        try:
            yield awaited
        except BaseException as error:
            # A cancel, above all: it is the coroutine's to clean up, for which it may wait again.
            try:
                awaited = begun.throw(error)
            except StopIteration as end:
                return end.value
        else:
            return (yield from begun.__await__())


def step_now(task: asyncio.Task[Any]) -> None:
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
