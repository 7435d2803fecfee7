"""The differential side of inverse kinematics in numpy: what a pose misses, and the joint step that mends it."""

from __future__ import annotations

import numpy as np

from robots.model.transform import RigidTransform, conjugate, product, rotation_vector
from robots.port import Array


def pose_error(actual: RigidTransform, target: RigidTransform) -> Array:
    """Return what is missing: metres, then the rotation vector in world axes, shape (6,)."""
    turn = rotation_vector(product(target.xyzw, conjugate(actual.xyzw)))
    return np.concatenate((target.xyz - actual.xyz, turn))


def weighted_step(jacobian: Array, error: Array, *, damping: float, pull: Array | None = None) -> Array:
    """Return the joint step that removes `error`, damped; `pull` acts where it does not disturb the tool."""
    square = jacobian @ jacobian.T
    square[np.diag_indices_from(square)] += damping + 1e-12
    if pull is None:
        return jacobian.T @ np.linalg.solve(square, error)
    return pull + jacobian.T @ np.linalg.solve(square, error - jacobian @ pull)
