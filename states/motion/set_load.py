"""motion.SetLoad: sets the payload of an arm."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.messages import Vector3
from engine.skills import arm_control
from engine.skills.arm_control import Mass
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class SetLoad(State, frozen=True, kw_only=True):
    """Set the payload that the arm compensates; 0 kg for no payload."""

    state_name: ClassVar[str] = "motion.SetLoad"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    mass_kg: Mass
    com_m: Annotated[Vector3, Meta(description="Centre of mass in the tool link", extra_json_schema={"unit": "m"})] = (
        0.0,
        0.0,
        0.0,
    )

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm."""
        request = arm_control.SetLoad(mass_kg=self.mass_kg, com_m=self.com_m)
        what = f"{self.robot} does not compensate a load of {self.mass_kg:.2f} kg"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
