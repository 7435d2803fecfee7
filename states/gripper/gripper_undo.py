"""Undo of gripper states: restores the opening and grasp of the fingers before the state."""

from __future__ import annotations

from typing import Any

from engine.errors import StateError
from engine.skill import Action
from engine.skills.gripper import GraspResult, GripperGrasp, GripperMove, GripperSetting
from engine.state import ActivationRecord, Context
from states.goal_history import accepted_goals


def gripper_undo_problem(done: ActivationRecord, goal: type[Action[GraspResult, Any]]) -> str:
    """Return why the state of a gripper before an activation cannot be restored; empty if it can."""
    unknown = any(_start(result) is None for _, result in accepted_goals(done, goal))
    return "the state of the gripper before the activation was not recorded" if unknown else ""


def _start(result: GraspResult | None) -> GripperSetting | None:
    return result.start if result is not None and isinstance(result.start, GripperSetting) else None


async def restore_gripper(
    ctx: Context,
    done: ActivationRecord,
    goal: type[Action[GraspResult, Any]],
    *,
    address: str,
    speed_m_s: float,
) -> None:
    """Release the part that was grasped, or grasp again the part that was released.

    Raises:
        StateError: the fingers did not reach the opening, or do not hold the part that they held before.
    """
    for _, result in accepted_goals(done, goal):
        start = _start(result)
        if start is None:
            raise StateError(gripper_undo_problem(done, goal), where=ctx.path)
        if start.held:
            restoring: GripperGrasp | GripperMove = GripperGrasp(
                width_m=start.width_m, force_n=start.force_n, speed_m_s=speed_m_s
            )
        else:
            restoring = GripperMove(width_m=start.width_m, speed_m_s=speed_m_s)
        end = await ctx.perform(restoring, to=address)
        if end.status != "succeeded" or end.result is None:
            because = f": {end.cause.message}" if end.cause is not None else ""
            raise StateError(f"{address} did not return to {start.width_m * 1e3:.1f} mm{because}", where=ctx.path)
        if start.held and not end.result.held:
            raise StateError(
                f"{address} did not grasp again the part that it held: {end.result.reason}", where=ctx.path
            )
