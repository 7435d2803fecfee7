"""gripper.Grasp: closes a gripper on a part and checks that it holds it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause, MeasuredValue
from engine.skills.gripper import FingerSpeed, GraspResult, GripperGrasp, Width
from engine.skills.part_label import PartLabel, part_label, wrong_part
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.gripper.gripper_parameter_types import GripperName, gripper_address
from states.gripper.gripper_undo import gripper_undo_problem, restore_gripper

Force = Annotated[
    float,
    Meta(
        gt=0,
        le=1000,
        description="Grasp force",
        extra_json_schema={"unit": "N", "measured_on": "gripper/state"},
    ),
]
Margin = Annotated[
    float,
    Meta(ge=0, description="Allowed deviation of the final opening from `width_m`", extra_json_schema={"unit": "m"}),
]


class Grasp(State, frozen=True, kw_only=True):
    """Close on a part of `width_m`: `held` when both pads press on it, else `missed`, also when they hold another one.

    `part` is compared with the body that the pads touch. A gripper that measures none reports `by: width`:
    something of this width is held. Always writes `held`; writes the final opening `width_m` if the gripper
    measured it.
    """

    state_name: ClassVar[str] = "gripper.Grasp"
    skills: ClassVar[Skills] = (GripperGrasp,)
    outcomes: ClassVar[tuple[str, ...]] = ("held", "missed", "failed")
    success: ClassVar[tuple[str, ...]] = ("held",)
    outputs: ClassVar[Mapping[str, Any]] = {"held": bool, "width_m": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("width_m",)}

    gripper: GripperName
    width_m: Width
    force_n: Force = 20.0
    speed_m_s: FingerSpeed = 0.05
    tolerance_inner_m: Margin = 0.01
    tolerance_outer_m: Margin = 0.01
    part: PartLabel = ""

    def resources(self) -> tuple[str, ...]:
        """Return the gripper."""
        return (gripper_address(self.gripper),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return whether the fingers hold the part."""
        address = gripper_address(self.gripper)
        goal = GripperGrasp(
            width_m=self.width_m,
            force_n=self.force_n,
            speed_m_s=self.speed_m_s,
            tolerance_inner_m=self.tolerance_inner_m,
            tolerance_outer_m=self.tolerance_outer_m,
        )
        end = await ctx.perform(goal, to=address)
        if end.status != "succeeded" or end.result is None:
            cause = goal_cause(self._failure(), goal, end, to=address, where=ctx.path, kind=self.state_name)
            return Outcome("failed", {"held": False}, cause)
        where = f"{address}/{goal.skill_name()}"
        wrong = wrong_part(self.part, end.result.part, where=where)
        held = end.result.held and wrong is None
        outputs = {"held": held, "width_m": end.result.width_m}
        if held:
            return Outcome("held", outputs)
        because = wrong or self._missed_cause(end.result, where)
        return Outcome("missed", outputs, wrap_cause(self._failure(), because, where=ctx.path, kind=self.state_name))

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start state of the gripper."""
        return gripper_undo_problem(done, GripperGrasp)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move the fingers back to their opening before the grasp, which releases the part."""
        address = gripper_address(self.gripper)
        await restore_gripper(ctx, done, GripperGrasp, address=address, speed_m_s=self.speed_m_s)

    def _failure(self) -> str:
        return f"{self.gripper} did not grasp {part_label(self.part)}"

    def _missed_cause(self, result: GraspResult, address: str) -> Cause:
        opening = f"the fingers ended {result.width_m * 1e3:.1f} mm apart, {self.width_m * 1e3:.1f} mm expected"
        return Cause(
            message=f"{opening}, pressing with {result.force_n:.1f} N",
            where=address,
            compared=(
                MeasuredValue(
                    quantity="opening",
                    measured=result.width_m * 1e3,
                    unit="mm",
                    least=(self.width_m - self.tolerance_inner_m) * 1e3,
                    most=(self.width_m + self.tolerance_outer_m) * 1e3,
                ),
            ),
            because=Cause(message=result.reason, where=address) if result.reason else None,
        )
