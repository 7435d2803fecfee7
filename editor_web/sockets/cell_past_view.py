"""The websocket `/api/v1/cell/past`: the past state that the 3D view of a page shows, while the socket is open.

The page sends `PastViewRequest`s, many per second during scrubbing; the server sends `PastViewState`s, latest only.
"""

from __future__ import annotations

import asyncio
import re
from typing import Annotated

import msgspec
from fastapi import APIRouter, WebSocket

from editor_web.cell_view import CellView, GhostRequest, PastViewState
from editor_web.routes.services import services_of
from editor_web.sockets.page_socket import UNAVAILABLE, PageDisconnected, read_message, send_message

router = APIRouter()


class PastViewRequest(msgspec.Struct, frozen=True, kw_only=True):
    """From the page: show this run at this time of its clock, with the arms of another; null shows the live cell."""

    run: Annotated[str, msgspec.Meta(min_length=1, max_length=500)]
    time_s: float | None
    ghost: GhostRequest | None = None


_decoder = msgspec.json.Decoder(PastViewRequest)


@router.websocket("/api/v1/cell/past/{page}")
async def cell_past(socket: WebSocket, page: str) -> None:
    """Show past states to one page until it disconnects; it then shows the live cell again."""
    view = services_of(socket).cell_view
    if view is None or not re.fullmatch(r"[0-9a-z]{1,40}", page):
        await socket.close(UNAVAILABLE, "this server has no such cell view")
        return
    await socket.accept()
    latest = _LatestState(asyncio.get_running_loop())
    try:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, view, page, latest), name="past-receive")
            tasks.create_task(_answer(socket, latest), name="past-answer")
    except* PageDisconnected:
        pass
    finally:
        view.show_present(page)


class _LatestState:
    """The latest state that is not sent yet; `put` may be called on any thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._arrived = asyncio.Event()
        self._state: PastViewState | None = None

    def put(self, state: PastViewState) -> None:
        """Send this state next."""
        try:
            self._loop.call_soon_threadsafe(self._take, state)
        except RuntimeError:
            return  # the server has just ended

    async def next(self) -> PastViewState:
        """Wait for a state to send."""
        while self._state is None:
            self._arrived.clear()
            await self._arrived.wait()
        state, self._state = self._state, None
        return state

    def _take(self, state: PastViewState) -> None:
        self._state = state
        self._arrived.set()


async def _receive(socket: WebSocket, view: CellView, page: str, latest: _LatestState) -> None:
    while True:
        request = await read_message(socket, _decoder, expected="a run and a time")
        if request.time_s is None:
            view.show_present(page)
        else:
            view.show_past(page, request.run, request.time_s, report=latest.put, ghost=request.ghost)


async def _answer(socket: WebSocket, latest: _LatestState) -> None:
    while True:
        await send_message(socket, await latest.next())
