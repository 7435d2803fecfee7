"""The websocket `/api/v1/data`: `Look` comes in; what is looked at goes out, and nothing else."""

from __future__ import annotations

import asyncio
import logging

import msgspec
from fastapi import APIRouter, WebSocket
from starlette.websockets import WebSocketDisconnect

from editor_web.data_wire import DataFrame, IdleFrame, Look
from editor_web.look import SAMPLE_S, Looking
from editor_web.routes.services import services_of

router = APIRouter()
PING_S = 5.0
SEND_LIMIT_S = 5.0
TRY_AGAIN_LATER = 1013
_decoder = msgspec.json.Decoder(Look)
_log = logging.getLogger("flexcell.data")


class _Closed(Exception):
    """The page has gone, or has been sent away."""


@router.websocket("/api/v1/data")
async def data(socket: WebSocket) -> None:
    """Serve one view of a page until it goes or falls behind by more than `SEND_LIMIT_S`."""
    services = services_of(socket)
    await socket.accept()
    looking = Looking(services.backend)
    try:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, looking), name="data-receive")
            tasks.create_task(_sample(looking), name="data-sample")
            tasks.create_task(_stream(socket, looking), name="data-stream")
    except* _Closed:
        pass


async def _receive(socket: WebSocket, looking: Looking) -> None:
    while True:
        try:
            looking.look(_decoder.decode(await socket.receive_text()))
        except WebSocketDisconnect as error:
            raise _Closed from error
        except (msgspec.ValidationError, msgspec.DecodeError, KeyError) as error:
            await socket.close(1008, "expected a look message")
            raise _Closed from error


async def _sample(looking: Looking) -> None:
    """Goes on while a slow page is being sent to, so that what it misses is the oldest."""
    while True:
        await looking.begun.wait()
        if looking.samples:
            looking.sample()
        await asyncio.sleep(SAMPLE_S)


async def _stream(socket: WebSocket, looking: Looking) -> None:
    silent_s = 0.0
    while True:
        await looking.begun.wait()
        frames = looking.due()
        for frame in frames:
            await _send(socket, frame)
        silent_s = 0.0 if frames else silent_s + SAMPLE_S
        if silent_s > PING_S:
            await _send(socket, IdleFrame())
            silent_s = 0.0
        await asyncio.sleep(SAMPLE_S)


async def _send(socket: WebSocket, frame: DataFrame) -> None:
    try:
        async with asyncio.timeout(SEND_LIMIT_S):
            await socket.send_text(msgspec.json.encode(frame).decode())
    except TimeoutError as error:
        _log.warning("a page that is %.0f s behind with its data was sent away; it will come back", SEND_LIMIT_S)
        raise _Closed from error
    except (WebSocketDisconnect, RuntimeError) as error:
        # Starlette raises RuntimeError for a send after the close.
        raise _Closed from error
