"""Work of a state that may take only so long."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Annotated, Any, TypeVar

from msgspec import Meta

from engine.state import Context

T = TypeVar("T")

LongestWait = Annotated[
    float, Meta(gt=0.0, description="Longest wait; without it there is none", extra_json_schema={"unit": "s"})
]


async def ended_within(ctx: Context, work: Coroutine[Any, Any, T], limit_s: float | None) -> T:
    """Return what the work returns, within a time on the clock of the run; None is no limit.

    Raises:
        TimeoutError: it has not ended; it is cancelled.
    """
    if limit_s is None:
        return await work
    working = asyncio.ensure_future(work)
    pause = asyncio.ensure_future(ctx.clock.sleep(limit_s))
    try:
        await asyncio.wait((working, pause), return_when=asyncio.FIRST_COMPLETED)
    finally:
        has_ended = working.done()
        for task in (working, pause):
            task.cancel()
        await asyncio.wait((working, pause))
    if not has_ended:
        raise TimeoutError
    return working.result()
