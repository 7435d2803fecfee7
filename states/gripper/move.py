"""gripper.Move: moves the fingers to an opening."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.gripper import FingerSpeed, GripperMove, Width
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.gripper.gripper_parameter_types import GripperName, gripper_address
from states.gripper.gripper_undo import gripper_undo_problem, restore_gripper


class Move(State, frozen=True, kw_only=True):
    """Move the fingers of a gripper to an opening, without grasping."""

    state_name: ClassVar[str] = "gripper.Move"
    skills: ClassVar[Skills] = (GripperMove,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    gripper: GripperName
    width_m: Width
    speed_m_s: FingerSpeed = 0.1

    def resources(self) -> tuple[str, ...]:
        """Return the gripper."""
        return (gripper_address(self.gripper),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        address = gripper_address(self.gripper)
        goal = GripperMove(width_m=self.width_m, speed_m_s=self.speed_m_s)
        end = await ctx.perform(goal, to=address)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"the gripper of {self.gripper} did not reach an opening of {self.width_m * 1e3:.1f} mm"
        return Outcome("failed", cause=goal_cause(what, goal, end, to=address, where=ctx.path, kind=self.state_name))

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start state of the gripper."""
        return gripper_undo_problem(done, GripperMove)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move the fingers back to their previous opening, or grasp the released part again."""
        address = gripper_address(self.gripper)
        await restore_gripper(ctx, done, GripperMove, address=address, speed_m_s=self.speed_m_s)
