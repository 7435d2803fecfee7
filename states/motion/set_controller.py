"""motion.SetController: chooses the law that holds an arm at its set point."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills import arm_control
from engine.skills.arm_control import ControllerName
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class SetController(State, frozen=True, kw_only=True):
    """Hold the arm by joint impedance or by Cartesian impedance from now on; it does not jump."""

    state_name: ClassVar[str] = "motion.SetController"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    controller: Annotated[ControllerName, Meta(description="The control law")]

    def resources(self) -> tuple[str, ...]:
        """The arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Ask the arm."""
        request = arm_control.SetController(controller=self.controller)
        what = f"{self.robot} is not held by {self.controller.replace('_', ' ')}"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
