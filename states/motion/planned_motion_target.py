"""Where a collision-free motion goes: joints or a pose, given in the behavior or read when the state runs."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.skills.motion import ForwardKinematics, InverseKinematics, PoseMatch
from engine.skills.planning import MotionTarget
from engine.state import Context
from states.motion.motion_target import (
    JointTarget,
    Offset,
    PoseTarget,
    joints_label,
    pose_label,
    resolve_joints,
    resolve_pose,
    retracted_pose,
)

GoalJoints = Annotated[JointTarget | None, Meta(description="Joint angles in radians, or `{entry: name}`")]
GoalPose = Annotated[
    PoseTarget | None, Meta(description="Pose of the tool centre point: `{xyz, xyzw, frame}`, or `{entry: name}`")
]
Seed = Annotated[int, Meta(description="Seed of the search: the same one finds the same way")]
WatchPath = Annotated[
    bool,
    Meta(
        description="Re-check the remaining path against the planning scene in motion; without it obstacles are ignored"
    ),
]


def require_one(joints: JointTarget | None, pose: PoseTarget | None) -> None:
    """Refuse parameters that name no target, or two.

    Raises:
        ValueError: both or none are given.
    """
    if (joints is None) == (pose is None):
        raise ValueError("give either `joints` or `pose`")


def target_label(joints: JointTarget | None, pose: PoseTarget | None, offset_m: Offset) -> str:
    """Name the target in a message."""
    return joints_label(joints) if joints is not None else pose_label(pose, offset_m)


async def resolve_target(
    ctx: Context, joints: JointTarget | None, pose: PoseTarget | None, offset_m: Offset, match: PoseMatch
) -> MotionTarget:
    """Return the target as it is at this moment.

    Raises:
        EntryNotFound: the store has no such entry.
        StateError: an offset was given for a pose in another frame than the world.
    """
    if joints is not None:
        return MotionTarget(joints=await resolve_joints(ctx, joints))
    return MotionTarget(pose=await resolve_pose(ctx, pose or PoseTarget(), offset_m), match=match)


async def retracted_target(ctx: Context, robot: str, target: MotionTarget, back_m: float) -> MotionTarget:
    """Return where the tool is `back_m` before a target; of joints, with the arm standing as it does there.

    Raises:
        SkillFailed: the arm does not reach there.
    """
    if target.pose is not None:
        return MotionTarget(pose=retracted_pose(target.pose, back_m), match=target.match)
    there = retracted_pose(await ctx.call(ForwardKinematics(joints=target.joints), to=robot), back_m)
    found = await ctx.call(InverseKinematics(pose=there, seed=target.joints), to=robot)
    return MotionTarget(joints=found.joints)
