"""motion.SetSpeed: slows all motions of an arm down, or lets them run at their own speed again."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.arm_control import SetSpeedOverride, Share
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class SetSpeed(State, frozen=True, kw_only=True):
    """Let all motions of the arm run at a share of their own speed from now on, the one under way included."""

    state_name: ClassVar[str] = "motion.SetSpeed"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    share: Share

    async def run(self, ctx: Context) -> Outcome:
        """Ask the arm; it needs not be held by this branch."""
        request = SetSpeedOverride(share=self.share)
        what = f"{self.robot} does not run at {self.share:.0%} of its speed"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
