"""Undo of states that move an arm: the arm returns to the start configuration of the motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from engine.errors import StateError
from engine.skill import Action
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import CartMotionResult, JointMotionResult, JointTrapVel
from engine.state import ActivationRecord, Context, goal_cause
from states.goal_history import accepted_goals

_UNKNOWN = "the start configuration of its motion was not recorded"

MotionResult = JointMotionResult | CartMotionResult


def finished_motions(done: ActivationRecord, goal: type[Action[Any, Any]]) -> Iterator[MotionResult]:
    """Yield the motions of an activation, newest first.

    Raises:
        StateError: the start configuration of a motion was not recorded.
    """
    for _, result in accepted_goals(done, goal):
        if not isinstance(result, MotionResult) or not result.start:
            raise StateError(_UNKNOWN)
        yield result


def motion_undo_problem(done: ActivationRecord, goal: type[Action[Any, Any]]) -> str:
    """Return why the motions of an activation cannot be undone; empty if they can."""
    try:
        for _ in finished_motions(done, goal):
            pass
    except StateError as error:
        return error.message
    return ""


async def move_joints_back(
    ctx: Context,
    done: ActivationRecord,
    goal: type[Action[Any, Any]],
    *,
    robot: str,
    speed: float,
    collisions: CollisionOptions,
) -> None:
    """Move an arm in joint space to the start of the motions of an activation.

    Raises:
        StateError: the arm did not reach it; the cause is the device's.
    """
    for motion in finished_motions(done, goal):
        back = JointTrapVel(joints=motion.start, speed=speed, collisions=collisions)
        await perform_undo_motion(ctx, back, robot=robot)


async def perform_undo_motion(ctx: Context, goal: Action[Any, Any], *, robot: str) -> None:
    """Perform a motion that must succeed.

    Raises:
        StateError: the motion failed; the message holds the device's cause.
    """
    end = await ctx.perform(goal, to=robot)
    if end.status == "succeeded":
        return
    what = f"{robot} did not return to the start of its motion"
    cause = goal_cause(what, goal, end, to=robot, where=ctx.path, kind="undo")
    below = f": {cause.because.message}" if cause.because is not None else ""
    raise StateError(f"{cause.message}{below}", where=ctx.path)
