"""The breakpoints stored with a behavior, for all its runs."""

from __future__ import annotations

from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.control_bodies import BreakpointsBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.check import ConditionCheck, check_condition
from engine.errors import ExpressionError
from engine.runtime.control import Breakpoint

router = WireRouter(prefix="/api/v1/breakpoints", tags=["control"], responses={422: {"model": ErrorBody}})


MAX_BREAKPOINTS = 200


def to_breakpoints(body: BreakpointsBody) -> tuple[Breakpoint, ...]:
    """Return the breakpoints of a request; raises ExpressionError if a condition does not compile."""
    if len(body.breakpoints) > MAX_BREAKPOINTS:
        raise ExpressionError(f"more than {MAX_BREAKPOINTS} breakpoints", hint="use wildcards in `path`")
    for each in body.breakpoints:
        _ = each.template  # compiled now, so that an invalid expression is rejected before anything changes
    return body.breakpoints


@router.get("/{behavior_id:path}")
def get_breakpoints(behavior_id: str, services: ServicesOf) -> BreakpointsBody:
    """Return the breakpoints stored with the behavior."""
    return BreakpointsBody(breakpoints=services.backend.breakpoints(behavior_id))


@router.put("/{behavior_id:path}")
async def keep_breakpoints(behavior_id: str, body: BreakpointsBody, services: ServicesOf) -> BreakpointsBody:
    """Replace the breakpoints stored with the behavior; an empty list removes the file."""
    services.backend.keep_breakpoints(behavior_id, await run_in_threadpool(to_breakpoints, body))
    return get_breakpoints(behavior_id, services)


@router.post("/{behavior_id:path}/condition")
def check_breakpoint_condition(behavior_id: str, body: Breakpoint, services: ServicesOf) -> ConditionCheck:
    """Check the condition of a breakpoint at a node of the saved behavior; nothing is kept."""
    documents = services.documents
    behavior = documents.library.behavior(behavior_id)
    return check_condition(behavior, documents.catalogue, body.path, body.condition or "", after=body.when == "after")
