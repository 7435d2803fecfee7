"""Size and time limits for requests, independent of the route, and the body of a refusal."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping

from fastapi import HTTPException
from starlette.types import Message, Receive

MAX_HEAD_BYTES = 65_536
"""Of an address and its headers, as far as they have to be read before they can be understood."""
MAX_BODY_BYTES = 8_000_000
"""Four times the largest document: JSON escapes some characters."""
BODY_LIMIT_S = 30.0
TOO_LARGE = f"a request may have at most {MAX_BODY_BYTES / 1e6:g} MB"
HEAD_TOO_LARGE = f"an address with its headers may have at most {MAX_HEAD_BYTES} bytes"


def refusal_body(message: str) -> bytes:
    """Return the body of a request that is refused before a route sees it: the JSON of an `ErrorBody`."""
    return json.dumps({"message": message, "where": "", "hint": ""}).encode()


def declares_too_large(headers: Mapping[str, str]) -> bool:
    """Return whether a request declares a body above the limit."""
    length = headers.get("content-length", "")
    return length.isascii() and length.isdigit() and int(length) > MAX_BODY_BYTES


def limit_body(receive: Receive) -> Receive:
    """Wrap `receive` of a request so that it rejects a body that is too large (413) or too slow (408)."""
    count = 0
    complete = False
    started_s: float | None = None

    async def counted() -> Message:
        nonlocal count, complete, started_s
        if complete:
            return await receive()  # waits for the end of the connection, without a limit
        now_s = asyncio.get_running_loop().time()
        started_s = now_s if started_s is None else started_s
        try:
            async with asyncio.timeout(BODY_LIMIT_S - (now_s - started_s)):
                message = await receive()
        except TimeoutError as error:
            raise HTTPException(408, f"the request was not complete after {BODY_LIMIT_S:g} s") from error
        count += len(message.get("body", b""))
        complete = not message.get("more_body", False)
        if count > MAX_BODY_BYTES:
            raise HTTPException(413, TOO_LARGE)
        return message

    return counted
