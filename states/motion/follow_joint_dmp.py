"""motion.FollowJointDmp: moves an arm along a joint-space movement primitive."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.dmp import JointDMP
from engine.skills.motion import JointTrapVel
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import JointTarget, RobotName, resolve_joints
from states.motion.primitive import ApproachSpeed, JointDmpEntry, TimeScale, resolve_joint_dmp


class FollowJointDmp(State, frozen=True, kw_only=True):
    """Move an arm along a joint-space dynamic movement primitive, such as one learned from a demonstration.

    `goal` replaces the goal joints of the primitive and keeps the shape of its motion.
    """

    state_name: ClassVar[str] = "motion.FollowJointDmp"
    skills: ClassVar[Skills] = (JointTrapVel, JointDMP)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    dmp: Annotated[JointDmpEntry, Meta(description="`{entry: name}` of kind `dmp`")]
    goal: Annotated[JointTarget | None, Meta(description="Joint angles in radians, or `{entry: name}`")] = None
    time_scale: TimeScale = 1.0
    approach_speed: ApproachSpeed = None
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Move to the start if `approach_speed` is given, follow the primitive, and return the outcome."""
        dmp = await resolve_joint_dmp(ctx, self.dmp, time_scale=self.time_scale)
        target = () if self.goal is None else await resolve_joints(ctx, self.goal)
        if self.approach_speed is not None:
            approach = JointTrapVel(joints=dmp.start, speed=self.approach_speed, collisions=self.collisions)
            end = await ctx.perform(approach, to=self.robot)
            if end.status != "succeeded":
                what = f"{self.robot} did not reach the start of dmp entry {self.dmp.entry}"
                cause = goal_cause(what, approach, end, to=self.robot, where=ctx.path, kind=self.state_name)
                return Outcome("failed", cause=cause)
        goal = JointDMP(dmp=dmp, goal=target, collisions=self.collisions)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not follow dmp entry {self.dmp.entry} to its end"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)
