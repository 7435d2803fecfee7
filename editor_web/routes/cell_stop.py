"""Stop of the whole cell: every run and every goal stops, every robot comes to rest."""

from __future__ import annotations

from editor_web.http_bodies.common_bodies import ErrorBody, StopBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter

router = WireRouter(prefix="/api/v1/cell", tags=["cell"])


@router.post("/stop", status_code=204, responses={422: {"model": ErrorBody}})
async def stop_cell(body: StopBody, services: ServicesOf) -> None:
    """Stop everything; responds when every robot is measured at rest. This is not a safety function."""
    await services.backend.stop_all(reason=body.reason)
