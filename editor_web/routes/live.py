"""The websocket `/api/v1/live`: `Watch` comes in, snapshots and deltas go out, at most 20 a second."""

from __future__ import annotations

import asyncio
import logging
import time

import msgspec
from fastapi import APIRouter, WebSocket
from starlette.websockets import WebSocketDisconnect

from editor_web.live import PROTOCOL_VERSION, Frame, Hello, LiveClient, Ping, Request, Watch
from editor_web.routes.services import role_of, services_of

router = APIRouter()
PERIOD_S = 0.05
PING_S = 5.0
SEND_LIMIT_S = 5.0
TRY_AGAIN_LATER = 1013
_decoder: msgspec.json.Decoder[Request] = msgspec.json.Decoder(Request)
_log = logging.getLogger("flexcell.live")


class _Closed(Exception):
    """The page has gone, or has been sent away."""


@router.websocket("/api/v1/live")
async def live(socket: WebSocket) -> None:
    """Serve one page until it goes or falls behind by more than `SEND_LIMIT_S`."""
    services = services_of(socket)
    await socket.accept()
    client = services.hub.join()
    hello = Hello(version=PROTOCOL_VERSION, epoch=services.hub.epoch, role=role_of(socket), server_time_s=time.time())
    try:
        await _send(socket, hello)
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, client), name="live-receive")
            tasks.create_task(_stream(socket, client), name="live-stream")
    except* _Closed:
        pass
    finally:
        services.hub.leave(client)


async def _receive(socket: WebSocket, client: LiveClient) -> None:
    while True:
        try:
            request = _decoder.decode(await socket.receive_text())
        except WebSocketDisconnect as error:
            raise _Closed from error
        except (msgspec.ValidationError, msgspec.DecodeError, KeyError) as error:
            await socket.close(1008, "expected a watch or pong message")
            raise _Closed from error
        if isinstance(request, Watch):
            client.watch(request.run)


async def _stream(socket: WebSocket, client: LiveClient) -> None:
    while True:
        try:
            async with asyncio.timeout(PING_S):
                await client.dirty.wait()
        except TimeoutError:
            await _send(socket, Ping(server_time_s=time.time()))
            continue
        frame = client.frame()
        if frame is not None:
            await _send(socket, frame)
        # The frame rate's limit; what happens meanwhile is coalesced.
        await asyncio.sleep(PERIOD_S)


async def _send(socket: WebSocket, frame: Frame) -> None:
    try:
        async with asyncio.timeout(SEND_LIMIT_S):
            await socket.send_text(msgspec.json.encode(frame).decode())
    except TimeoutError as error:
        _log.warning("a page that is %.0f s behind was sent away; it will come back for a snapshot", SEND_LIMIT_S)
        await _close_slow(socket)
        raise _Closed from error
    except (WebSocketDisconnect, RuntimeError) as error:
        # Starlette raises RuntimeError for a send after the close.
        raise _Closed from error


async def _close_slow(socket: WebSocket) -> None:
    try:
        async with asyncio.timeout(1.0):
            await socket.close(TRY_AGAIN_LATER, "too slow")
    except (TimeoutError, WebSocketDisconnect, RuntimeError):
        # Its buffer is full: the close frame cannot be delivered either; the socket ends with this task.
        _log.debug("the close frame could not be delivered")
