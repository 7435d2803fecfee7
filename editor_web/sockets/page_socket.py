"""The websockets of pages: one message read, one message sent, and how a page is sent away."""

from __future__ import annotations

import asyncio
import logging
from typing import TypeVar

import msgspec
from fastapi import WebSocket
from starlette.websockets import WebSocketDisconnect

SEND_LIMIT_S = 5.0
UNAVAILABLE = 1013
"""The page may come back and try again."""
REFUSED = 1008
_CLOSE_LIMIT_S = 1.0

T = TypeVar("T")
_log = logging.getLogger("flexcell.pages")


class PageDisconnected(Exception):
    """The page has gone, or has been sent away."""


async def read_message(socket: WebSocket, decoder: msgspec.json.Decoder[T], *, expected: str) -> T:
    """Return the next message of a page; one that sends anything else than `expected` is sent away.

    Raises:
        Gone: there is no next one.
    """
    try:
        return decoder.decode(await socket.receive_text())
    except WebSocketDisconnect as error:
        raise PageDisconnected from error
    except (msgspec.ValidationError, msgspec.DecodeError, KeyError, RecursionError) as error:
        # Starlette raises KeyError for bytes where text is due, msgspec RecursionError for what is nested too deeply.
        await disconnect_page(socket, f"expected {expected}", code=REFUSED)
        raise PageDisconnected from error


async def send_message(socket: WebSocket, message: msgspec.Struct) -> None:
    """Send a message to a page; one that is behind by more than `SEND_LIMIT_S` is sent away.

    Raises:
        Gone: nobody takes it.
    """
    try:
        async with asyncio.timeout(SEND_LIMIT_S):
            await socket.send_text(msgspec.json.encode(message).decode())
    except TimeoutError as error:
        _log.warning(
            "closed the connection of a page that is more than %.0f s behind; it reconnects by itself", SEND_LIMIT_S
        )
        await disconnect_page(socket, "too slow")
        raise PageDisconnected from error
    except (WebSocketDisconnect, RuntimeError) as error:
        # Starlette raises RuntimeError for a send after the close.
        raise PageDisconnected from error


async def disconnect_page(socket: WebSocket, reason: str, *, code: int = UNAVAILABLE) -> None:
    """Close the connection of a page, whether or not it hears of it."""
    try:
        async with asyncio.timeout(_CLOSE_LIMIT_S):
            await socket.close(code, reason)
    except (TimeoutError, WebSocketDisconnect, RuntimeError):
        # Nobody takes the close frame either; the socket ends with its task.
        _log.debug("the close frame could not be delivered")
