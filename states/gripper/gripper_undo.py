"""How the states of a gripper are undone: the fingers go back to how they were before."""

from __future__ import annotations

from typing import Any

from engine.errors import StateError
from engine.skill import Action
from engine.skills.gripper import GraspResult, GripperGrasp, GripperMove, GripperSetting
from engine.state import ActivationRecord, Context
from states.goal_history import accepted_goals


def gripper_undo_problem(done: ActivationRecord, goal: type[Action[GraspResult, Any]]) -> str:
    """Return why a gripper cannot be brought back to how it was before an activation; empty where it can."""
    unknown = any(_start(result) is None for _, result in accepted_goals(done, goal))
    return "it is not known how the gripper was before" if unknown else ""


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
    """Let go of what was grasped, or grasp again what was let go of.

    Raises:
        StateError: the fingers did not get there, or hold nothing where they held something.
    """
    for _, result in accepted_goals(done, goal):
        start = _start(result)
        if start is None:
            raise StateError(gripper_undo_problem(done, goal), where=ctx.path)
        if start.held:
            again: GripperGrasp | GripperMove = GripperGrasp(
                width_m=start.width_m, force_n=start.force_n, speed_m_s=speed_m_s
            )
        else:
            again = GripperMove(width_m=start.width_m, speed_m_s=speed_m_s)
        end = await ctx.perform(again, to=address)
        if end.status != "succeeded" or end.result is None:
            because = f": {end.cause.message}" if end.cause is not None else ""
            raise StateError(f"{address} did not get back to {start.width_m * 1e3:.1f} mm{because}", where=ctx.path)
        if start.held and not end.result.held:
            raise StateError(f"{address} does not hold again what it held: {end.result.reason}", where=ctx.path)
