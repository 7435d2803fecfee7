"""The open cell: what it consists of, whether its devices are connected, and reconnection of lost ones."""

from __future__ import annotations

from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ConnectBody, ErrorBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.cell import CellConnection, CellItems, items_of_cell

router = WireRouter(prefix="/api/v1/cell", tags=["cell"])


@router.get("/items")
async def get_items(services: ServicesOf) -> CellItems:
    """Return the items of the open cell: robots, tools, fixtures, parts, cameras and what else it has."""
    backend = services.backend
    topics = [topic.name for topic in backend.inspector.topics()]
    return await run_in_threadpool(items_of_cell, backend.cell.document, name=backend.cell_name, topics=topics)


@router.get("/connection")
async def get_connection(services: ServicesOf) -> CellConnection:
    """Return whether every device is connected, and which one is lost and why."""
    return services.backend.cell_connection


@router.post("/connect", status_code=204, responses={409: {"model": ErrorBody}, 422: {"model": ErrorBody}})
async def connect_cell(body: ConnectBody, services: ServicesOf) -> None:
    """Reconnect lost devices; 409 while a run is active, 422 if a device does not reconnect."""
    del body
    await services.backend.connect_cell()
