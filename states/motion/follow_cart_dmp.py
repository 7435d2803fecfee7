"""motion.FollowCartDmp: moves the tool of an arm along a Cartesian movement primitive."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.dmp import CartDMP
from engine.skills.motion import CartTrapVel
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import NO_OFFSET, Offset, PoseTarget, RobotName, resolve_pose
from states.motion.primitive import ApproachSpeed, CartDmpEntry, TimeScale, resolve_cart_dmp


class FollowCartDmp(State, frozen=True, kw_only=True):
    """Move the tool centre point along a Cartesian dynamic movement primitive.

    `goal` replaces the goal pose of the primitive and keeps the shape of its motion.
    """

    state_name: ClassVar[str] = "motion.FollowCartDmp"
    skills: ClassVar[Skills] = (CartTrapVel, CartDMP)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    dmp: Annotated[CartDmpEntry, Meta(description="`{entry: name}` of kind `cart_dmp`")]
    goal: Annotated[PoseTarget | None, Meta(description="`{xyz, xyzw, frame}`, or `{entry: name}`")] = None
    goal_offset_m: Offset = NO_OFFSET
    time_scale: TimeScale = 1.0
    approach_speed: ApproachSpeed = None
    collisions: PathCollisions = CollisionOptions()

    def __post_init__(self) -> None:
        if self.goal is None and self.goal_offset_m != NO_OFFSET:
            raise ValueError("`goal_offset_m` requires `goal`")

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Move to the start if `approach_speed` is given, follow the primitive, and return the outcome."""
        dmp = await resolve_cart_dmp(ctx, self.dmp, time_scale=self.time_scale)
        target = None if self.goal is None else await resolve_pose(ctx, self.goal, self.goal_offset_m)
        if self.approach_speed is not None:
            approach = CartTrapVel(pose=dmp.start, speed=self.approach_speed, collisions=self.collisions)
            end = await ctx.perform(approach, to=self.robot)
            if end.status != "succeeded":
                what = f"{self.robot} did not reach the start of cart_dmp entry {self.dmp.entry}"
                cause = goal_cause(what, approach, end, to=self.robot, where=ctx.path, kind=self.state_name)
                return Outcome("failed", cause=cause)
        goal = CartDMP(dmp=dmp, goal=target, collisions=self.collisions)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not follow cart_dmp entry {self.dmp.entry} to its end"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)
