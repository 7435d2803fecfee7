"""motion.MoveFree: moves an arm along a collision-free path."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import SkillFailed
from engine.skills import planning
from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.motion import PoseMatch, Speed
from engine.skills.planning import BlockedPathTimeout, KeepOrientation, Margin, MotionTarget, PlannerName, PlanningTime
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import NO_OFFSET, Offset, RetractDistance, RobotName
from states.motion.planned_motion_result import inner_cause_text, is_blocked_timeout
from states.motion.planned_motion_target import (
    GoalJoints,
    GoalPose,
    Seed,
    WatchPath,
    require_one,
    resolve_target,
    retracted_target,
    target_label,
)
from states.motion.primitive import MotionStart, resolve_start
from states.motion.static_target import static_joint_target, static_pose_target

Start = Annotated[
    MotionStart | None,
    Meta(
        description="Taught motion whose start is the target: `{dmp: name}`, `{cart_dmp: name}`, `{trajectory: name}`"
    ),
]


class MoveFree(State, frozen=True, kw_only=True):
    """Plan a path free of collisions with the planning scene and what the cameras see, and execute it.

    The target is `joints`, `pose` or the start of a taught motion (`start_of`); `back_m` stops before the target.

    If an obstacle blocks the path, the arm replans or waits: `blocked` after `patience_s` of waiting. `no_way` when
    start, goal or limits allow no path; the arm has not moved then. All outcomes but `reached` write the `reason`.
    """

    state_name: ClassVar[str] = "motion.MoveFree"
    skills: ClassVar[Skills] = (planning.MoveFree,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "blocked", "no_way", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"reached": ("reason",)}

    robot: RobotName
    joints: GoalJoints = None
    pose: GoalPose = None
    start_of: Start = None
    offset_m: Offset = NO_OFFSET
    back_m: RetractDistance = 0.0
    match: PoseMatch = "pose"
    speed: Speed = 0.3
    patience_s: BlockedPathTimeout = 60.0
    watch: WatchPath = True
    planner: PlannerName = "fast"
    time_s: PlanningTime = 1.0
    margin_m: Margin = 0.0
    keep_orientation: KeepOrientation | None = None
    seed: Seed = 0

    def __post_init__(self) -> None:
        if self.start_of is None:
            require_one(self.joints, self.pose)
        elif self.joints is not None or self.pose is not None:
            raise ValueError("give `joints`, `pose` or `start_of`")

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget, ...]:
        """Return the target; nothing for a retracted joint target, which depends on the arm's kinematics."""
        if self.joints is not None:
            return () if self.back_m else static_joint_target(self.robot, self.joints, stored, parameter="joints")
        return static_pose_target(
            self.robot,
            self.pose,
            stored,
            parameter="pose",
            offset_m=self.offset_m,
            back_m=self.back_m,
            match=self.match,
        )

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        options = planning.PlanOptions(
            planner=self.planner,
            time_s=self.time_s,
            seed=self.seed,
            margin_m=self.margin_m,
            keep_orientation=self.keep_orientation,
            speed=self.speed,
        )
        try:
            target = await self._target(ctx)
        except SkillFailed as error:
            cause = wrap_cause(self._failure(), cause_of(error), where=ctx.path, kind=self.state_name)
            return Outcome("no_way", {"reason": inner_cause_text(cause)}, cause)
        adaptation = planning.Adaptation(watch=self.watch, patience_s=self.patience_s)
        goal = planning.MoveFree(target=target, options=options, adaptation=adaptation)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        cause = goal_cause(self._failure(), goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        name = "no_way" if end.status == "rejected" else "blocked" if is_blocked_timeout(end) else "failed"
        return Outcome(name, {"reason": inner_cause_text(cause)}, cause)

    async def _target(self, ctx: Context) -> MotionTarget:
        if self.start_of is not None:
            target = await resolve_start(ctx, self.start_of)
        else:
            target = await resolve_target(ctx, self.joints, self.pose, self.offset_m, self.match)
        return await retracted_target(ctx, self.robot, target, self.back_m) if self.back_m else target

    def _failure(self) -> str:
        start = self.start_of
        where = start.label if start is not None else target_label(self.joints, self.pose, self.offset_m)
        back = f"{self.back_m:.3g} m before " if self.back_m else ""
        return f"{self.robot} did not reach {back}{where}"
