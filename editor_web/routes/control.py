"""Operating a run: pause, steps, breakpoints, lock, force, repeat, answer, userdata, autonomy, hot change, resume."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, HTTPException
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody, ResumeQuestionsBody, StartResultBody
from editor_web.http_bodies.control_bodies import (
    AutonomyBody,
    BreakpointsBody,
    ForceBody,
    HotChangeBody,
    HotChangeResultBody,
    LockBody,
    NodeCommandBody,
    ResumeBody,
    StepBackBody,
    StepBody,
    UserdataBody,
)
from editor_web.routes.breakpoints import to_breakpoints
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.errors import ControlError, FlexcellError
from engine.project import InterruptedRun
from engine.runtime.control import Control, ControlView

router = WireRouter(
    prefix="/api/v1/runs",
    tags=["control"],
    responses={404: {"model": ErrorBody}, 409: {"model": ErrorBody}},
)
interrupted_router = WireRouter(prefix="/api/v1/interrupted", tags=["control"])


async def _control_of(run_id: str, services: ServicesOf) -> Control:
    """Return the control of a run; 404 if there is none, 409 if it has ended."""
    try:
        return services.backend.control(run_id)
    except ControlError:
        raise
    except FlexcellError as error:
        raise HTTPException(404, error.message) from error


ControlOf = Annotated[Control, Depends(_control_of)]


async def _settled_view(control: Control) -> ControlView:
    """Return the operator's view after the immediate effects of a command."""
    await control.settled()
    return control.view()


@router.get("/{run_id}/control")
async def get_control(control: ControlOf) -> ControlView:
    """Return the waiting nodes, the locks and the pause state of a run."""
    return await _settled_view(control)


@router.post("/{run_id}/control/pause")
async def pause(control: ControlOf) -> ControlView:
    """Pause a run: hold every goal and timer; `confirmed` becomes true when everything is at rest."""
    control.pause()
    return await _settled_view(control)


@router.post("/{run_id}/control/resume")
async def resume(control: ControlOf) -> ControlView:
    """Resume a paused run."""
    control.resume()
    return await _settled_view(control)


@router.post("/{run_id}/control/step")
async def step(control: ControlOf, body: StepBody) -> ControlView:
    """Make one step of a paused run."""
    control.step(body.mode, body.path)
    return await _settled_view(control)


@router.post("/{run_id}/control/step_back")
async def step_back(run_id: str, control: ControlOf, services: ServicesOf, body: StepBackBody) -> ControlView:
    """Undo the last activation of a paused run; after the undo, the run is paused before that activation."""
    await services.backend.step_back(run_id, body.path)
    return await _settled_view(control)


@router.post("/{run_id}/control/lock")
async def lock(control: ControlOf, body: LockBody) -> ControlView:
    """Hold the outcome of a node."""
    control.lock(body.path, body.reason)
    return await _settled_view(control)


@router.post("/{run_id}/control/unlock")
async def unlock(control: ControlOf, body: NodeCommandBody) -> ControlView:
    """Release the outcome of a locked node."""
    control.unlock(body.path)
    return await _settled_view(control)


@router.post("/{run_id}/control/force")
async def force(control: ControlOf, body: ForceBody) -> ControlView:
    """End a node with an outcome; everything that runs in it is preempted."""
    control.force(body.path, body.outcome)
    return await _settled_view(control)


@router.post("/{run_id}/control/repeat")
async def repeat(control: ControlOf, body: NodeCommandBody) -> ControlView:
    """Run a node again; everything that runs in it is preempted first."""
    control.repeat(body.path)
    return await _settled_view(control)


@router.post("/{run_id}/control/answer")
async def answer(control: ControlOf, body: NodeCommandBody) -> ControlView:
    """Approve the outcome that a node has requested."""
    control.answer(body.path)
    return await _settled_view(control)


@router.get("/{run_id}/control/userdata")
async def get_userdata(control: ControlOf, key: str, scope: str = "") -> UserdataBody:
    """Return a value of an active container; what `/data` shows of a large one is truncated."""
    return UserdataBody(scope=scope, key=key, value=control.userdata(scope, key))


@router.post("/{run_id}/control/userdata")
async def set_userdata(control: ControlOf, body: UserdataBody) -> ControlView:
    """Replace a value of the userdata of a paused run; the path of its scope is the one that `/data` shows."""
    control.set_userdata(body.scope, body.key, body.value)
    return await _settled_view(control)


@router.post("/{run_id}/control/autonomy")
async def set_autonomy(control: ControlOf, body: AutonomyBody) -> ControlView:
    """Set the autonomy level: outcomes below it pass without an answer."""
    control.set_autonomy(body.level)
    return await _settled_view(control)


@router.post("/{run_id}/control/breakpoints")
async def set_breakpoints(control: ControlOf, body: BreakpointsBody) -> ControlView:
    """Replace all breakpoints of a run."""
    control.set_breakpoints(await run_in_threadpool(to_breakpoints, body))
    return await _settled_view(control)


@router.post("/{run_id}/control/change")
async def change(
    run_id: str, control: ControlOf, services: ServicesOf, body: HotChangeBody | None = None
) -> HotChangeResultBody:
    """Replace the behavior of a paused run by the current version of its file."""
    del control
    report = await services.backend.change(run_id, preempt=body is not None and body.preempt)
    return HotChangeResultBody(changes=report.changes)


@interrupted_router.get("")
async def list_interrupted(services: ServicesOf) -> tuple[InterruptedRun, ...]:
    """List the interrupted runs of the journal, oldest first."""
    return await run_in_threadpool(services.backend.interrupted)


@interrupted_router.post(
    "/{run_id}/resume", status_code=201, responses={409: {"model": ResumeQuestionsBody | ErrorBody}}
)
async def resume_interrupted(run_id: str, body: ResumeBody, services: ServicesOf) -> StartResultBody:
    """Resume an interrupted run; 409 lists the states that were active and need an answer."""
    return StartResultBody(run=await services.backend.resume(run_id, answers=body.answers, changed=body.changed))
