"""Poses for the 3D view: quaternions in viser's order, rotations and rigid transforms as matrices."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.messages import FramePoses, Pose, Quaternion, Vector3

Matrix = NDArray[np.float64]
Wxyz = tuple[float, float, float, float]
# Less than this nobody sees, and an arm that holds itself by noisy encoders never rests.
_VISIBLE_M, _VISIBLE_RAD = 2e-4, 2e-4


@dataclass(frozen=True, kw_only=True)
class WorldPose:
    """A pose in the world: metres, and a unit quaternion x y z w."""

    xyz: Vector3
    xyzw: Quaternion

    @property
    def wxyz(self) -> Wxyz:
        """The quaternion in viser's order."""
        return wxyz(self.xyzw)


def wxyz(xyzw: Quaternion) -> Wxyz:
    """Return a quaternion in viser's order."""
    x, y, z, w = xyzw
    return (w, x, y, z)


def poses_by_frame(poses: FramePoses | None) -> Mapping[str, WorldPose]:
    """Return the pose of each frame."""
    if poses is None:
        return {}
    rows = zip(poses.names, poses.xyz, poses.xyzw, strict=True)
    return {name: WorldPose(xyz=xyz, xyzw=xyzw) for name, xyz, xyzw in rows}


def is_visible_change(before: WorldPose | None, now: WorldPose) -> bool:
    """Whether a pose differs visibly from the drawn one: never by the noise of an arm that rests."""
    if before is None or math.dist(before.xyz, now.xyz) > _VISIBLE_M:
        return True
    # For small angles the chord of two unit quaternions is half the angle; `q` and `-q` are one rotation.
    chord = min(math.dist(before.xyzw, now.xyzw), math.dist(before.xyzw, [-value for value in now.xyzw]))
    return 2.0 * chord > _VISIBLE_RAD


def rotation(xyzw: Quaternion) -> Matrix:
    """Return the 3 x 3 rotation of a unit quaternion."""
    x, y, z, w = xyzw
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def matrix_of_pose(pose: Pose | WorldPose) -> Matrix:
    """Return a pose as a 4 x 4 transform."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(pose.xyzw)
    matrix[:3, 3] = pose.xyz
    return matrix


def inverse(transform: Matrix) -> Matrix:
    """Return the inverse of a rigid 4 x 4 transform."""
    matrix = np.eye(4)
    matrix[:3, :3] = transform[:3, :3].T
    matrix[:3, 3] = -transform[:3, :3].T @ transform[:3, 3]
    return matrix


def pose_of_matrix(transform: Matrix) -> WorldPose:
    """Return a rigid 4 x 4 transform as a pose."""
    r = transform[:3, :3]
    # Of the four equal forms the one with the largest divisor is exact for every rotation.
    squares = np.array([1 + r[0, 0] - r[1, 1] - r[2, 2], 1 - r[0, 0] + r[1, 1] - r[2, 2],
                        1 - r[0, 0] - r[1, 1] + r[2, 2], 1 + r[0, 0] + r[1, 1] + r[2, 2]])  # fmt: skip
    forms = (
        (squares[0], r[1, 0] + r[0, 1], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]),
        (r[1, 0] + r[0, 1], squares[1], r[2, 1] + r[1, 2], r[0, 2] - r[2, 0]),
        (r[0, 2] + r[2, 0], r[2, 1] + r[1, 2], squares[2], r[1, 0] - r[0, 1]),
        (r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], squares[3]),
    )
    best = int(np.argmax(squares))
    q = np.array(forms[best]) / (2 * np.sqrt(squares[best]))
    x, y, z = transform[:3, 3]
    return WorldPose(xyz=(float(x), float(y), float(z)), xyzw=(float(q[0]), float(q[1]), float(q[2]), float(q[3])))
