"""motion.SetToolFrame: sets the tool centre point of an arm."""

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
    """Set the tool centre point in the tool link of the model; without parameters, at the link's origin."""

    state_name: ClassVar[str] = "motion.SetToolFrame"
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    xyz_m: Annotated[Vector3, Meta(description="Position in the tool link", extra_json_schema={"unit": "m"})] = (
        NO_OFFSET
    )
    xyzw: Annotated[Quaternion, Meta(description="Orientation in the tool link, x y z w")] = (0.0, 0.0, 0.0, 1.0)

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ToolChange, ...]:
        """Return the change of the tool frame, which applies to all later pose targets."""
        return (ToolChange(robot=self.robot),)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm."""
        request = SetEndEffectorFrame(xyz_m=self.xyz_m, xyzw=self.xyzw)
        what = f"{self.robot} did not set its tool centre point"
        return await call_or_fail(ctx, request, to=self.robot, done="set", what=what, kind=self.state_name)
