"""Distance of points from a convex shape: exact outside, negative inside."""

from __future__ import annotations

import numpy as np

from robots.planning.scene.compiled_problem import BOX, CAPSULE, CYLINDER, SPHERE
from robots.planning.scene.convex_shapes import ConvexSolid
from robots.port import Array


def solid_distance(solid: ConvexSolid, points: Array) -> Array:
    """Return the distances (k,) of points (k, 3) in the solid's frame; a lower bound for a hull."""
    size = solid.size
    match solid.kind:
        case kind if kind == BOX:
            return _outside(np.abs(points) - size)
        case kind if kind == CYLINDER:
            side = np.hypot(points[:, 0], points[:, 1]) - size[0]
            return _outside(np.column_stack((side, np.abs(points[:, 2]) - size[1])))
        case kind if kind == SPHERE:
            return np.linalg.norm(points, axis=1) - size[0]
        case kind if kind == CAPSULE:
            along = np.clip(points[:, 2], -size[1], size[1])
            return np.sqrt(points[:, 0] ** 2 + points[:, 1] ** 2 + (points[:, 2] - along) ** 2) - size[0]
        case _:
            return (points @ solid.planes[:, :3].T + solid.planes[:, 3]).max(axis=1)


def _outside(beyond: Array) -> Array:
    """Return the distance from the excess of points beyond each of some orthogonal faces."""
    return np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
