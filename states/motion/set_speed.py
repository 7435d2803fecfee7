"""motion.SetSpeed: sets the speed override of an arm."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.arm_control import SetSpeedOverride, Share
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class SetSpeed(State, frozen=True, kw_only=True):
    """Set the speed override: all motions of the arm, the active one included, run at this fraction of their speed."""

    state_name: ClassVar[str] = "motion.SetSpeed"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    share: Share

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm; it needs no lease."""
        request = SetSpeedOverride(share=self.share)
        what = f"{self.robot} did not set its speed override to {self.share:.0%}"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
