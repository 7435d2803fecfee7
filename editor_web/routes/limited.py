"""Routes that take no more than so many bytes, however they come."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi import HTTPException, Request, Response
from fastapi.routing import APIRoute
from starlette.types import Message

MAX_BODY_BYTES = 8_000_000
"""Four times the largest document: JSON writes some characters as several."""


class LimitedRoute(APIRoute):
    """A route that reads at most `MAX_BODY_BYTES` of a body and then refuses it."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return the handler behind a counter of bytes."""
        handler = super().get_route_handler()

        async def limited(request: Request) -> Response:
            told = request.headers.get("content-length", "")
            if told.isdigit() and int(told) > MAX_BODY_BYTES:
                raise _too_large()
            return await handler(_Counted(request))

        return limited


class _Counted(Request):
    """A request that stops reading when there is too much of it."""

    def __init__(self, request: Request) -> None:
        count = 0

        async def receive() -> Message:
            nonlocal count
            message = await request.receive()
            count += len(message.get("body", b""))
            if count > MAX_BODY_BYTES:
                raise _too_large()
            return message

        super().__init__(request.scope, receive)


def _too_large() -> HTTPException:
    return HTTPException(413, f"a request has at most {MAX_BODY_BYTES / 1e6:g} MB")
