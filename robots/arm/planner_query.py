"""Questions to the planner that a moving arm can leave unanswered."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine, Iterable
from typing import Any, TypeVar

T = TypeVar("T")


class QuerySuperseded(Exception):
    """What was asked for is over before the planner has answered."""


async def await_answer(
    question: Coroutine[object, object, T] | asyncio.Future[T], *, unless: Iterable[asyncio.Future[Any]]
) -> T:
    """Wait for an answer, which may take as long as the planner's process takes to start again.

    Args:
        question: What is asked; dropped at the end, whatever that is.
        unless: What nobody needs the answer after.

    Raises:
        Overtaken: one of these came before the answer.
    """
    asking = asyncio.ensure_future(question)
    try:
        await asyncio.wait((asking, *unless), return_when=asyncio.FIRST_COMPLETED)
        if not asking.done():
            raise QuerySuperseded
        return asking.result()
    finally:
        await discard_query(asking)


async def discard_query(question: asyncio.Future[Any] | None) -> None:
    """End a question that nobody asks any more; what went wrong in it is nobody's concern either."""
    if question is None:
        return
    question.cancel()
    await asyncio.wait((question,))
    if not question.cancelled():
        question.exception()
