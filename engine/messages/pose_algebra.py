"""Composition, inversion and translation of poses with plain floats; unit quaternions x y z w."""

from __future__ import annotations

import math

from engine.messages.geometry import Pose, Quaternion, Vector3

_ZERO_ROTATION = 1e-9


def compose_poses(outer: Pose, inner: Pose) -> Pose:
    """Return the pose `inner`, given in the frame that `outer` describes, in the frame of `outer`."""
    x, y, z = (a + b for a, b in zip(outer.xyz, rotate_vector(outer.xyzw, inner.xyz), strict=True))
    return Pose(xyz=(x, y, z), xyzw=compose_rotations(outer.xyzw, inner.xyzw), frame=outer.frame)


def rotate_vector(by: Quaternion, vector: Vector3) -> Vector3:
    """Rotate a vector by a unit quaternion."""
    x, y, z, w = by
    a, b, c = vector
    # v + 2 w (q x v) + 2 q x (q x v)
    p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
    return (
        a + 2 * (w * p + y * r - z * q),
        b + 2 * (w * q + z * p - x * r),
        c + 2 * (w * r + x * q - y * p),
    )


def angle_between_rad(one: Quaternion, other: Quaternion) -> float:
    """Return the angle between two orientations in radians."""
    return 2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(one, other, strict=True)))))


def rotation_vector_between(one: Quaternion, other: Quaternion) -> Vector3:
    """Return the rotation vector (radians) from one orientation to the other with the smaller angle."""
    x, y, z, w = one
    a, b, c, real = compose_rotations(other, (-x, -y, -z, w))
    length = math.hypot(a, b, c)
    if length < _ZERO_ROTATION:
        return (0.0, 0.0, 0.0)
    share = math.copysign(2.0 * math.atan2(length, abs(real)), real) / length
    return (a * share, b * share, c * share)


def invert_pose(pose: Pose) -> Pose:
    """Return the pose of the outer frame in the frame of `pose`."""
    x, y, z, w = pose.xyzw
    inverse = (-x, -y, -z, w)
    a, b, c = rotate_vector(inverse, pose.xyz)
    return Pose(xyz=(-a, -b, -c), xyzw=inverse, frame=pose.frame)


def interpolate_poses(start: Pose, end: Pose, share: float) -> Pose:
    """Return the pose at a share of the straight line between two poses of one frame, with SLERP."""
    x, y, z = (a + share * (b - a) for a, b in zip(start.xyz, end.xyz, strict=True))
    turn = rotation_vector_between(start.xyzw, end.xyzw)
    angle = math.hypot(*turn)
    sine = math.sin(share * angle / 2.0) / angle if angle > _ZERO_ROTATION else 0.0
    part = (turn[0] * sine, turn[1] * sine, turn[2] * sine, math.cos(share * angle / 2.0))
    return Pose(xyz=(x, y, z), xyzw=compose_rotations(part, start.xyzw), frame=start.frame)


def offset_along(direction: Vector3, distance_m: float) -> Vector3:
    """Return the offset of length `distance_m` along a direction of any non-zero length."""
    length = math.hypot(*direction)
    x, y, z = (value * distance_m / length for value in direction)
    return (x, y, z)


def translate_pose(pose: Pose, offset_m: Vector3) -> Pose:
    """Return a translated pose with the same orientation; `offset_m` is in the frame of the pose."""
    x, y, z = (value + shift for value, shift in zip(pose.xyz, offset_m, strict=True))
    return Pose(xyz=(x, y, z), xyzw=pose.xyzw, frame=pose.frame)


def compose_rotations(outer: Quaternion, inner: Quaternion) -> Quaternion:
    """Return the orientation `inner`, given in the frame that `outer` describes, in the frame of `outer`."""
    a, b, c, d = outer
    x, y, z, w = inner
    return (
        d * x + a * w + b * z - c * y,
        d * y - a * z + b * w + c * x,
        d * z + a * y - b * x + c * w,
        d * w - a * x - b * y - c * z,
    )
