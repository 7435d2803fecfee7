"""The skill bus for the command line and the page: list, call, publish and goals, in the skills' own JSON."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Coroutine
from contextlib import aclosing
from typing import Any, TypeVar

import msgspec
from fastapi import Request, Response
from fastapi.responses import StreamingResponse

from editor_web.http_bodies.common_bodies import BusMessageBody, BusRequestBody, ErrorBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from editor_web.telemetry.bus_bodies import BusFields, BusForm, BusListing, BusParameterBody, TopicFields
from editor_web.telemetry.bus_metrics import bus_fingerprint
from editor_web.telemetry.goal_stream import GoalStream, wait_for_disconnect
from editor_web.telemetry.plot_signals import signal_fields
from editor_web.telemetry.truncate import truncate_value
from engine.bus import BusEntry, GoalEnd

router = WireRouter(prefix="/api/v1/bus", tags=["bus"], responses={422: {"model": ErrorBody}})
CLIENT_CLOSED_REQUEST = 499
R = TypeVar("R")


@router.get("")
async def list_bus(services: ServicesOf) -> tuple[BusEntry, ...]:
    """List topics, services, actions, parameters and leases."""
    return await services.backend.bus.listing()


@router.get("/echo")
async def echo_topic(topic: str, services: ServicesOf) -> Response:
    """Stream the messages of a topic, one JSON object per line, from the latest on, until the client disconnects."""
    messages = services.backend.bus.echo(topic)
    entries = await services.backend.bus.listing()
    if not any(entry.kind == "topic" and entry.name == topic for entry in entries):
        # The bus itself raises the error for an unknown topic.
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
    """Call a service and return its response."""
    return Response(await services.backend.bus.call(body.address, body.request), media_type="application/json")


@router.post("/goal")
async def perform_goal(body: BusRequestBody, services: ServicesOf, request: Request) -> GoalEnd[object] | Response:
    """Send a goal and return its end; it is cancelled if the client disconnects. This moves the robot."""
    work = services.backend.bus.perform(body.address, body.request)
    end = await run_while_connected(work, request, name=f"goal {body.address}")
    if end is None:
        return Response(status_code=CLIENT_CLOSED_REQUEST)
    return end


@router.get("/board")
async def get_board(services: ServicesOf) -> BusListing:
    """Return topics, services, actions and parameters with descriptions; `shape` changes when this list does."""
    inspector = services.backend.inspector
    parameters = (msgspec.structs.replace(each, value=truncate_value(each.value)) for each in inspector.parameters())
    return BusListing(
        shape=bus_fingerprint(inspector),
        topics=inspector.topics(),
        skills=inspector.skills(),
        parameters=tuple(parameters),
    )


@router.get("/form")
async def get_form(services: ServicesOf, address: str = "", topic: str = "") -> BusForm:
    """Return the JSON Schema of the request of an address, or of the messages of a topic."""
    inspector = services.backend.inspector
    schema = inspector.message_schema(topic) if topic else inspector.request_schema(address)
    return BusForm(name=topic or address, schema=schema)


@router.get("/fields")
async def get_fields(services: ServicesOf) -> BusFields:
    """Return the numeric fields of the latest message of every topic, for plots."""
    inspector = services.backend.inspector
    topics = ((facts, signal_fields(inspector.latest(facts.name))) for facts in inspector.topics())
    return BusFields(
        topics=tuple(TopicFields(topic=each.name, type=each.type, fields=fields) for each, fields in topics if fields)
    )


@router.put("/parameter")
async def set_parameter(body: BusParameterBody, services: ServicesOf) -> object:
    """Set a parameter and return its new value. This may change the behavior of a robot."""
    return truncate_value(services.backend.inspector.set_parameter(body.name, body.value))


@router.post("/goals")
async def send_goal(body: BusRequestBody, services: ServicesOf) -> Response:
    """Send a goal and stream its progress, one JSON object per line; cancelled on disconnect. This moves the robot."""
    inspector = services.backend.inspector
    return GoalStream(inspector, inspector.send(body.address, body.request))


@router.post("/goals/{goal}/cancel", status_code=202)
async def cancel_goal(goal: str, services: ServicesOf) -> None:
    """Cancel a goal that was sent from the page; its own stream reports the end."""
    services.backend.inspector.cancel(goal)


async def run_while_connected(work: Coroutine[Any, Any, R], request: Request, *, name: str) -> R | None:
    """Return the result of `work`; if the client disconnects first, cancel it and return None."""
    goal = asyncio.create_task(work, name=name)
    gone = asyncio.create_task(wait_for_disconnect(request.receive), name="goal-client")
    try:
        await asyncio.wait({goal, gone}, return_when=asyncio.FIRST_COMPLETED)
        return goal.result() if goal.done() else None
    finally:
        for task in (goal, gone):
            task.cancel()
        # The goal ends only when its device is at rest.
        await asyncio.wait({goal, gone})
