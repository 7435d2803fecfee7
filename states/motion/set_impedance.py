"""motion.SetImpedance: sets the stiffness of the joints or the tool of an arm."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.messages import Vector6
from engine.skill import Service
from engine.skills.arm_control import ControlSettings, Damping, JointRow, SetCartesianImpedance, SetJointImpedance
from engine.state import Context, Outcome, Skills, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName


class SetImpedance(State, frozen=True, kw_only=True):
    """Set the stiffness of the joints (`joints`) or of the tool (`tool`); the damping follows from it.

    It takes effect while the matching controller is active, see `motion.SetController`.
    """

    state_name: ClassVar[str] = "motion.SetImpedance"
    skills: ClassVar[Skills] = (SetJointImpedance, SetCartesianImpedance)
    outcomes: ClassVar[tuple[str, ...]] = ("set", "failed")
    success: ClassVar[tuple[str, ...]] = ("set",)

    robot: RobotName
    joints: Annotated[
        JointRow | None, Meta(description="Stiffness in N m/rad, one per joint; `[]` for the nominal values")
    ] = None
    tool: Annotated[
        Vector6 | None, Meta(description="Stiffness in N/m along x, y, z of the base, then in N m/rad about them")
    ] = None
    damping_ratio: Damping = 1.0

    def __post_init__(self) -> None:
        if (self.joints is None) == (self.tool is None):
            raise ValueError("give either `joints` or `tool`")

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the arm."""
        what = f"{self.robot} did not set its stiffness"
        return await call_or_fail(ctx, self._request(), to=self.robot, done="set", what=what, kind=self.state_name)

    def _request(self) -> Service[ControlSettings]:
        if self.tool is not None:
            return SetCartesianImpedance(stiffness=self.tool, damping_ratio=self.damping_ratio)
        return SetJointImpedance(stiffness_nm_rad=self.joints or (), damping_ratio=self.damping_ratio)
