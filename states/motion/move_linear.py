"""motion.MoveLinear: moves the tool of an arm along a straight line."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.errors import StateError
from engine.messages import Pose
from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.motion import CartLinTask, CartMotionResult, ForwardKinematics
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.motion.line_duration import SHORTEST_S, line_duration_s
from states.motion.motion_target import (
    NO_OFFSET,
    JointTarget,
    Offset,
    PoseTarget,
    RetractDistance,
    RobotName,
    joints_label,
    offset_pose,
    pose_label,
    resolve_joints,
    resolve_pose,
    retracted_pose,
)
from states.motion.motion_undo import MotionResult, finished_motions, motion_undo_problem, perform_undo_motion
from states.motion.static_target import static_joint_target, static_pose_target


class MoveLinear(State, frozen=True, kw_only=True):
    """Move the tool centre point on a straight line, with minimum jerk and SLERP.

    The goal is the pose `target`, or the pose of the tool at `joints`. Without either, the motion is relative to the
    current pose: by `offset_m` (`[0, 0, 0.1]` lifts) or by `back_m`.
    """

    state_name: ClassVar[str] = "motion.MoveLinear"
    skills: ClassVar[Skills] = (CartLinTask,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    target: Annotated[PoseTarget | None, Meta(description="`{xyz, xyzw, frame}`, or `{entry: name}`")] = None
    joints: Annotated[JointTarget | None, Meta(description="Joint angles in radians, or `{entry: name}`")] = None
    offset_m: Offset = NO_OFFSET
    back_m: RetractDistance = 0.0
    duration_s: Annotated[float, Meta(gt=0, description="Travel time", extra_json_schema={"unit": "s"})] | None = None
    speed_m_s: (
        Annotated[float, Meta(gt=0, description="Maximum speed along the line", extra_json_schema={"unit": "m/s"})]
        | None
    ) = None
    collisions: PathCollisions = CollisionOptions()

    def __post_init__(self) -> None:
        if (self.duration_s is None) == (self.speed_m_s is None):
            raise ValueError("give either `duration_s` or `speed_m_s`")
        if self.target is not None and self.joints is not None:
            raise ValueError("give either `target` or `joints`")
        if self.target is None and self.joints is None and self.offset_m == NO_OFFSET and not self.back_m:
            raise ValueError("give `target`, `joints`, `offset_m` or `back_m`")

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget, ...]:
        """Return the end of the line, if it does not depend on the arm's kinematics or its current pose."""
        if self.joints is not None and self.offset_m == NO_OFFSET and not self.back_m:
            return static_joint_target(self.robot, self.joints, stored, parameter="joints")
        return static_pose_target(
            self.robot, self.target, stored, parameter="target", offset_m=self.offset_m, back_m=self.back_m
        )

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        goal = await self._goal(ctx)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not reach {self._label()} on a straight line"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start configuration."""
        return motion_undo_problem(done, CartLinTask)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move back on a straight line to the start of the motion, in the same time."""
        for motion in finished_motions(done, CartLinTask):
            pose = await ctx.call(ForwardKinematics(joints=motion.start), to=self.robot)
            time_s = self._time_back_s(motion, pose)
            back = CartLinTask(pose=pose, duration_s=time_s, collisions=self.collisions)
            await perform_undo_motion(ctx, back, robot=self.robot)

    def _time_back_s(self, motion: MotionResult, pose: Pose) -> float:
        """Return the duration of the line, measured or given; pauses do not count."""
        if self.duration_s is not None:
            return min(self.duration_s, max(motion.duration_s, SHORTEST_S))
        end = motion.pose if isinstance(motion, CartMotionResult) else pose
        return line_duration_s(end, pose, speed_m_s=self.speed_m_s or 1.0)

    def _label(self) -> str:
        back = f"{self.back_m:.3g} m before " if self.back_m else ""
        return back + (joints_label(self.joints) if self.joints is not None else pose_label(self.target, self.offset_m))

    async def _goal(self, ctx: Context) -> CartLinTask:
        if self.target is not None and self.duration_s is not None:
            pose = retracted_pose(await resolve_pose(ctx, self.target, self.offset_m), self.back_m)
            return CartLinTask(pose=pose, duration_s=self.duration_s, collisions=self.collisions)
        start = await ctx.call(ForwardKinematics(), to=self.robot)
        if self.target is not None:
            pose = await resolve_pose(ctx, self.target, self.offset_m)
        else:
            pose = start
            if self.joints is not None:
                pose = await ctx.call(ForwardKinematics(joints=await resolve_joints(ctx, self.joints)), to=self.robot)
            pose = offset_pose(pose, self.offset_m, where=ctx.path)
        pose = retracted_pose(pose, self.back_m)
        return CartLinTask(
            pose=pose,
            duration_s=self.duration_s or self._travel_time_s(start, pose, ctx.path),
            collisions=self.collisions,
        )

    def _travel_time_s(self, start: Pose, end: Pose, where: str) -> float:
        if start.frame != end.frame:
            raise StateError(
                f"`speed_m_s` needs target and tool in one frame, not {end.frame} and {start.frame}",
                where=where,
                hint="give `duration_s` instead of `speed_m_s`",
            )
        return line_duration_s(start, end, speed_m_s=self.speed_m_s or 1.0)
