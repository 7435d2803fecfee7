"""The open cell: what it consists of, whether its devices are connected, and reconnection of lost ones."""

from __future__ import annotations

from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ConnectBody, ErrorBody, SimulationBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.cell import CellConnection, CellItems, DeviceDetails, devices_of_cell, items_of_cell

router = WireRouter(prefix="/api/v1/cell", tags=["cell"])


@router.get("/items")
async def get_items(services: ServicesOf) -> CellItems:
    """Return the items of the open cell: robots, tools, fixtures, parts, cameras and what else it has."""
    backend = services.backend
    topics = [topic.name for topic in backend.inspector.topics()]
    return await run_in_threadpool(items_of_cell, backend.cell.document, name=backend.cell_name, topics=topics)


@router.get("/devices")
async def get_devices(services: ServicesOf) -> tuple[DeviceDetails, ...]:
    """Return the devices with a driver: what it can do, what enabling does, its options and their schema."""
    return await run_in_threadpool(devices_of_cell, services.backend.cell.document)


@router.get("/connection")
async def get_connection(services: ServicesOf) -> CellConnection:
    """Return whether every device is connected, and which one is lost and why."""
    return services.backend.cell_connection


@router.post("/connect", status_code=204, responses={409: {"model": ErrorBody}, 422: {"model": ErrorBody}})
async def connect_cell(body: ConnectBody, services: ServicesOf) -> None:
    """Reconnect lost devices; 409 while a run is active, 422 if a device does not reconnect."""
    del body
    await services.backend.connect_cell()


@router.post("/simulation", status_code=202, responses={409: {"model": ErrorBody}, 422: {"model": ErrorBody}})
async def switch_simulation(body: SimulationBody, services: ServicesOf) -> None:
    """Close the cell and open it anew with these devices simulated and all others real; 409 while something is active.

    All connections end; the server answers again at the same address once the cell is open.
    """
    await services.backend.reopening.request(body.simulated)
