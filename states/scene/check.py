"""scene.Check: checks an arm for collisions and reports its clearance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import Cause, SkillFailed
from engine.skills.planning import Margin
from engine.skills.planning_scene import CheckCollision, CollisionReport
from engine.state import Context, Outcome, State, nothing_to_undo
from states.motion.motion_target import JointTarget, RobotName, joints_label, resolve_joints
from states.scene.scene_parameter_types import CELL


class Check(State, frozen=True, kw_only=True):
    """Check an arm for collisions at its current joints or at `joints`: `free` if the clearance is at least `margin_m`.

    Writes the distance to the nearest body, and the pairs in contact as `first with second`.
    """

    state_name: ClassVar[str] = "scene.Check"
    outcomes: ClassVar[tuple[str, ...]] = ("free", "touching", "failed")
    success: ClassVar[tuple[str, ...]] = ("free",)
    outputs: ClassVar[Mapping[str, Any]] = {"distance_m": float, "touching": list[str]}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("distance_m", "touching")}
    undo = nothing_to_undo

    robot: RobotName
    joints: Annotated[
        JointTarget | None, Meta(description="Joint angles in radians, or `{entry: name}`; the current ones by default")
    ] = None
    margin_m: Margin = 0.0

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell and return the outcome of its report."""
        joints = await resolve_joints(ctx, self.joints) if self.joints is not None else ()
        request = CheckCollision(robot=self.robot, joints=joints)
        try:
            report = await ctx.call(request, to=CELL)
        except SkillFailed as error:
            what = f"{self.robot} was not checked for collisions"
            return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=self.state_name))
        pairs = [f"{pair.first} with {pair.second}" for pair in report.touching]
        outputs: dict[str, object] = {"distance_m": report.distance_m, "touching": pairs}
        if not pairs and report.distance_m >= self.margin_m:
            return Outcome("free", outputs)
        because = Cause(message=self._describe(report, pairs), where=f"{CELL}/{request.skill_name()}")
        posture = f" at {joints_label(self.joints)}" if self.joints is not None else ""
        message = f"{self.robot} is not free{posture}"
        return Outcome("touching", outputs, wrap_cause(message, because, where=ctx.path, kind=self.state_name))

    def _describe(self, report: CollisionReport, pairs: list[str]) -> str:
        if pairs:
            return f"{', '.join(pairs)} touch"
        first, second = report.nearest
        return f"{first} is {report.distance_m * 1e3:.1f} mm from {second}, {self.margin_m * 1e3:.1f} mm required"
