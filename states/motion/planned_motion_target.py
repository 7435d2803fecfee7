"""Target of a collision-free motion: joints or a pose, given in the behavior or read when the state runs."""

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
Seed = Annotated[int, Meta(description="Seed of the search; the same seed gives the same path")]
WatchPath = Annotated[
    bool,
    Meta(description="Check the remaining path during the motion; without it, new obstacles are ignored"),
]


def require_one(joints: JointTarget | None, pose: PoseTarget | None) -> None:
    """Require exactly one target.

    Raises:
        ValueError: both or none are given.
    """
    if (joints is None) == (pose is None):
        raise ValueError("give either `joints` or `pose`")


def target_label(joints: JointTarget | None, pose: PoseTarget | None, offset_m: Offset) -> str:
    """Return the name of the target for a message."""
    return joints_label(joints) if joints is not None else pose_label(pose, offset_m)


async def resolve_target(
    ctx: Context, joints: JointTarget | None, pose: PoseTarget | None, offset_m: Offset, match: PoseMatch
) -> MotionTarget:
    """Return the current value of the target.

    Raises:
        EntryNotFound: the store has no such entry.
        StateError: an offset was given for a pose in another frame than the world.
    """
    if joints is not None:
        return MotionTarget(joints=await resolve_joints(ctx, joints))
    return MotionTarget(pose=await resolve_pose(ctx, pose or PoseTarget(), offset_m), match=match)


async def retracted_target(ctx: Context, robot: str, target: MotionTarget, back_m: float) -> MotionTarget:
    """Return the target retracted by `back_m`; a joint target keeps its arm configuration.

    Raises:
        SkillFailed: the arm does not reach the retracted pose.
    """
    if target.pose is not None:
        return MotionTarget(pose=retracted_pose(target.pose, back_m), match=target.match)
    retracted = retracted_pose(await ctx.call(ForwardKinematics(joints=target.joints), to=robot), back_m)
    solution = await ctx.call(InverseKinematics(pose=retracted, seed=target.joints), to=robot)
    return MotionTarget(joints=solution.joints)
