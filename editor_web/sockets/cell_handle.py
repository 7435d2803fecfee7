"""The websocket `/api/v1/cell/grip/<page>`: the drag handle of a page in its 3D view, while the socket is open.

For operators only: it moves robots. The page sends `ShowHandle` and, while the mouse is down, `DragKeepAlive`.
"""

from __future__ import annotations

import asyncio
import re
from collections import deque
from typing import cast

import msgspec
from fastapi import APIRouter, WebSocket

from editor_web.routes.services import role_of, services_of
from editor_web.security.authentication import OPERATOR
from editor_web.sockets.page_socket import REFUSED, UNAVAILABLE, PageDisconnected, read_message, send_message
from editor_web.teaching.handle_drag import DragKeepAlive, HandleDrag, HandleStatus, ShowHandle
from editor_web.teaching.jogging import Jogger
from editor_web.teaching.teaching_messages import RefusedFrame

router = APIRouter()
_MAX_PENDING = 100
_decoder: msgspec.json.Decoder[ShowHandle | DragKeepAlive] = msgspec.json.Decoder(ShowHandle | DragKeepAlive)


class _Outbox:
    """Pending messages to the page; the oldest is dropped if the page does not take them."""

    def __init__(self) -> None:
        self.arrived = asyncio.Event()
        self.waiting: deque[HandleStatus | RefusedFrame] = deque(maxlen=_MAX_PENDING)

    def put(self, message: HandleStatus | RefusedFrame) -> None:
        self.waiting.append(message)
        self.arrived.set()


@router.websocket("/api/v1/cell/grip/{page}")
async def cell_grip(socket: WebSocket, page: str) -> None:
    """Let one page drag an arm until it disconnects."""
    services = services_of(socket)
    view = services.cell_view
    if view is None or not re.fullmatch(r"[0-9a-z]{1,40}", page):
        await socket.close(UNAVAILABLE, "this server has no such cell view")
        return
    if role_of(socket) != OPERATOR:
        await socket.close(REFUSED, "a viewer has read-only access")
        return
    await socket.accept()
    outbox = _Outbox()
    joggers = cast("dict[str, Jogger]", socket.app.state.joggers)
    grip = HandleDrag(services.backend, view, page, joggers=joggers, send=outbox.put)
    try:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, grip), name="grip-receive")
            tasks.create_task(_answer(socket, outbox), name="grip-answer")
    except* PageDisconnected:
        pass
    finally:
        await grip.close()


async def _receive(socket: WebSocket, grip: HandleDrag) -> None:
    while True:
        request = await read_message(socket, _decoder, expected="a take or held message")
        if isinstance(request, ShowHandle):
            await grip.take(request)
        else:
            grip.held()


async def _answer(socket: WebSocket, outbox: _Outbox) -> None:
    while True:
        await outbox.arrived.wait()
        outbox.arrived.clear()
        while outbox.waiting:
            await send_message(socket, outbox.waiting.popleft())
