"""motion.MoveJoints: moves an arm to a joint configuration."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.motion import JointTrapVel, Speed
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import JointTarget, RobotName, joints_label, resolve_joints
from states.motion.motion_undo import motion_undo_problem, move_joints_back
from states.motion.static_target import static_joint_target


class MoveJoints(State, frozen=True, kw_only=True):
    """Move an arm in joint space, all joints synchronized, with a trapezoidal velocity profile."""

    state_name: ClassVar[str] = "motion.MoveJoints"
    skills: ClassVar[Skills] = (JointTrapVel,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    target: Annotated[JointTarget, Meta(description="Joint angles in radians, or `{entry: name}`")]
    speed: Speed = 0.5
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget, ...]:
        """Return the joints."""
        return static_joint_target(self.robot, self.target, stored, parameter="target")

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        goal = JointTrapVel(joints=await resolve_joints(ctx, self.target), speed=self.speed, collisions=self.collisions)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not reach {joints_label(self.target)}"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start configuration."""
        return motion_undo_problem(done, JointTrapVel)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move back to the start configuration at the same speed."""
        await move_joints_back(ctx, done, JointTrapVel, robot=self.robot, speed=self.speed, collisions=self.collisions)
