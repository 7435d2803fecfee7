"""The ideal arm close to a real one: almost intersecting or almost parallel axes made exactly so.

Closed-form inverse kinematics exists for arms whose axes intersect or are parallel. Rounded numbers in a
description, and every factory calibration, break that by micrometres or millimetres; the solutions
of the ideal arm are then refined on the true one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.model.inverse_kinematics.chain import KinematicChain
from robots.port import Array

NEARLY_PARALLEL_RAD = 0.02
NEARLY_MEETING_M = 0.006


@dataclass(frozen=True, kw_only=True)
class IdealArm:
    """The joint lines with all joints at 0: `axes` and `points` (n, 3) in the world; `moved` from the true ones.

    `moved` is the maximum displacement of a line in metres, or its rotation in radians.
    """

    axes: Array
    points: Array
    moved: float


def ideal_arm(chain: KinematicChain) -> IdealArm:
    """Return the ideal arm close to a chain."""
    axes = _parallel(chain.axes)
    points = chain.points.copy()
    for i in range(1, chain.dof):
        points[i] += _shift_to_meet(axes, points, i)
    moved = max(float(np.abs(axes - chain.axes).max()), float(np.abs(points - chain.points).max()))
    return IdealArm(axes=axes, points=points, moved=moved)


def _parallel(axes: Array) -> Array:
    """Return directions with successive almost parallel ones made exactly parallel."""
    ideal = axes.copy()
    first = 0
    for i in range(1, len(axes) + 1):
        if i < len(axes) and np.linalg.norm(np.cross(axes[i - 1], axes[i])) < NEARLY_PARALLEL_RAD:
            continue
        group = axes[first:i]
        signs = np.sign(group @ group[0])
        mean = signs @ group
        ideal[first:i] = np.outer(signs, mean / np.linalg.norm(mean))
        first = i
    return ideal


def _shift_to_meet(axes: Array, points: Array, i: int) -> Array:
    """Return the displacement of line i that makes it intersect the previous line, and if possible the two previous."""
    nearest = meeting_point(axes, points, i - 1, i)
    if nearest is None:
        return np.zeros(3)
    if i > 1:
        before = meeting_point(axes, points, i - 2, i - 1)
        if before is not None and _gap(axes, points, i - 2, i - 1) < 1e-9:
            away = before - points[i]
            away = away - axes[i] * (axes[i] @ away)
            if np.linalg.norm(away) < NEARLY_MEETING_M:
                return away
    gap = _gap_vector(axes, points, i - 1, i)
    return -gap if np.linalg.norm(gap) < NEARLY_MEETING_M else np.zeros(3)


def meeting_point(axes: Array, points: Array, i: int, j: int) -> Array | None:
    """Return the point of line i nearest to line j; None if the lines are parallel."""
    normal = np.cross(axes[i], axes[j])
    square = float(normal @ normal)
    if square < NEARLY_PARALLEL_RAD**2:
        return None
    along = float(np.cross(points[j] - points[i], axes[j]) @ normal) / square
    return points[i] + along * axes[i]


def _gap_vector(axes: Array, points: Array, i: int, j: int) -> Array:
    """Return the shortest vector from line i to line j, which are not parallel."""
    normal = np.cross(axes[i], axes[j])
    normal = normal / np.linalg.norm(normal)
    return normal * float(normal @ (points[j] - points[i]))


def _gap(axes: Array, points: Array, i: int, j: int) -> float:
    return float(np.linalg.norm(_gap_vector(axes, points, i, j)))
