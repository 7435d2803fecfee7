"""motion.PlanMotion: plans a collision-free path and shows it, without executing it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.skills import planning
from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.motion import PoseMatch, Speed
from engine.skills.planning import KeepOrientation, Margin, PlannedMotion, PlannerName, PlanningTime
from engine.state import Context, Outcome, State, goal_cause, nothing_to_undo
from states.motion.motion_target import NO_OFFSET, Offset, RobotName
from states.motion.planned_motion_result import inner_cause_text
from states.motion.planned_motion_target import GoalJoints, GoalPose, Seed, require_one, resolve_target, target_label
from states.motion.static_target import static_joint_target, static_pose_target

_REFUSED = ("GoalRejected", "SkillFailed")
"""Kinds of cause that mean that the planner found no path; any other kind is a failed request."""


class PlanMotion(State, frozen=True, kw_only=True):
    """Plan a path to `joints` or `pose` free of collisions with the planning scene, and show it in the 3D view.

    The arm does not move. Writes the path as `plan`, for `motion.ExecutePlan`. `no_way` writes the `reason`: the
    collision at the start or the goal, or that the search ended without a path.
    """

    state_name: ClassVar[str] = "motion.PlanMotion"
    icon: ClassVar[str] = "plan"
    outcomes: ClassVar[tuple[str, ...]] = ("planned", "no_way", "failed")
    success: ClassVar[tuple[str, ...]] = ("planned",)
    outputs: ClassVar[Mapping[str, Any]] = {"plan": PlannedMotion, "reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "planned": ("reason",),
        "no_way": ("plan",),
        "failed": ("plan",),
    }
    undo = nothing_to_undo

    robot: RobotName
    joints: GoalJoints = None
    pose: GoalPose = None
    offset_m: Offset = NO_OFFSET
    match: PoseMatch = "pose"
    speed: Speed = 0.3
    planner: PlannerName = "fast"
    time_s: PlanningTime = 1.0
    margin_m: Margin = 0.0
    keep_orientation: KeepOrientation | None = None
    seed: Seed = 0

    def __post_init__(self) -> None:
        require_one(self.joints, self.pose)

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget, ...]:
        """Return the target."""
        if self.joints is not None:
            return static_joint_target(self.robot, self.joints, stored, parameter="joints")
        return static_pose_target(
            self.robot, self.pose, stored, parameter="pose", offset_m=self.offset_m, match=self.match
        )

    async def run(self, ctx: Context) -> Outcome:
        """Send the request to the planner and return the outcome of its result."""
        options = planning.PlanOptions(
            planner=self.planner,
            time_s=self.time_s,
            seed=self.seed,
            margin_m=self.margin_m,
            keep_orientation=self.keep_orientation,
            speed=self.speed,
        )
        target = await resolve_target(ctx, self.joints, self.pose, self.offset_m, self.match)
        goal = planning.PlanMotion(target=target, options=options)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded" and end.result is not None:
            return Outcome("planned", {"plan": end.result})
        what = f"no path of {self.robot} to {target_label(self.joints, self.pose, self.offset_m)} was planned"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        refused = end.cause is not None and end.cause.kind in _REFUSED
        return Outcome("no_way" if refused else "failed", {"reason": inner_cause_text(cause)}, cause)
