"""motion.SetCollision: sets the collision thresholds of an arm."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.arm_control import JointRow, SetCollisionBehavior
from engine.state import Context, Outcome, Skills, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName

Force = Annotated[
    float,
    Meta(gt=0, description="External force at the tool", extra_json_schema={"unit": "N", "measured_on": "wrench"}),
]


class SetCollision(State, frozen=True, kw_only=True):
    """Set the external torque or force above which the arm stops; without either, it never stops on contact."""

    state_name: ClassVar[str] = "motion.SetCollision"
    skills: ClassVar[Skills] = (SetCollisionBehavior,)
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    torque_nm: Annotated[JointRow, Meta(description="External torque in N m, one per joint; `[]` disables it")] = ()
    force_n: Force | None = None

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm."""
        request = SetCollisionBehavior(torque_nm=self.torque_nm, force_n=self.force_n)
        what = f"{self.robot} did not set its collision thresholds"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
