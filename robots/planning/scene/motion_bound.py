"""Bounds the motion of any point of an arm per joint motion; the step size of all path checks depends on it."""

from __future__ import annotations

from typing import Any

import numpy as np

from robots.port import Array


def motion_bound(solver: Any, geometry: Any) -> Array:
    """Return for each joint the largest motion of any point in meters per radian (or meter), shape (n,).

    The bound is the radius of a sphere about the joint's origin that contains everything after it for all joints:
    the shapes that move with the joint, and the next joint's sphere. `solver` and `geometry` are Pinocchio's
    models of a chain.
    """
    count = solver.njoints - 1
    balls = np.zeros(count + 2)
    for shape in geometry.geometryObjects:
        solid = shape.geometry
        solid.computeLocalAABB()
        at = shape.placement.act(np.array(solid.aabb_center))
        joint = shape.parentJoint
        balls[joint] = max(balls[joint], float(np.linalg.norm(at)) + float(solid.aabb_radius))
    bound = np.zeros(count)
    behind = 0.0
    for joint in range(count, 0, -1):
        ball = max(float(balls[joint]), behind)
        sliding = "P" in solver.joints[joint].shortname().removeprefix("JointModel")[:1]
        bound[joint - 1] = 1.0 if sliding else ball
        travel = float(np.abs([solver.lowerPositionLimit[joint - 1], solver.upperPositionLimit[joint - 1]]).max())
        behind = float(np.linalg.norm(solver.jointPlacements[joint].translation)) + ball + (travel if sliding else 0.0)
    return bound
