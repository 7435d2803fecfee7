"""Pose of one frame of the cell relative to another."""

from __future__ import annotations

import msgspec

from engine.errors import SkillFailed
from engine.messages import FramePoses, Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.wording.suggestions import did_you_mean

WORLD = "world"


def relative_pose(poses: FramePoses, source: str, target: str) -> Pose:
    """Return the pose of the frame `source` in the frame `target`.

    Raises:
        SkillFailed: there is no such frame.
    """
    pose = _of(poses, source)
    if target == WORLD:
        return pose
    return msgspec.structs.replace(compose_poses(invert_pose(_of(poses, target)), pose), frame=target)


def _of(poses: FramePoses, name: str) -> Pose:
    if name == WORLD:
        return Pose(xyz=(0.0, 0.0, 0.0))
    if name not in poses.names:
        raise SkillFailed(f"there is no frame {name}", where="cell/frames", hint=did_you_mean(name, poses.names))
    row = poses.names.index(name)
    return Pose(xyz=poses.xyz[row], xyzw=poses.xyzw[row])
