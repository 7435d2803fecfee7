"""Validates a given obstacle: its name, its solids, their sizes and poses."""

from __future__ import annotations

import numpy as np

from engine.messages import Pose
from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Obstacle, Shape, Sphere
from robots.model.transform import RigidTransform
from robots.port import Array

_LARGEST_M = 100.0
_FARTHEST_M = 1000.0
_MOST_SOLIDS, _MOST_POINTS = 200, 1000
# Points whose spread in their thinnest direction is less than this lie in one plane.
_FLAT_M = 1e-4


def find_obstacle_fault(obstacle: Obstacle) -> str:
    """Return what is invalid about an obstacle, empty if it is valid."""
    if not obstacle.name or "/" in obstacle.name:
        return f"{obstacle.name!r} is not a valid obstacle name"
    if not 1 <= len(obstacle.solids) <= _MOST_SOLIDS:
        return f"{obstacle.name} has {len(obstacle.solids)} solids, allowed are 1 to {_MOST_SOLIDS}"
    if obstacle.pose.frame != "world":
        return f"{obstacle.name} has a pose in the frame {obstacle.pose.frame!r}, expected 'world'"
    poses = (obstacle.pose, *(solid.pose for solid in obstacle.solids))
    for fault in (*map(_pose_fault, poses), *(_size_fault(solid.shape) for solid in obstacle.solids)):
        if fault:
            return f"{obstacle.name} {fault}"
    return ""


def _pose_fault(pose: Pose) -> str:
    try:
        RigidTransform.from_pose(pose)
    except ValueError as error:
        return f"has an invalid pose: {error}"
    return "" if max(map(abs, pose.xyz)) <= _FARTHEST_M else f"is too far away: {pose.xyz}"


def _size_fault(shape: Shape) -> str:
    match shape:
        case Hull(points_m=points):
            return _hull_fault(np.array(points, dtype=np.float64).reshape(-1, 3))
        case Box(size_m=size):
            lengths = size
        case Sphere(radius_m=radius):
            lengths = (radius,)
        case Cylinder(radius_m=radius, length_m=length):
            lengths = (radius, length)
        case Capsule(radius_m=radius, length_m=length):
            lengths = (radius, length or 1e-9) if length >= 0.0 else (radius, length)
    if all(0.0 < one <= _LARGEST_M for one in lengths):
        return ""
    sizes = ", ".join(f"{one:g}" for one in lengths)
    return f"has an invalid size of {sizes} m, allowed are more than 0 to {_LARGEST_M:g} m"


def _hull_fault(points: Array) -> str:
    if not 4 <= len(points) <= _MOST_POINTS:
        return f"is a hull of {len(points)} points, allowed are 4 to {_MOST_POINTS}"
    if not np.isfinite(points).all() or np.abs(points).max() > _LARGEST_M:
        return "is a hull with points that are too far away or not finite"
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return "" if spread[-1] > _FLAT_M else "is a hull whose points lie in one plane"
