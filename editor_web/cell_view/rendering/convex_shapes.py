"""The convex shapes of obstacles and held parts in viser."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.geometry import GeometryHandle, Rgb
from editor_web.cell_view.rendering.transforms import wxyz
from engine.messages import Vector3
from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Solid, Sphere

_RINGS = 8
_SIDES = 24
# A shape drawn over the same part must not flicker against it.
_SWELL = 1.01


def add_convex_shape(server: Canvas, name: str, solid: Solid, *, colour: Rgb, opacity: float) -> GeometryHandle:
    """Draw one solid at the node `name`, translucent.

    Raises:
        ValueError: the points of a hull do not span a volume.
    """
    common: dict[str, Any] = {
        "color": colour,
        "opacity": opacity,
        "cast_shadow": False,
        "receive_shadow": False,
        "wxyz": wxyz(solid.pose.xyzw),
        "position": solid.pose.xyz,
        "scale": _SWELL,
    }
    match solid.shape:
        case Box(size_m=size_m):
            return server.scene.add_box(name, dimensions=size_m, **common)
        case Cylinder(radius_m=radius_m, length_m=length_m):
            return server.scene.add_cylinder(name, radius=radius_m, height=length_m, **common)
        case Sphere(radius_m=radius_m):
            return server.scene.add_icosphere(name, radius=radius_m, **common)
        case Capsule(radius_m=radius_m, length_m=length_m):
            vertices, faces = capsule(radius_m, length_m)
        case Hull(points_m=points_m):
            vertices, faces = hull(points_m)
    return server.scene.add_mesh_simple(name, vertices=vertices, faces=faces, side="double", **common)


def capsule(radius_m: float, length_m: float) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Return vertices (n x 3) and faces (m x 3) of a capsule along z whose cylinder is `length_m` long."""
    rise = np.linspace(-np.pi / 2, np.pi / 2, 2 * _RINGS)
    middle = np.where(np.arange(2 * _RINGS) < _RINGS, -length_m / 2, length_m / 2)
    turn = np.arange(_SIDES) * 2 * np.pi / _SIDES
    width = radius_m * np.cos(rise)[:, None]
    rings = [width * np.cos(turn), width * np.sin(turn), (middle + radius_m * np.sin(rise))[:, None] + 0 * turn]
    vertices = np.stack(rings, axis=-1).reshape(-1, 3).astype(np.float32)
    low = np.arange((2 * _RINGS - 1) * _SIDES)
    right = low - low % _SIDES + (low + 1) % _SIDES
    halves = (low, right, low + _SIDES), (right, right + _SIDES, low + _SIDES)
    return vertices, np.concatenate([np.stack(half, axis=1) for half in halves]).astype(np.uint32)


def hull(points_m: tuple[Vector3, ...]) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Return vertices (n x 3) and faces (m x 3) of the convex hull of points; face orientation is arbitrary.

    Raises:
        ValueError: the points lie in one plane.
    """
    # Importing scipy takes most of a second, and most cells have no hulls.
    from scipy.spatial import ConvexHull, QhullError

    vertices = np.asarray(points_m, dtype=np.float64).reshape(-1, 3)
    try:
        faces: Any = ConvexHull(vertices).simplices
    except (QhullError, ValueError) as error:
        raise ValueError("the points of a hull lie in one plane") from error
    return vertices.astype(np.float32), np.asarray(faces, dtype=np.uint32)
