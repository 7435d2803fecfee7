"""No request is read beyond a size or for longer than a time, whatever its route does with it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping

from fastapi import HTTPException
from starlette.types import Message, Receive

MAX_BODY_BYTES = 8_000_000
"""Four times the largest document: JSON writes some characters as several."""
BODY_LIMIT_S = 30.0
TOO_LARGE = f"a request has at most {MAX_BODY_BYTES / 1e6:g} MB"


def declares_too_large(headers: Mapping[str, str]) -> bool:
    """Say whether a request announces more than it may bring."""
    told = headers.get("content-length", "")
    return told.isascii() and told.isdigit() and int(told) > MAX_BODY_BYTES


def limit_body(receive: Receive) -> Receive:
    """Return `receive` of a request so that it ends a body that is too long (413) or comes too slowly (408)."""
    count = 0
    complete = False
    began_s: float | None = None

    async def counted() -> Message:
        nonlocal count, complete, began_s
        if complete:
            return await receive()  # waits for the end of the connection, as long as that takes
        now_s = asyncio.get_running_loop().time()
        began_s = now_s if began_s is None else began_s
        try:
            async with asyncio.timeout(BODY_LIMIT_S - (now_s - began_s)):
                message = await receive()
        except TimeoutError as error:
            raise HTTPException(408, f"the request was not complete after {BODY_LIMIT_S:g} s") from error
        count += len(message.get("body", b""))
        complete = not message.get("more_body", False)
        if count > MAX_BODY_BYTES:
            raise HTTPException(413, TOO_LARGE)
        return message

    return counted
