"""The FastAPI application: routes, error responses, lifetime of hub and cell view, behind the security middleware."""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from fastapi import APIRouter, FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.openapi.utils import get_openapi
from fastapi.responses import Response
from msgspec.structs import asdict
from starlette.exceptions import HTTPException
from starlette.routing import BaseRoute
from starlette.types import ASGIApp

from editor_web.cell_view import CellView
from editor_web.http_bodies.common_bodies import ErrorBody, ResumeQuestionsBody
from editor_web.http_bodies.document_bodies import conflict_body
from editor_web.http_bodies.json_schemas import BodyTypes, component_schemas
from editor_web.live.hub import LiveHub
from editor_web.past import OpenRunCache
from editor_web.routes import (
    behaviors,
    breakpoints,
    bus,
    catalogue,
    control,
    demonstration,
    documents,
    open_cell,
    page,
    run_comparison,
    run_curves,
    runs,
    search,
    session,
    sweeps,
)
from editor_web.routes import cell_stop as halt
from editor_web.routes import past_runs as past
from editor_web.routes import references as relations
from editor_web.routes.services import Services
from editor_web.routes.wire_router import MalformedBody, WireRouter, json_response
from editor_web.security.authentication import AccessTokens, AttemptLimiter
from editor_web.security.login_sessions import LoginSessions
from editor_web.security.middleware import SecurityMiddleware
from editor_web.sockets import cell_handle as cell_grip
from editor_web.sockets import cell_past_view as cell_past
from editor_web.sockets import cell_proxy as cell
from editor_web.sockets import data_stream as data
from editor_web.sockets import live_stream as live
from editor_web.sockets import teaching_stream as teaching
from editor_web.teaching.jogging import Jogger
from editor_web.transport.capacity import MAX_CONNECTIONS
from engine.archive import RunTrends
from engine.editing import DocumentConflict, NoSuchDocument, TargetChecks
from engine.errors import ControlError, FlexcellError
from engine.project import Session
from engine.runtime.history import ResumeDecisionRequired
from engine.stop import StopEndpoint
from engine.sweep_library import NoSuchSweep, SweepService

_TITLE = "flexcell"
STATIC = Path(__file__).parent / "static"
_ERROR = {"content": {"application/json": {"schema": {"$ref": f"#/components/schemas/{ErrorBody.__name__}"}}}}
# Error responses of every route: refusals of the security middleware, and malformed requests. By reference, because a
# model would be built for each status of each route.
_REFUSALS: dict[int | str, dict[str, Any]] = dict.fromkeys(
    (400, 401, 403, 404, 408, 413, 421, 422, 429, 431, 503), _ERROR
)

# `relations` before `documents`, and curves before `past`, whose ids match any address.
_ROUTERS = (
    session.router,
    breakpoints.router,
    behaviors.router,
    relations.router,
    documents.router,
    open_cell.documents,
    catalogue.router,
    search.router,
    runs.router,
    run_curves.router,
    past.router,
    run_comparison.router,
    sweeps.router,
    control.router,
    halt.router,
    halt.recovery,
    open_cell.router,
    bus.router,
    data.router,
    live.router,
    cell.router,
    cell_past.router,
    cell_grip.router,
    teaching.router,
    demonstration.router,
    page.router,
    control.interrupted_router,
)


def new_app(
    backend: Session,
    *,
    access: AccessTokens,
    hosts: frozenset[str],
    port: int,
    cell_view: CellView | None = None,
    static: Path = STATIC,
    stop: StopEndpoint | None = None,
    sessions: LoginSessions | None = None,
    capacity: int = MAX_CONNECTIONS,
    view_port: int | None = None,
) -> ASGIApp:
    """Return the whole server as one ASGI application.

    Args:
        backend: The engine.
        access: The access tokens.
        hosts: Accepted values of the Host header, with port, in lower case.
        port: Port of this server.
        cell_view: The 3D view; opened and closed with the application.
        static: Folder of the built page.
        stop: Additional endpoint to which an operator's page sends STOP.
        sessions: Login sessions of browsers; None keeps them in memory only.
        capacity: Maximum number of concurrent requests and websockets; an operator's commands are exempt.
        view_port: Port of the 3D view's own origin, under the same host names; None without a 3D view.
    """
    if sessions is None:
        sessions = LoginSessions(file=None, tokens=access.fingerprint())
    limit = AttemptLimiter(now_s=time.monotonic)
    app = api()
    hub = LiveHub(backend)
    app.state.services = Services(
        backend=backend,
        hub=hub,
        targets=TargetChecks(backend.documents.project),
        sweeps=SweepService(backend.documents.project, changed=hub.note_sweep),
        access=access,
        sessions=sessions,
        limit=limit,
        cell_view=cell_view,
        static=static,
        port=port,
        view_port=view_port,
        stop=stop,
    )
    app.state.started = OrderedDict[str, str]()
    app.state.open_runs = OpenRunCache(backend)
    app.state.run_trends = RunTrends(backend.archive)
    app.state.joggers = dict[str, Jogger]()
    return SecurityMiddleware(
        app,
        access=access,
        sessions=sessions,
        limit=limit,
        hosts=hosts,
        port=port,
        capacity=capacity,
        connect_sources=(stop.origin,) if stop is not None else (),
        view_port=view_port,
    )


def api() -> FastAPI:
    """Return the application without its services; sufficient to describe the HTTP interface."""
    app = FastAPI(
        title=_TITLE,
        version=_version(),
        lifespan=_lifespan,
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/v1/openapi.json",
        routes=list(_routes()),
    )
    app.openapi = openapi
    app.add_exception_handler(FlexcellError, _refused)
    app.add_exception_handler(MalformedBody, _malformed_body)
    app.add_exception_handler(RequestValidationError, _malformed)
    app.add_exception_handler(HTTPException, _http_error)
    return app


@cache
def openapi() -> dict[str, Any]:
    """Return the OpenAPI description of the HTTP interface; read-only. The first call builds all routes."""
    described = get_openapi(title=_TITLE, version=_version(), routes=_routes())
    return {**described, "components": {"schemas": component_schemas(body_types())}}


def body_types() -> BodyTypes:
    """Return the types of the bodies of all routes."""
    return sum((each.bodies for each in _ROUTERS if isinstance(each, WireRouter)), BodyTypes())


@cache
def _routes() -> list[BaseRoute]:
    """Return all routes; they are built on first use, once per process."""
    router = APIRouter(responses=_REFUSALS)
    for each in _ROUTERS:
        router.include_router(each)
    return router.routes


def _version() -> str:
    try:
        return version("flexcell")
    except PackageNotFoundError:
        return "0"


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncGenerator[None]:
    services: Services = app.state.services
    # Routes are built on first use, which would block the event loop for a second while arms move.
    await asyncio.to_thread(openapi)
    services.hub.open()
    await services.hub.robots.open()
    services.hub.documents.open()
    view = services.cell_view
    if view is not None:
        await asyncio.to_thread(view.open)
        await view.subscribe()
    try:
        yield
    finally:
        services.targets.close()
        await services.sweeps.close()
        await services.hub.documents.close()
        services.hub.robots.close()
        services.hub.close()
        await services.hub.stop_watch.close()
        if view is not None:
            await view.unsubscribe()
            await asyncio.to_thread(view.close)


async def _refused(request: Request, error: Exception) -> Response:
    del request
    if not isinstance(error, FlexcellError):
        raise error
    body = ErrorBody(
        message=error.message, where="" if error.where is None else str(error.where), hint=error.hint or ""
    )
    match error:
        case NoSuchDocument() | NoSuchSweep():
            return json_response(body, 404)
        case DocumentConflict():
            return json_response(conflict_body(error), 409)
        case ResumeDecisionRequired():
            return json_response(ResumeQuestionsBody(**asdict(body), questions=tuple(error.questions)), 409)
        case ControlError():
            # The request is valid, but the run does not allow the command now.
            return json_response(body, 409)
        case _:
            return json_response(body, 422)


async def _malformed_body(request: Request, error: Exception) -> Response:
    del request
    if not isinstance(error, MalformedBody):
        raise error
    return json_response(ErrorBody(message=error.message, where=error.where, hint=""), 422)


async def _malformed(request: Request, error: Exception) -> Response:
    del request
    if not isinstance(error, RequestValidationError):
        raise error
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"][1:])
    return json_response(ErrorBody(message=str(first["msg"]), where=where, hint=""), 422)


async def _http_error(request: Request, error: Exception) -> Response:
    del request
    if not isinstance(error, HTTPException):
        raise error
    return json_response(ErrorBody(message=str(error.detail), where="", hint=""), error.status_code)
