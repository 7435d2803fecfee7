"""The websocket `/api/v1/cell/past`: what past moment the 3D view of a page shows, as long as it is open.

The page sends `PastViewRequest`s, many a second while somebody scrubs; `PastViewState`s come back, of the newest only.
"""

from __future__ import annotations

import asyncio
import re
from typing import Annotated

import msgspec
from fastapi import APIRouter, WebSocket

from editor_web.cell_view import CellView, PastViewState
from editor_web.routes.services import services_of
from editor_web.sockets.page_socket import UNAVAILABLE, PageDisconnected, read_message, send_message

router = APIRouter()


class PastViewRequest(msgspec.Struct, frozen=True, kw_only=True):
    """From the page: show this run at this time of it; null shows the present."""

    run: Annotated[str, msgspec.Meta(min_length=1, max_length=500)]
    time_s: float | None


_decoder = msgspec.json.Decoder(PastViewRequest)


@router.websocket("/api/v1/cell/past/{page}")
async def cell_past(socket: WebSocket, page: str) -> None:
    """Show past moments to one page until it goes; it then sees the present again."""
    view = services_of(socket).cell_view
    if view is None or not re.fullmatch(r"[0-9a-z]{1,40}", page):
        await socket.close(UNAVAILABLE, "this server has no such cell view")
        return
    await socket.accept()
    told = _Told(asyncio.get_running_loop())
    try:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, view, page, told), name="past-receive")
            tasks.create_task(_answer(socket, told), name="past-answer")
    except* PageDisconnected:
        pass
    finally:
        view.show_present(page)


class _Told:
    """The newest state that the page has not been told; `put` may be called on any thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._arrived = asyncio.Event()
        self._state: PastViewState | None = None

    def put(self, state: PastViewState) -> None:
        """Tell this next."""
        try:
            self._loop.call_soon_threadsafe(self._take, state)
        except RuntimeError:
            return  # the server has just ended, and with it the page's view

    async def next(self) -> PastViewState:
        """Wait for something to tell."""
        while self._state is None:
            self._arrived.clear()
            await self._arrived.wait()
        state, self._state = self._state, None
        return state

    def _take(self, state: PastViewState) -> None:
        self._state = state
        self._arrived.set()


async def _receive(socket: WebSocket, view: CellView, page: str, told: _Told) -> None:
    while True:
        order = await read_message(socket, _decoder, expected="a run and a time")
        if order.time_s is None:
            view.show_present(page)
        else:
            view.show_past(page, order.run, order.time_s, tell=told.put)


async def _answer(socket: WebSocket, told: _Told) -> None:
    while True:
        await send_message(socket, await told.next())
