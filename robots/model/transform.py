"""A rigid transform: position and unit quaternion x y z w, with composition, inverse and comparison."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.messages import Pose
from robots.port import Array

_SMALL = 1e-12


@dataclass(frozen=True, kw_only=True)
class RigidTransform:
    """A rotation and a translation: `xyz` of shape (3,) in metres, `xyzw` of shape (4,) of length 1."""

    xyz: Array
    xyzw: Array

    @classmethod
    def of(cls, xyz: Sequence[float] | Array, xyzw: Sequence[float] | Array) -> RigidTransform:
        """Return the transform; the quaternion is normalised.

        Raises:
            ValueError: a value is not finite or the quaternion is zero.
        """
        position, quaternion = np.array(xyz, dtype=np.float64), np.array(xyzw, dtype=np.float64)
        length = math.hypot(*quaternion.tolist())
        if not (np.isfinite(position).all() and math.isfinite(length)) or length < 1e-6:
            raise ValueError(f"xyz {tuple(xyz)}, xyzw {tuple(xyzw)} is not a pose")
        return cls(xyz=position, xyzw=quaternion / length)

    @classmethod
    def from_pose(cls, pose: Pose) -> RigidTransform:
        """Return the transform of a pose, ignoring its frame; raises ValueError as `of` does."""
        return cls.of(pose.xyz, pose.xyzw)

    def to_pose(self, frame: str) -> Pose:
        """Return the transform as a pose message in `frame`."""
        x, y, z = self.xyz.tolist()
        qx, qy, qz, qw = self.xyzw.tolist()
        return Pose(xyz=(x, y, z), xyzw=(qx, qy, qz, qw), frame=frame)

    @property
    def rotation(self) -> Array:
        """The rotation matrix, shape (3, 3)."""
        x, y, z, w = self.xyzw.tolist()
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )

    def then(self, inner: RigidTransform) -> RigidTransform:
        """Return `self * inner`: `inner` expressed in the parent of this frame."""
        return RigidTransform(xyz=self.xyz + self.rotation @ inner.xyz, xyzw=product(self.xyzw, inner.xyzw))

    def inverse(self) -> RigidTransform:
        """Return the inverse transform."""
        return RigidTransform(xyz=-(self.rotation.T @ self.xyz), xyzw=conjugate(self.xyzw))

    def distance_m(self, other: RigidTransform) -> float:
        """Distance of the two origins."""
        return float(np.linalg.norm(other.xyz - self.xyz))

    def angle_rad(self, other: RigidTransform) -> float:
        """Smallest angle between the two orientations, 0 to pi."""
        return float(np.linalg.norm(rotation_vector(product(conjugate(self.xyzw), other.xyzw))))


def product(left: Array, right: Array) -> Array:
    """Return the quaternion of the rotation by `right` first, then by `left`."""
    lx, ly, lz, lw = left.tolist()
    rx, ry, rz, rw = right.tolist()
    return np.array(
        [
            lw * rx + lx * rw + ly * rz - lz * ry,
            lw * ry - lx * rz + ly * rw + lz * rx,
            lw * rz + lx * ry - ly * rx + lz * rw,
            lw * rw - lx * rx - ly * ry - lz * rz,
        ]
    )


def cross(left: Array, right: Array) -> Array:
    """Return the cross product of two vectors of shape (3,), faster than numpy's."""
    ax, ay, az = left.tolist()
    bx, by, bz = right.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def conjugate(xyzw: Array) -> Array:
    """Return the quaternion of the inverse rotation."""
    return xyzw * np.array([-1.0, -1.0, -1.0, 1.0])


def rotation_vector(xyzw: Array) -> Array:
    """Return axis times angle, at most pi long, of a unit quaternion."""
    shortest = xyzw if xyzw[3] >= 0.0 else -xyzw
    sine = float(np.linalg.norm(shortest[:3]))
    if sine < _SMALL:
        return 2.0 * shortest[:3]
    return shortest[:3] / sine * (2.0 * np.arctan2(sine, float(shortest[3])))


def quaternion_of(vector: Array) -> Array:
    """Return the unit quaternion of a rotation vector (axis times angle)."""
    angle = float(np.linalg.norm(vector))
    if angle < _SMALL:
        raw = np.append(vector / 2.0, 1.0)
        return raw / np.linalg.norm(raw)
    return np.append(vector / angle * np.sin(angle / 2.0), np.cos(angle / 2.0))
