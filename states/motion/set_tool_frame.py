"""motion.SetToolFrame: says which point of the tool Cartesian motions mean."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.messages import Quaternion, Vector3
from engine.skills.arm_control import SetEndEffectorFrame
from engine.skills.arm_target import StoredTargets, ToolChange
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import NO_OFFSET, RobotName


class SetToolFrame(State, frozen=True, kw_only=True):
    """Put the tool centre point elsewhere, in the tool link of the model; without parameters back to its origin."""

    state_name: ClassVar[str] = "motion.SetToolFrame"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    xyz_m: Annotated[Vector3, Meta(description="Where it is", extra_json_schema={"unit": "m"})] = NO_OFFSET
    xyzw: Annotated[Quaternion, Meta(description="How it is turned")] = (0.0, 0.0, 0.0, 1.0)

    def resources(self) -> tuple[str, ...]:
        """The arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ToolChange, ...]:
        """What poses mean afterwards."""
        return (ToolChange(robot=self.robot),)

    async def run(self, ctx: Context) -> Outcome:
        """Ask the arm."""
        request = SetEndEffectorFrame(xyz_m=self.xyz_m, xyzw=self.xyzw)
        what = f"{self.robot} did not take another tool centre point"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
