"""What the open cell consists of, with the lines of its document."""

from __future__ import annotations

from starlette.concurrency import run_in_threadpool

from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.cell import CellItems, items_of_cell

router = WireRouter(prefix="/api/v1/cell", tags=["cell"])


@router.get("/items")
async def get_items(services: ServicesOf) -> CellItems:
    """Return the items of the open cell: robots, tools, fixtures, parts, cameras and what else it has."""
    backend = services.backend
    topics = [topic.name for topic in backend.inspector.topics()]
    return await run_in_threadpool(items_of_cell, backend.cell.document, topics=topics)
