"""motion.SetController: selects the control law that holds an arm at its set point."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills import arm_control
from engine.skills.arm_control import ControllerName
from engine.state import Context, Outcome, Skills, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class SetController(State, frozen=True, kw_only=True):
    """Switch the arm to joint impedance or Cartesian impedance control; the switch is bumpless."""

    state_name: ClassVar[str] = "motion.SetController"
    skills: ClassVar[Skills] = (arm_control.SetController,)
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    controller: Annotated[ControllerName, Meta(description="Control law")]

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm."""
        request = arm_control.SetController(controller=self.controller)
        what = f"{self.robot} did not switch to {self.controller.replace('_', ' ')}"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
