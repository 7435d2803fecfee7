"""Operating a run: pause, step, step back, breakpoints, lock, force, repeat, answer, autonomy, hot change, resume."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, HTTPException
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody, ResumeQuestionsBody, StartResultBody
from editor_web.http_bodies.control_bodies import (
    AutonomyBody,
    BreakpointsBody,
    ControlBody,
    ForceBody,
    HotChangeBody,
    HotChangeResultBody,
    InterruptedRunBody,
    LockBody,
    NodeCommandBody,
    ResumeBody,
    StepBackBody,
    StepBody,
)
from editor_web.routes.breakpoints import to_breakpoints
from editor_web.routes.services import ServicesOf
from engine.errors import ControlError, FlexcellError
from engine.runtime.control import Control

router = APIRouter(
    prefix="/api/v1/runs",
    tags=["control"],
    responses={404: {"model": ErrorBody}, 409: {"model": ErrorBody}},
)
interrupted_router = APIRouter(prefix="/api/v1/interrupted", tags=["control"])


async def _control_of(run_id: str, services: ServicesOf) -> Control:
    """Return the control of a run; 404 where there is none, 409 when it is over."""
    try:
        return services.backend.control(run_id)
    except ControlError:
        raise
    except FlexcellError as error:
        raise HTTPException(404, error.message) from error


ControlOf = Annotated[Control, Depends(_control_of)]


async def _seen(control: Control) -> ControlBody:
    """Return what an operator sees once everything has happened that a command makes happen at once."""
    await control.settled()
    return ControlBody.model_validate(control.view())


@router.get("/{run_id}/control")
async def get_control(control: ControlOf) -> ControlBody:
    """Return where a run waits, what is locked, and whether it is paused."""
    return await _seen(control)


@router.post("/{run_id}/control/pause")
async def pause(control: ControlOf) -> ControlBody:
    """Hold every goal and timer; `confirmed` says when everything rests."""
    control.pause()
    return await _seen(control)


@router.post("/{run_id}/control/resume")
async def resume(control: ControlOf) -> ControlBody:
    """Let a paused run go on."""
    control.resume()
    return await _seen(control)


@router.post("/{run_id}/control/step")
async def step(control: ControlOf, body: StepBody) -> ControlBody:
    """Let a paused run make one step."""
    control.step(body.mode, body.path)
    return await _seen(control)


@router.post("/{run_id}/control/step_back")
async def step_back(run_id: str, control: ControlOf, services: ServicesOf, body: StepBackBody) -> ControlBody:
    """Undo what a paused run has begun last; it stands before that, and is paused again, once it is undone."""
    await services.backend.step_back(run_id, body.path)
    return await _seen(control)


@router.post("/{run_id}/control/lock")
async def lock(control: ControlOf, body: LockBody) -> ControlBody:
    """Hold the outcome of a node."""
    control.lock(body.path, body.reason)
    return await _seen(control)


@router.post("/{run_id}/control/unlock")
async def unlock(control: ControlOf, body: NodeCommandBody) -> ControlBody:
    """Let the outcome of a locked node pass."""
    control.unlock(body.path)
    return await _seen(control)


@router.post("/{run_id}/control/force")
async def force(control: ControlOf, body: ForceBody) -> ControlBody:
    """End a node with an outcome; what runs in it is preempted."""
    control.force(body.path, body.outcome)
    return await _seen(control)


@router.post("/{run_id}/control/repeat")
async def repeat(control: ControlOf, body: NodeCommandBody) -> ControlBody:
    """Run a node again; what runs in it is preempted first."""
    control.repeat(body.path)
    return await _seen(control)


@router.post("/{run_id}/control/answer")
async def answer(control: ControlOf, body: NodeCommandBody) -> ControlBody:
    """Agree to the outcome that a node has requested."""
    control.answer(body.path)
    return await _seen(control)


@router.post("/{run_id}/control/autonomy")
async def set_autonomy(control: ControlOf, body: AutonomyBody) -> ControlBody:
    """Set which outcomes pass without being asked for."""
    control.set_autonomy(body.level)
    return await _seen(control)


@router.post("/{run_id}/control/breakpoints")
async def set_breakpoints(control: ControlOf, body: BreakpointsBody) -> ControlBody:
    """Replace all breakpoints of a run."""
    control.set_breakpoints(await run_in_threadpool(to_breakpoints, body))
    return await _seen(control)


@router.post("/{run_id}/control/change")
async def change(
    run_id: str, control: ControlOf, services: ServicesOf, body: HotChangeBody | None = None
) -> HotChangeResultBody:
    """Let the behavior as its file is now take the place of the one that a paused run executes."""
    del control
    return HotChangeResultBody.model_validate(
        await services.backend.change(run_id, preempt=body is not None and body.preempt)
    )


@interrupted_router.get("")
async def list_interrupted(services: ServicesOf) -> list[InterruptedRunBody]:
    """List the runs of the journal whose engine died, oldest first."""
    return [InterruptedRunBody.model_validate(run) for run in services.backend.interrupted()]


@interrupted_router.post(
    "/{run_id}/resume", status_code=201, responses={409: {"model": ResumeQuestionsBody | ErrorBody}}
)
async def resume_interrupted(run_id: str, body: ResumeBody, services: ServicesOf) -> StartResultBody:
    """Go on with an interrupted run; 409 says which states that were in mid-work need an answer."""
    return StartResultBody(run=await services.backend.resume(run_id, answers=body.answers, changed=body.changed))
