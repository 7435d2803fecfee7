"""The tool centre point from poses of the tool link in which the tip touches one fixed point, by least squares.

With the orientations R and positions p of the tool link, the tip t in the link and the point c obey R t + p = c in each
pose. Without their means, c drops out: (R - mean R) t = mean p - p. The normal matrix is n (I - mean Rᵀ mean R); its
weakest axis is the axis of the tool link that the poses tilt least, and along it the tip is least certain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

from engine.errors import Cause, MeasuredValue
from engine.messages import Pose, Quaternion, Vector3
from engine.messages.pose_algebra import rotate_vector
from states.calibration.vectors import add, dot, mean, scale, subtract

LEAST_POSES = 4
"""Three poses determine the tip; the fourth makes the residual show mistakes."""
_AXES: tuple[Vector3, Vector3, Vector3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_SWEEPS = 12
"""Jacobi rotations of a 3 x 3 matrix converge in five or six sweeps."""
_LEAST_NORM = 1e-6

Matrix = list[list[float]]


class ToolPointEstimate(NamedTuple):
    """The tip in the tool link, the fixed point, the distance of each tip from it, and the tilt of the weakest axis."""

    tool_xyz_m: Vector3
    point_m: Vector3
    residuals_m: tuple[float, ...]
    tilt_rad: float


def estimate_tool_point(poses: Sequence[Pose], *, least_tilt_rad: float, where: str) -> ToolPointEstimate | Cause:
    """Return the tip that touches one point in all poses of the tool link, or why the poses do not determine it.

    Args:
        poses: Poses of the tool link, in one frame.
        least_tilt_rad: Smallest tilt of the weakest axis between two of the poses, greater than 0.
        where: The place that a cause names.
    """
    unusable = _unusable(poses, where)
    if unusable is not None:
        return unusable
    rotations = [_unit(pose.xyzw) for pose in poses]
    count = len(poses)
    mean_position = mean([pose.xyz for pose in poses])
    # Column k of the mean rotation: the mean of the axes k of the tool link.
    columns = [mean([rotate_vector(rotation, axis) for rotation in rotations]) for axis in _AXES]
    normal = [[count * (float(i == j) - dot(columns[i], columns[j])) for j in range(3)] for i in range(3)]
    strengths, axes = _eigenvectors(normal)
    weakest = axes[strengths.index(min(strengths))]
    tilt_rad = max(
        _angle_rad(rotate_vector(one, weakest), rotate_vector(other, weakest))
        for one, other in combinations(rotations, 2)
    )
    if tilt_rad < least_tilt_rad:
        return _too_alike(weakest, tilt_rad, least_tilt_rad, where)
    offsets = [
        rotate_vector(_inverse(rotation), subtract(mean_position, pose.xyz))
        for rotation, pose in zip(rotations, poses, strict=True)
    ]
    right = scale(mean(offsets), count)
    first, second, third = (
        scale(axis, dot(axis, right) / strength) for axis, strength in zip(axes, strengths, strict=True)
    )
    tip = add(add(first, second), third)
    tips = [add(pose.xyz, rotate_vector(rotation, tip)) for rotation, pose in zip(rotations, poses, strict=True)]
    point = mean(tips)
    return ToolPointEstimate(tip, point, tuple(math.dist(each, point) for each in tips), tilt_rad)


def _unusable(poses: Sequence[Pose], where: str) -> Cause | None:
    if len(poses) < LEAST_POSES:
        compared = MeasuredValue(quantity="poses", measured=len(poses), unit="", least=LEAST_POSES)
        message = f"{len(poses)} poses are given, at least {LEAST_POSES} needed"
        return Cause(message=message, where=where, compared=(compared,))
    frames = sorted({pose.frame for pose in poses})
    if len(frames) > 1:
        return Cause(message=f"the poses are in different frames: {', '.join(frames)}", where=where)
    for number, pose in enumerate(poses, 1):
        if not math.hypot(*pose.xyzw) > _LEAST_NORM or not all(map(math.isfinite, (*pose.xyz, *pose.xyzw))):
            return Cause(message=f"pose {number} has no position or no orientation", where=where)
    return None


def _too_alike(axis: Vector3, tilt_rad: float, least_rad: float, where: str) -> Cause:
    tilt, least = math.degrees(tilt_rad), math.degrees(least_rad)
    direction = ", ".join(f"{value + 0.0:.2f}" for value in axis)
    return Cause(
        message=f"the orientations are too alike: the axis ({direction}) of the tool link is tilted by {tilt:.1f} deg"
        f" at most between two poses, at least {least:.1f} deg needed",
        where=where,
        compared=(MeasuredValue(quantity="tilt of the tool link", measured=tilt, unit="deg", least=least),),
    )


def _eigenvectors(symmetric: Matrix) -> tuple[list[float], list[Vector3]]:
    """Return the eigenvalues and the unit eigenvectors of a symmetric 3 x 3 matrix, by Jacobi rotations."""
    matrix = [list(row) for row in symmetric]
    vectors = [list(axis) for axis in _AXES]
    for _ in range(_SWEEPS):
        for p, q in ((0, 1), (0, 2), (1, 2)):
            # The angle that makes the element (p, q) zero; atan2 also knows equal diagonal elements.
            angle = 0.5 * math.atan2(2.0 * matrix[p][q], matrix[p][p] - matrix[q][q])
            cosine, sine = math.cos(angle), math.sin(angle)
            for row in matrix:
                row[p], row[q] = cosine * row[p] + sine * row[q], cosine * row[q] - sine * row[p]
            for rows in (matrix, vectors):
                upper, lower = rows[p], rows[q]
                rows[p] = [cosine * a + sine * b for a, b in zip(upper, lower, strict=True)]
                rows[q] = [cosine * b - sine * a for a, b in zip(upper, lower, strict=True)]
    return [matrix[k][k] for k in range(3)], [(x, y, z) for x, y, z in vectors]


def _angle_rad(one: Vector3, other: Vector3) -> float:
    """Return the angle between two unit vectors, exact also near 0 and pi."""
    return 2.0 * math.atan2(math.hypot(*subtract(one, other)), math.hypot(*add(one, other)))


def _unit(xyzw: Quaternion) -> Quaternion:
    length = math.hypot(*xyzw)
    x, y, z, w = (value / length for value in xyzw)
    return (x, y, z, w)


def _inverse(xyzw: Quaternion) -> Quaternion:
    x, y, z, w = xyzw
    return (-x, -y, -z, w)
