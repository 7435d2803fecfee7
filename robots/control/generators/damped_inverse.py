"""Joint velocities for a tool velocity, damped only near a singularity and only in the singular direction."""

from __future__ import annotations

import numpy as np

from robots.port import Array

# Below this singular value (metres and radians weighted equally) a Panda turns some joint more than
# sixteen times as fast as its tool moves.
_NEAR = 0.06
_DAMPING = 0.06
_FULL = 6


def joint_velocity(jacobian: Array, twist: Array) -> Array:
    """Return joint velocities, (n,), for a tool velocity, (m,); the Jacobian has shape (m, n).

    Exact far from singularities; near one, the part of the tool's velocity that would need fast joints
    fades out (numerical filtering, Maciejewski and Klein 1988). Of several solutions it returns the slowest.
    """
    squares, directions = np.linalg.eigh(jacobian @ jacobian.T)
    squares = np.maximum(squares, 0.0)
    damping = _DAMPING**2 * np.maximum(1.0 - squares / _NEAR**2, 0.0)
    return jacobian.T @ (directions @ ((directions.T @ twist) / (squares + damping)))


def twist_rows(twist: Array, joints: int) -> slice:
    """Return the active rows of a twist: an arm of few joints cannot keep its orientation while it moves."""
    if joints >= _FULL:
        return slice(0, 6)
    return slice(0, 3) if twist[:3].any() else slice(3, 6)
