"""motion.MovePose: moves the tool of an arm to a pose by joint interpolation."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.motion import CartTrapVel, PoseMatch, Speed
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import NO_OFFSET, Offset, PoseTarget, RobotName, pose_label, resolve_pose
from states.motion.motion_undo import motion_undo_problem, move_joints_back
from states.motion.static_target import static_pose_target


class MovePose(State, frozen=True, kw_only=True):
    """Move the tool centre point to a pose; the path is straight in joint space, not in Cartesian space.

    Arms with fewer than six joints reach few full poses: `match: position` or `axis` leaves the remaining degrees of
    freedom unconstrained.
    """

    state_name: ClassVar[str] = "motion.MovePose"
    skills: ClassVar[Skills] = (CartTrapVel,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    target: Annotated[PoseTarget, Meta(description="`{xyz, xyzw, frame}`, or `{entry: name}`")]
    offset_m: Offset = NO_OFFSET
    speed: Speed = 0.5
    match: PoseMatch = "pose"
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget, ...]:
        """Return the pose."""
        return static_pose_target(
            self.robot, self.target, stored, parameter="target", offset_m=self.offset_m, match=self.match
        )

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        pose = await resolve_pose(ctx, self.target, self.offset_m)
        goal = CartTrapVel(pose=pose, speed=self.speed, match=self.match, collisions=self.collisions)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not reach {pose_label(self.target, self.offset_m)}"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start configuration."""
        return motion_undo_problem(done, CartTrapVel)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move back to the start configuration at the same speed."""
        await move_joints_back(ctx, done, CartTrapVel, robot=self.robot, speed=self.speed, collisions=self.collisions)
