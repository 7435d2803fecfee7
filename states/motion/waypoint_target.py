"""A waypoint of a motion: given in the behavior, or read from the store when the state runs."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.motion import PoseMatch
from engine.skills.waypoints import BlendDistance, Waypoint
from engine.state import Context
from states.motion.motion_target import NO_OFFSET, JointTarget, PoseTarget, resolve_joints, resolve_pose
from states.motion.static_target import static_joint_target, static_pose_target


class WaypointTarget(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Either `joints` or `pose`, passed within `blend_m`: that of the state by default, 0 for a stop."""

    joints: Annotated[JointTarget | None, Meta(description="Joint angles in radians, or `{entry: name}`")] = None
    pose: Annotated[PoseTarget | None, Meta(description="`{xyz, xyzw, frame}`, or `{entry: name}`")] = None
    blend_m: BlendDistance | None = None

    def __post_init__(self) -> None:
        if (self.joints is None) == (self.pose is None):
            raise ValueError("give either `joints` or `pose`")

    def static_targets(
        self, robot: str, stored: StoredTargets, *, parameter: str, index: int, match: PoseMatch
    ) -> tuple[ArmTarget, ...]:
        """Return the target of the arm, if it is known before the run."""
        if self.joints is not None:
            return static_joint_target(robot, self.joints, stored, parameter=parameter, index=index)
        return static_pose_target(robot, self.pose, stored, parameter=parameter, index=index, match=match)

    async def resolve(self, ctx: Context, *, blend_m: float) -> Waypoint:
        """Return the waypoint of the goal, with `blend_m` where it has none of its own.

        Raises:
            EntryNotFound: the store has no such entry.
        """
        blend = blend_m if self.blend_m is None else self.blend_m
        if self.joints is not None:
            return Waypoint(joints=await resolve_joints(ctx, self.joints), blend_m=blend)
        assert self.pose is not None
        return Waypoint(pose=await resolve_pose(ctx, self.pose, NO_OFFSET), blend_m=blend)
