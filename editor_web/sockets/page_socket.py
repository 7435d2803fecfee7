"""Websockets of pages: reading and sending a message, and disconnecting a page."""

from __future__ import annotations

import asyncio
import logging
from typing import TypeVar

import msgspec
from fastapi import WebSocket
from starlette.websockets import WebSocketDisconnect

SEND_LIMIT_S = 5.0
UNAVAILABLE = 1013
"""The page may reconnect."""
REFUSED = 1008
_CLOSE_LIMIT_S = 1.0

T = TypeVar("T")
_log = logging.getLogger("flexcell.pages")


class PageDisconnected(Exception):
    """The page has disconnected or was disconnected."""


async def read_message(socket: WebSocket, decoder: msgspec.json.Decoder[T], *, expected: str) -> T:
    """Return the next message of a page; a page that does not send `expected` is disconnected.

    Raises:
        PageDisconnected: there is no next message.
    """
    try:
        return decoder.decode(await socket.receive_text())
    except WebSocketDisconnect as error:
        raise PageDisconnected from error
    except (msgspec.ValidationError, msgspec.DecodeError, KeyError, RecursionError) as error:
        # Starlette raises KeyError for bytes instead of text, msgspec RecursionError for too deep nesting.
        await disconnect_page(socket, f"expected {expected}", code=REFUSED)
        raise PageDisconnected from error


async def send_message(socket: WebSocket, message: msgspec.Struct) -> None:
    """Send a message to a page; a page that is behind by more than `SEND_LIMIT_S` is disconnected.

    Raises:
        PageDisconnected: the page does not take the message.
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
    """Close the connection of a page, even if the close frame cannot be delivered."""
    try:
        async with asyncio.timeout(_CLOSE_LIMIT_S):
            await socket.close(code, reason)
    except (TimeoutError, WebSocketDisconnect, RuntimeError):
        # The peer does not take the close frame; the socket ends with its task.
        _log.debug("the close frame could not be delivered")
