"""motion.FollowWaypoints: moves an arm through a list of waypoints without stopping at them."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.errors import StateError
from engine.skills import waypoints
from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.motion import PoseMatch, Speed
from engine.skills.waypoints import MOST_WAYPOINTS, BlendDistance, ToolSpeed, Waypoint, WaypointsResult
from engine.state import ActivationRecord, Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName
from states.motion.motion_undo import finished_motions, motion_undo_problem, perform_undo_motion
from states.motion.waypoint_target import WaypointTarget


class FollowWaypoints(State, frozen=True, kw_only=True):
    """Move an arm through `waypoints` as one motion, along straight lines in joint space with blended corners.

    At each waypoint the tool centre point passes within `blend_m`. The arm stops at waypoints with `blend_m` 0, where
    its path turns back, and at the last one. Poses become the configuration nearest to the previous waypoint.
    """

    state_name: ClassVar[str] = "motion.FollowWaypoints"
    skills: ClassVar[Skills] = (waypoints.FollowWaypoints,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    waypoints: Annotated[
        tuple[WaypointTarget, ...],
        Meta(
            min_length=1,
            max_length=MOST_WAYPOINTS,
            description="In order, each `{joints}` or `{pose}`, with a `blend_m` of its own where it differs",
        ),
    ]
    blend_m: BlendDistance = 0.02
    speed: Speed = 0.5
    speed_m_s: Annotated[ToolSpeed | None, Meta(description="Maximum speed of the tool centre point, if any")] = None
    match: PoseMatch = "pose"
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget, ...]:
        """Return the waypoints that are known before the run."""
        return tuple(
            target
            for index, waypoint in enumerate(self.waypoints)
            for target in waypoint.static_targets(
                self.robot, stored, parameter="waypoints", index=index, match=self.match
            )
        )

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        resolved = [await waypoint.resolve(ctx, blend_m=self.blend_m) for waypoint in self.waypoints]
        goal = self._goal(tuple(resolved))
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not follow its {len(resolved)} waypoints"
        if end.result is not None and end.result.waypoints:
            what += f" beyond the first {end.result.passed}"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Undo needs the recorded start configuration."""
        return motion_undo_problem(done, waypoints.FollowWaypoints)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Move back through the passed waypoints to the start of the motion."""
        for motion in finished_motions(done, waypoints.FollowWaypoints):
            if not isinstance(motion, WaypointsResult):
                raise StateError("the waypoints of its motion were not recorded", where=ctx.path)
            blends = [waypoint.blend_m if waypoint.blend_m is not None else self.blend_m for waypoint in self.waypoints]
            passed = zip(motion.waypoints[: motion.passed], blends, strict=False)
            back = [Waypoint(joints=joints, blend_m=blend) for joints, blend in passed]
            goal = self._goal((*reversed(back), Waypoint(joints=motion.start)))
            await perform_undo_motion(ctx, goal, robot=self.robot)

    def _goal(self, through: tuple[Waypoint, ...]) -> waypoints.FollowWaypoints:
        return waypoints.FollowWaypoints(
            waypoints=through,
            speed=self.speed,
            speed_m_s=self.speed_m_s,
            match=self.match,
            collisions=self.collisions,
        )
