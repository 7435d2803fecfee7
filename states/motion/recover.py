"""motion.Recover: recovers an arm from a reflex stop."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.arm_control import RecoverFromError
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class Recover(State, frozen=True, kw_only=True):
    """Recover an arm from its reflex stop: it holds its position and accepts goals. No effect without a reflex."""

    state_name: ClassVar[str] = "motion.Recover"
    outcomes: ClassVar[tuple[str, ...]] = ("recovered", "failed")
    success: ClassVar[tuple[str, ...]] = ("recovered",)

    robot: RobotName

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm."""
        what = f"{self.robot} did not recover"
        return await call_or_fail(
            ctx, RecoverFromError(), to=self.robot, done="recovered", what=what, kind=self.state_name
        )
