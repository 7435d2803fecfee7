"""motion.MoveLinear: moves the tool of an arm along a straight line."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.errors import StateError
from engine.messages import Pose
from engine.skills.motion import CartLinTask, ForwardKinematics
from engine.state import Context, Outcome, State
from states.failed_goal import goal_cause
from states.motion.line_time import line_duration_s
from states.motion.target import NO_OFFSET, Offset, PoseTarget, RobotName, pose_label, resolve_pose, shifted


class MoveLinear(State, frozen=True, kw_only=True):
    """Move the tool centre point on a straight line, with minimum jerk and SLERP.

    Without `target` the line starts where the tool is and goes by `offset_m`: `[0, 0, 0.1]` lifts.
    """

    state_name: ClassVar[str] = "motion.MoveLinear"
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    target: Annotated[PoseTarget | None, Meta(description="`{xyz, xyzw, frame}`, or `{entry: name}`")] = None
    offset_m: Offset = NO_OFFSET
    duration_s: Annotated[float, Meta(gt=0, description="Travel time", extra_json_schema={"unit": "s"})] | None = None
    speed_m_s: (
        Annotated[float, Meta(gt=0, description="Greatest speed on the way", extra_json_schema={"unit": "m/s"})] | None
    ) = None

    def __post_init__(self) -> None:
        if (self.duration_s is None) == (self.speed_m_s is None):
            raise ValueError("give either `duration_s` or `speed_m_s`")
        if self.target is None and self.offset_m == NO_OFFSET:
            raise ValueError("give `target`, `offset_m` or both")

    def resources(self) -> tuple[str, ...]:
        """The arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and judge its end."""
        goal = await self._goal(ctx)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not reach {pose_label(self.target, self.offset_m)} on a straight line"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

    async def _goal(self, ctx: Context) -> CartLinTask:
        if self.target is not None and self.duration_s is not None:
            pose = await resolve_pose(ctx, self.target, self.offset_m)
            return CartLinTask(pose=pose, duration_s=self.duration_s)
        start = await ctx.call(ForwardKinematics(), to=self.robot)
        if self.target is None:
            pose = shifted(start, self.offset_m, where=ctx.path)
        else:
            pose = await resolve_pose(ctx, self.target, self.offset_m)
        return CartLinTask(pose=pose, duration_s=self.duration_s or self._travel_time_s(start, pose, ctx.path))

    def _travel_time_s(self, start: Pose, end: Pose, where: str) -> float:
        if start.frame != end.frame:
            raise StateError(
                f"the speed to a target in frame {end.frame} cannot be kept: the tool is known in {start.frame}",
                where=where,
                hint="give `duration_s` instead of `speed_m_s`",
            )
        return line_duration_s(start, end, speed_m_s=self.speed_m_s or 1.0)
