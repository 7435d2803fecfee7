"""Differential inverse kinematics in numpy: the pose error, and the joint step that reduces it."""

from __future__ import annotations

import numpy as np

from robots.model.transform import RigidTransform, conjugate, product, rotation_vector
from robots.port import Array


def pose_error(actual: RigidTransform, target: RigidTransform) -> Array:
    """Return the pose error: metres, then the rotation vector in world axes, shape (6,)."""
    turn = rotation_vector(product(target.xyzw, conjugate(actual.xyzw)))
    return np.concatenate((target.xyz - actual.xyz, turn))


def weighted_step(jacobian: Array, error: Array, *, damping: float, pull: Array | None = None) -> Array:
    """Return the damped joint step that reduces `error`; `pull` acts in the null space."""
    square = jacobian @ jacobian.T
    square[np.diag_indices_from(square)] += damping + 1e-12
    if pull is None:
        return jacobian.T @ np.linalg.solve(square, error)
    return pull + jacobian.T @ np.linalg.solve(square, error - jacobian @ pull)
