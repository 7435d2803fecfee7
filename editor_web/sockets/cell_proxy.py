"""`/cell/`: viser's page and websocket on this server's origin, behind its security middleware."""

from __future__ import annotations

import asyncio
import logging
import re
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import websockets.asyncio.client
from fastapi import APIRouter, HTTPException, WebSocket
from fastapi.responses import HTMLResponse, Response
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from editor_web.cell_view import KEY_HEADER, PAGE_HEADER, ROLE_HEADER, CellView, viser_page
from editor_web.routes.services import ServicesOf, role_of, services_of
from editor_web.sockets.page_socket import disconnect_page

router = APIRouter(include_in_schema=False)
# viser's own limit: its render responses are large.
MAX_MESSAGE_BYTES = 50 * 1024 * 1024
UNAVAILABLE = 1013
# Name of a page; it is sent in a header.
_PAGE = re.compile(r"[0-9a-z]{1,40}")
_PROTOCOL = re.compile(r"viser-v[0-9.]{1,20}")
_log = logging.getLogger("flexcell.cell_view")


class _Closed(Exception):
    """One of the two sides has disconnected."""


@router.get("/cell/")
@router.get("/cell/{name}/")
async def cell_page(services: ServicesOf, name: str = "") -> Response:
    """Serve the one-file page of the 3D view; `name` is that of the parent page, which controls the view."""
    if name and not _PAGE.fullmatch(name):
        raise HTTPException(404, "no such page")
    if services.cell_view is None:
        raise HTTPException(404, "this server has no cell view")
    return HTMLResponse(await run_in_threadpool(viser_page))


@router.websocket("/cell/")
@router.websocket("/cell")
@router.websocket("/cell/{name}/")
@router.websocket("/cell/{name}")
async def cell_socket(socket: WebSocket, name: str = "") -> None:
    """Proxy the 3D view's websocket to viser."""
    view = services_of(socket).cell_view
    if view is None or (name and not _PAGE.fullmatch(name)):
        await socket.close(UNAVAILABLE, "this server has no such cell view")
        return
    try:
        offered = socket.scope.get("subprotocols", [])
        async with _viser(view, offered, name=name, role=role_of(socket)) as inner:
            await socket.accept(subprotocol=inner.subprotocol)
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(_inwards(socket, inner), name="cell-inwards")
                tasks.create_task(_outwards(socket, inner), name="cell-outwards")
    except* _Closed:
        # Also if viser is not reachable yet: the page tries again.
        await disconnect_page(socket, "the cell view has ended")


@asynccontextmanager
async def _viser(
    view: CellView, offered: list[str], *, name: str, role: str
) -> AsyncGenerator[websockets.asyncio.client.ClientConnection]:
    try:
        connection = await websockets.asyncio.client.connect(
            f"ws://127.0.0.1:{view.port}/",
            subprotocols=[Subprotocol(p) for p in offered if _PROTOCOL.fullmatch(p)],
            additional_headers={KEY_HEADER: view.key, PAGE_HEADER: name, ROLE_HEADER: role},
            max_size=MAX_MESSAGE_BYTES,
            compression=None,
            proxy=None,
        )
    except (OSError, InvalidHandshake) as error:
        # The server ends, or has no free file descriptor.
        _log.warning("cannot connect to the 3D view: %s", error)
        raise _Closed from error
    async with connection:
        yield connection


async def _inwards(socket: WebSocket, inner: websockets.asyncio.client.ClientConnection) -> None:
    while True:
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            raise _Closed
        data = message.get("bytes")
        try:
            await inner.send(data if data is not None else message.get("text", ""))
        except ConnectionClosed as error:
            raise _Closed from error


async def _outwards(socket: WebSocket, inner: websockets.asyncio.client.ClientConnection) -> None:
    try:
        async for message in inner:
            if isinstance(message, bytes):
                await socket.send_bytes(message)
            else:
                await socket.send_text(message)
        await socket.close(UNAVAILABLE, "the cell view has ended")
    except (ConnectionClosed, WebSocketDisconnect, RuntimeError) as error:
        # Starlette raises RuntimeError for a send after the close.
        raise _Closed from error
    raise _Closed
