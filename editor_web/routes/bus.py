"""The skill bus for the command line: list, echo, publish, call, goal; everything in the skills' own JSON."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import aclosing
from typing import Any

import msgspec
from fastapi import APIRouter, Request, Response
from fastapi.responses import StreamingResponse

from editor_web.routes.services import ServicesOf
from editor_web.wire import BusMessageBody, BusRequestBody, ErrorBody
from engine.bus.access import BusAccess
from engine.bus.action import GoalEnd

router = APIRouter(prefix="/api/v1/bus", tags=["bus"], responses={422: {"model": ErrorBody}})
CLIENT_CLOSED_REQUEST = 499


def _json(value: object) -> Response:
    return Response(msgspec.json.encode(value), media_type="application/json")


@router.get("")
async def list_bus(services: ServicesOf) -> Response:
    """List topics, services, actions, parameters and leases."""
    return _json(await services.backend.bus.listing())


@router.get("/echo")
async def echo_topic(topic: str, services: ServicesOf) -> Response:
    """Send the messages of a topic, one JSON object a line, the latest first, until the client goes."""
    messages = services.backend.bus.echo(topic)
    entries = await services.backend.bus.listing()
    if not any(entry.kind == "topic" and entry.name == topic for entry in entries):
        # The bus knows best how to say that it does not know the topic.
        await anext(messages)
    return StreamingResponse(_lines(messages), media_type="application/x-ndjson")


async def _lines(messages: AsyncGenerator[str, None]) -> AsyncGenerator[str, None]:
    async with aclosing(messages) as open_messages:
        async for message in open_messages:
            yield f"{message}\n"


@router.post("/publish", status_code=204)
async def publish_message(body: BusMessageBody, services: ServicesOf) -> None:
    """Publish a message on a topic that takes commands. This may move the robot."""
    await services.backend.bus.publish(body.topic, body.message)


@router.post("/call")
async def call_service(body: BusRequestBody, services: ServicesOf) -> Response:
    """Ask a service and return its answer."""
    return Response(await services.backend.bus.call(body.address, body.request), media_type="application/json")


@router.post("/goal")
async def perform_goal(body: BusRequestBody, services: ServicesOf, request: Request) -> Response:
    """Send a goal and return its end; it is cancelled when the client goes. This moves the robot."""
    end = await _performed(services.backend.bus, body, request)
    if end is None:
        return Response(status_code=CLIENT_CLOSED_REQUEST)
    return _json({"status": end.status.value, "result": end.result, "cause": end.cause})


async def _performed(bus: BusAccess, body: BusRequestBody, request: Request) -> GoalEnd[Any] | None:
    goal = asyncio.create_task(bus.perform(body.address, body.request), name=f"goal {body.address}")
    gone = asyncio.create_task(_until_gone(request), name="goal-client")
    try:
        await asyncio.wait({goal, gone}, return_when=asyncio.FIRST_COMPLETED)
        return goal.result() if goal.done() else None
    finally:
        for task in (goal, gone):
            task.cancel()
        # The goal has ended only when its device is at rest.
        await asyncio.wait({goal, gone})


async def _until_gone(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass
