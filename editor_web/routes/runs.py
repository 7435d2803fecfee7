"""Runs: start, stop, list, and the recorded events of a run."""

from __future__ import annotations

import secrets
from collections import OrderedDict
from typing import Annotated, cast

from fastapi import Header, HTTPException, Query, Request, Response
from msgspec.structs import asdict

from editor_web.http_bodies.common_bodies import ErrorBody, EventsBody, StartResultBody, StopBody
from editor_web.http_bodies.start_bodies import StartBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter, json_response
from engine.errors import FlexcellError
from engine.event import AnyEvent
from engine.project import StartData
from engine.runtime import RunOptions
from engine.runtime.history import RunView

router = WireRouter(prefix="/api/v1/runs", tags=["runs"])
KEPT_KEYS = 200


@router.get("")
def list_runs(services: ServicesOf) -> tuple[RunView, ...]:
    """List the known runs, newest first."""
    return services.backend.runs()


@router.get("/start-data", responses={422: {"model": ErrorBody}})
async def get_start_data(
    services: ServicesOf, behavior: Annotated[str, Query(max_length=1000)], path: Annotated[str, Query(max_length=4000)]
) -> StartData:
    """Return the data with which a run of a behavior can start at a node: of the last run that entered it."""
    return await services.backend.start_data(behavior, path)


@router.get("/{run_id}", responses={404: {"model": ErrorBody}})
def get_run(run_id: str, services: ServicesOf) -> RunView:
    """Return one run."""
    try:
        return services.backend.run(run_id)
    except FlexcellError as error:
        raise HTTPException(404, error.message) from error


@router.post(
    "",
    status_code=201,
    responses={200: {"model": StartResultBody}, 409: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)
async def start_run(
    body: StartBody,
    services: ServicesOf,
    request: Request,
    idempotency_key: Annotated[str | None, Header(max_length=100)] = None,
) -> StartResultBody | Response:
    """Start a run; a repeated Idempotency-Key returns the run that it started and starts nothing."""
    started: OrderedDict[str, str] = request.app.state.started
    if idempotency_key is not None and idempotency_key in started:
        return json_response(StartResultBody(run=started[idempotency_key]))
    seed = secrets.randbelow(2**31) if body.seed is None else body.seed
    run_id = await services.backend.start(
        body.behavior,
        parameters=body.parameters,
        seed=seed,
        inputs=body.inputs,
        supervision=RunOptions(**asdict(body.supervision)),
        breakpoints=body.breakpoints,
        begin=body.begin,
        until=body.until,
    )
    if idempotency_key is not None:
        started[idempotency_key] = run_id
        while len(started) > KEPT_KEYS:
            started.popitem(last=False)
    return StartResultBody(run=run_id)


@router.post("/{run_id}/stop", status_code=202, responses={422: {"model": ErrorBody}})
async def stop_run(run_id: str, body: StopBody, services: ServicesOf) -> None:
    """Request the stop of a run; the robots decelerate and the run ends as `stopped`."""
    await services.backend.stop(run_id, reason=body.reason)


@router.get("/{run_id}/events", responses={404: {"model": ErrorBody}})
def list_events(
    run_id: str,
    services: ServicesOf,
    after: Annotated[int, Query(ge=0)] = 0,
    limit: Annotated[int, Query(ge=1, le=5000)] = 1000,
) -> EventsBody:
    """Return a page of the recorded events with `seq` > `after`."""
    try:
        events = services.backend.events(run_id, after=after)[:limit]
    except FlexcellError as error:
        raise HTTPException(404, error.message) from error
    return EventsBody(events=tuple(cast("list[AnyEvent]", events)), last=events[-1].seq if events else after)
