"""The websocket `/api/v1/data`: receives `DataSubscription`, sends exactly the subscribed data."""

from __future__ import annotations

import asyncio

import msgspec
from fastapi import APIRouter, WebSocket

from editor_web.routes.services import services_of
from editor_web.sockets.page_socket import PageDisconnected, read_message, send_message
from editor_web.telemetry.data_frames import DataSubscription, IdleFrame
from editor_web.telemetry.page_subscriptions import SAMPLE_S, PageSubscriptions

router = APIRouter()
PING_S = 5.0
_decoder = msgspec.json.Decoder(DataSubscription)


@router.websocket("/api/v1/data")
async def data(socket: WebSocket) -> None:
    """Serve one view of a page until it disconnects or is too slow."""
    services = services_of(socket)
    await socket.accept()
    subscriptions = PageSubscriptions(services.backend)
    try:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, subscriptions), name="data-receive")
            tasks.create_task(_sample(subscriptions), name="data-sample")
            tasks.create_task(_stream(socket, subscriptions), name="data-stream")
    except* PageDisconnected:
        pass


async def _receive(socket: WebSocket, subscriptions: PageSubscriptions) -> None:
    while True:
        subscriptions.look(await read_message(socket, _decoder, expected="a look message"))


async def _sample(subscriptions: PageSubscriptions) -> None:
    """Sample also while a slow page is being sent to, so that the page loses the oldest samples."""
    while True:
        await subscriptions.begun.wait()
        if subscriptions.samples:
            subscriptions.sample()
        await asyncio.sleep(SAMPLE_S)


async def _stream(socket: WebSocket, subscriptions: PageSubscriptions) -> None:
    silent_s = 0.0
    while True:
        await subscriptions.begun.wait()
        frames = subscriptions.due()
        for frame in frames:
            await send_message(socket, frame)
        silent_s = 0.0 if frames else silent_s + SAMPLE_S
        if silent_s > PING_S:
            await send_message(socket, IdleFrame())
            silent_s = 0.0
        await asyncio.sleep(SAMPLE_S)
