"""The breakpoints that are kept beside a behavior's file, for all its runs."""

from __future__ import annotations

from fastapi import APIRouter

from editor_web.control_wire import BreakpointBody, BreakpointsBody
from editor_web.routes.services import ServicesOf
from editor_web.wire import ErrorBody
from engine.control import Breakpoint

router = APIRouter(prefix="/api/v1/breakpoints", tags=["control"], responses={422: {"model": ErrorBody}})


def made_breakpoints(body: BreakpointsBody) -> tuple[Breakpoint, ...]:
    """Return the breakpoints of a request; raises ExpressionError where a condition does not compile."""
    made = tuple(Breakpoint(**each.model_dump()) for each in body.breakpoints)
    for each in made:
        _ = each.template  # compiled now, so that a wrong expression is refused before anything changes
    return made


@router.get("/{behavior_id:path}")
def get_breakpoints(behavior_id: str, services: ServicesOf) -> BreakpointsBody:
    """Return what is kept beside the behavior."""
    kept = services.backend.breakpoints(behavior_id)
    return BreakpointsBody(breakpoints=tuple(BreakpointBody.model_validate(each) for each in kept))


@router.put("/{behavior_id:path}")
async def keep_breakpoints(behavior_id: str, body: BreakpointsBody, services: ServicesOf) -> BreakpointsBody:
    """Write all breakpoints beside the behavior; without any, there is no file."""
    services.backend.keep_breakpoints(behavior_id, made_breakpoints(body))
    return get_breakpoints(behavior_id, services)
