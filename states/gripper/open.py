"""gripper.Open: opens a gripper fully."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.gripper import FingerSpeed, GripperOpen
from engine.skills.part_label import PartLabel
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.gripper.gripper_parameter_types import GripperName, gripper_address
from states.gripper.gripper_undo import gripper_undo_problem, restore_gripper


class Open(State, frozen=True, kw_only=True):
    """Open a gripper fully."""

    state_name: ClassVar[str] = "gripper.Open"
    skills: ClassVar[Skills] = (GripperOpen,)
    outcomes: ClassVar[tuple[str, ...]] = ("opened", "failed")
    success: ClassVar[tuple[str, ...]] = ("opened",)

    gripper: GripperName
    speed_m_s: FingerSpeed = 0.1
    part: PartLabel = ""

    def resources(self) -> tuple[str, ...]:
        """Return the gripper."""
        return (gripper_address(self.gripper),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        address = gripper_address(self.gripper)
        goal = GripperOpen(speed_m_s=self.speed_m_s)
        end = await ctx.perform(goal, to=address)
        if end.status == "succeeded":
            return Outcome("opened")
        what = f"the gripper of {self.gripper} did not open" + (f" to release part {self.part}" if self.part else "")
        return Outcome("failed", cause=goal_cause(what, goal, end, to=address, where=ctx.path, kind=self.state_name))

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start state of the gripper."""
        return gripper_undo_problem(done, GripperOpen)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move the fingers back to their previous opening, or grasp the released part again."""
        address = gripper_address(self.gripper)
        await restore_gripper(ctx, done, GripperOpen, address=address, speed_m_s=self.speed_m_s)
