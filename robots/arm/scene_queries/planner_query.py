"""Planner queries that a moving arm can abandon."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine, Iterable
from typing import Any, TypeVar

T = TypeVar("T")


class QuerySuperseded(Exception):
    """The query became obsolete before the planner answered."""


async def await_answer(
    question: Coroutine[object, object, T] | asyncio.Future[T], *, unless: Iterable[asyncio.Future[Any]]
) -> T:
    """Wait for an answer, which may take as long as a restart of the planner's process.

    Args:
        question: The query; discarded at the end in any case.
        unless: Futures after which the answer is obsolete.

    Raises:
        QuerySuperseded: one of `unless` completed before the answer.
    """
    query = asyncio.ensure_future(question)
    try:
        await asyncio.wait((query, *unless), return_when=asyncio.FIRST_COMPLETED)
        if not query.done():
            raise QuerySuperseded
        return query.result()
    finally:
        await discard_query(query)


async def discard_query(question: asyncio.Future[Any] | None) -> None:
    """Cancel an obsolete query and ignore its errors."""
    if question is None:
        return
    question.cancel()
    await asyncio.wait((question,))
    if not question.cancelled():
        question.exception()
