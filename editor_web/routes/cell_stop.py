"""Stop of the whole cell, and the way back: what arms hold, going home, the release of the stop.

Steps of the recovery that move an arm end when the page disconnects; what they did is in the state of the stop.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Request

from editor_web.http_bodies.common_bodies import ErrorBody, StopBody
from editor_web.http_bodies.stop_bodies import RecoveryStepBody, ReleaseStopBody
from editor_web.routes.bus import run_while_connected
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.project import CellStop

router = WireRouter(prefix="/api/v1/cell", tags=["cell"], responses={422: {"model": ErrorBody}})
recovery = WireRouter(
    prefix="/api/v1/cell/stop", tags=["cell"], responses={409: {"model": ErrorBody}, 422: {"model": ErrorBody}}
)
ArmName = Annotated[str, Path(max_length=100)]


@router.post("/stop", status_code=204)
async def stop_cell(body: StopBody, services: ServicesOf) -> None:
    """Stop everything; responds when every robot is measured at rest. This is not a safety function."""
    await services.backend.stop_all(reason=body.reason)


@router.get("/stop")
async def get_stop(services: ServicesOf) -> CellStop | None:
    """Return the latest stop and what is open after it; null if there is none, or it was closed."""
    return await services.backend.recovery.state()


@recovery.post("/release", status_code=204)
async def release_stop(body: ReleaseStopBody, services: ServicesOf) -> None:
    """Release the stop of this number: runs may start again. Nothing moves by this."""
    await services.backend.recovery.release(body.stop)


@recovery.post("/close", status_code=204)
async def close_stop(body: RecoveryStepBody, services: ServicesOf) -> None:
    """Leave the stopped runs ended and forget a released stop; does nothing before the release."""
    del body
    services.backend.recovery.close()


@recovery.post("/reset_parts", status_code=204)
async def reset_parts(body: RecoveryStepBody, services: ServicesOf) -> None:
    """Put the parts of a simulation back to their initial poses, also those that an arm holds."""
    del body
    await services.backend.recovery.reset_parts()


@recovery.post("/arms/{arm}/keep", status_code=204)
async def keep_part(arm: ArmName, body: RecoveryStepBody, services: ServicesOf) -> None:
    """Let an arm keep the part that it holds; the part belongs to the arm in the planning scene."""
    del body
    await services.backend.recovery.keep(arm)


@recovery.post("/arms/{arm}/release_part", status_code=204)
async def release_part(arm: ArmName, body: RecoveryStepBody, services: ServicesOf, request: Request) -> None:
    """Open the tool of an arm; what it holds falls. This moves the tool."""
    del body
    await run_while_connected(services.backend.recovery.release_part(arm), request, name=f"release part of {arm}")


@recovery.post("/arms/{arm}/home", status_code=204)
async def go_home(arm: ArmName, body: RecoveryStepBody, services: ServicesOf, request: Request) -> None:
    """Move an arm to its home configuration around obstacles, slowly. This moves the robot."""
    del body
    await run_while_connected(services.backend.recovery.go_home(arm), request, name=f"{arm} goes home")
