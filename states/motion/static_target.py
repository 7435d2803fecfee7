"""Targets of motions that are known before a run, from the behavior and the seed of the store."""

from __future__ import annotations

from engine.messages import Pose, Vector3
from engine.skills.arm_target import ArmTarget, StoredTargets
from engine.skills.motion import PoseMatch
from states.motion.motion_target import NO_OFFSET, EntryTarget, JointTarget, PoseTarget, offset_pose, retracted_pose


def static_joint_target(
    robot: str, target: JointTarget | None, stored: StoredTargets, *, parameter: str, index: int | None = None
) -> tuple[ArmTarget, ...]:
    """Return the joint target of a state; nothing if there is none or it is not known before the run."""
    joints = stored.joints(target.entry) if isinstance(target, EntryTarget) else target
    return (ArmTarget(robot=robot, parameter=parameter, index=index, joints=joints),) if joints else ()


def static_pose_target(
    robot: str,
    target: PoseTarget | None,
    stored: StoredTargets,
    *,
    parameter: str,
    index: int | None = None,
    offset_m: Vector3 = NO_OFFSET,
    back_m: float = 0.0,
    match: PoseMatch = "pose",
) -> tuple[ArmTarget, ...]:
    """Return the pose target of a state; nothing if there is none or it is not known before the run."""
    pose = _pose(target, stored)
    if pose is None or (offset_m != NO_OFFSET and pose.frame != "world"):
        return ()
    retracted = retracted_pose(offset_pose(pose, offset_m, where=parameter), back_m)
    return (ArmTarget(robot=robot, parameter=parameter, index=index, pose=retracted, match=match),)


def _pose(target: PoseTarget | None, stored: StoredTargets) -> Pose | None:
    if target is None:
        return None
    if target.entry:
        return stored.pose(target.entry)
    return Pose(xyz=target.xyz or NO_OFFSET, xyzw=target.xyzw, frame=target.frame)
