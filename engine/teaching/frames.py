"""Where one frame of the cell is, seen from another."""

from __future__ import annotations

from engine.errors import SkillFailed
from engine.messages import FramePoses, Pose, Quaternion, Vector3
from engine.nearness import near_names

WORLD = "world"


def relative_pose(poses: FramePoses, source: str, target: str) -> Pose:
    """Return the pose of the frame `source` in the frame `target`.

    Raises:
        SkillFailed: there is no such frame.
    """
    xyz, xyzw = _of(poses, source)
    if target == WORLD:
        return Pose(xyz=xyz, xyzw=xyzw)
    origin, turn = _of(poses, target)
    back = (-turn[0], -turn[1], -turn[2], turn[3])
    away = (xyz[0] - origin[0], xyz[1] - origin[1], xyz[2] - origin[2])
    return Pose(xyz=_turned(back, away), xyzw=_product(back, xyzw), frame=target)


def _of(poses: FramePoses, name: str) -> tuple[Vector3, Quaternion]:
    if name == WORLD:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    if name not in poses.names:
        raise SkillFailed(f"there is no frame {name}", where="cell/frames", hint=near_names(name, poses.names))
    row = poses.names.index(name)
    return poses.xyz[row], poses.xyzw[row]


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def _turned(q: Quaternion, v: Vector3) -> Vector3:
    x, y, z, _ = _product(_product(q, (*v, 0.0)), (-q[0], -q[1], -q[2], q[3]))
    return x, y, z
