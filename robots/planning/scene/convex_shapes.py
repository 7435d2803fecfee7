"""Convex solids as arrays: penetration depth of points, surface samples, planes of hulls, bounding spheres."""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere
from robots.model.transform import RigidTransform
from robots.planning.scene.compiled_problem import BOX, CAPSULE, CYLINDER, HULL, SPHERE
from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class ConvexSolid:
    """A shape in the form of the compiled core, in its own frame.

    `kind` and `size` (3,) as in `CompiledProblem`; `planes` (m, 4) and `corners` (k, 3) are those of a hull,
    else empty; `centre` (3,) and `radius_m` are of its bounding sphere.
    """

    kind: int
    size: Array
    planes: Array
    corners: Array
    centre: Array
    radius_m: float

    def depth(self, points: Array) -> Array:
        """Return a lower bound of the depth of points (k, 3) inside the solid; negative outside."""
        match self.kind:
            case 0:
                return (self.size - np.abs(points)).min(axis=1)
            case 1:
                side = self.size[0] - np.hypot(points[:, 0], points[:, 1])
                return np.minimum(side, self.size[1] - np.abs(points[:, 2]))
            case 2:
                return self.size[0] - np.linalg.norm(points, axis=1)
            case 3:
                along = np.clip(points[:, 2], -self.size[1], self.size[1])
                return self.size[0] - np.sqrt(points[:, 0] ** 2 + points[:, 1] ** 2 + (points[:, 2] - along) ** 2)
            case _:
                return -(points @ self.planes[:, :3].T + self.planes[:, 3]).max(axis=1)

    def surface(self, spacing_m: float) -> Array:
        """Return points (k, 3) that cover the surface: each surface point is within 0.8 spacings of one of them."""
        match self.kind:
            case 0:
                return _box_surface(self.size, spacing_m)
            case 1:
                return _cylinder_surface(float(self.size[0]), float(self.size[1]), spacing_m)
            case 2:
                return _sphere_surface(float(self.size[0]), spacing_m)
            case 3:
                radius, half = float(self.size[0]), float(self.size[1])
                ball = _sphere_surface(radius, spacing_m)
                caps = ball + np.sign(ball[:, 2:]) * np.array([0.0, 0.0, half])
                return np.vstack((caps, _barrel(radius, half, spacing_m)))
            case _:
                return _hull_surface(self.corners, spacing_m)

    def box(self) -> tuple[Array, Array]:
        """Return the lower and the upper corner of its bounding box."""
        match self.kind:
            case 0:
                return -self.size, self.size
            case 1:
                half = np.array([self.size[0], self.size[0], self.size[1]])
                return -half, half
            case 2 | 3:
                half = np.array([self.size[0], self.size[0], self.size[0] + self.size[1]])
                return -half, half
            case _:
                return self.corners.min(axis=0), self.corners.max(axis=0)


def convex_solid(shape: Shape) -> ConvexSolid:
    """Return the arrays of a shape whose sizes have been checked."""
    none, origin = np.empty((0, 4)), np.zeros(3)
    match shape:
        case Box(size_m=edges):
            half = np.array(edges) / 2.0
            return _solid(BOX, half, radius_m=float(np.linalg.norm(half)))
        case Cylinder(radius_m=radius, length_m=length):
            return _solid(CYLINDER, np.array([radius, length / 2.0, 0.0]), radius_m=math.hypot(radius, length / 2.0))
        case Sphere(radius_m=radius):
            return _solid(SPHERE, np.array([radius, 0.0, 0.0]), radius_m=radius)
        case Capsule(radius_m=radius, length_m=length):
            return _solid(CAPSULE, np.array([radius, length / 2.0, 0.0]), radius_m=radius + length / 2.0)
        case Hull(points_m=points):
            hull = _convex_hull(np.array(points, dtype=np.float64))
            corners = np.array(hull.points[hull.vertices])
            # Triangles of one face share its plane.
            planes = np.unique(np.array(hull.equations).round(9), axis=0)
            centre = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
            return ConvexSolid(
                kind=HULL,
                size=origin,
                planes=planes if len(planes) else none,
                corners=corners,
                centre=centre,
                radius_m=float(np.linalg.norm(corners - centre, axis=1).max()),
            )


def to_frame(pose: RigidTransform, points: Array) -> Array:
    """Transform points (k, 3) from the frame at `pose` to the frame in which `pose` is given."""
    return points @ pose.rotation.T + pose.xyz


def _solid(kind: int, size: Array, *, radius_m: float) -> ConvexSolid:
    return ConvexSolid(
        kind=kind,
        size=size,
        planes=np.empty((0, 4)),
        corners=np.empty((0, 3)),
        centre=np.zeros(3),
        radius_m=radius_m,
    )


def _line(half: float, spacing_m: float) -> Array:
    return np.linspace(-half, half, max(2, math.ceil(2.0 * half / spacing_m) + 1))


def _box_surface(half: Array, spacing_m: float) -> Array:
    faces: list[Array] = []
    for axis in range(3):
        u, v = [i for i in range(3) if i != axis]
        a, b = np.meshgrid(_line(float(half[u]), spacing_m), _line(float(half[v]), spacing_m))
        for side in (-1.0, 1.0):
            face = np.empty((a.size, 3))
            face[:, u], face[:, v], face[:, axis] = a.ravel(), b.ravel(), side * half[axis]
            faces.append(face)
    return np.vstack(faces)


def _barrel(radius: float, half: float, spacing_m: float) -> Array:
    turns = np.arange(0.0, 2.0 * math.pi, min(spacing_m / radius, 0.7))
    turn, z = np.meshgrid(turns, _line(half, spacing_m))
    return np.column_stack((radius * np.cos(turn.ravel()), radius * np.sin(turn.ravel()), z.ravel()))


def _cylinder_surface(radius: float, half: float, spacing_m: float) -> Array:
    x, y = (grid.ravel() for grid in np.meshgrid(_line(radius, spacing_m), _line(radius, spacing_m)))
    inside = np.hypot(x, y) < radius
    ends = [np.column_stack((x[inside], y[inside], np.full(int(inside.sum()), z))) for z in (-half, half)]
    return np.vstack((_barrel(radius, half, spacing_m), *ends))


def _sphere_surface(radius: float, spacing_m: float) -> Array:
    count = max(12, math.ceil(4.0 * math.pi * radius**2 / spacing_m**2 * 1.5))
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, math.pi * (1.0 + math.sqrt(5.0)) * k
    side = np.sqrt(1.0 - z**2)
    return radius * np.column_stack((side * np.cos(turn), side * np.sin(turn), z))


def _convex_hull(points: Array) -> Any:
    # scipy's stubs lack qhull; its import takes most of a second, and most cells have no hulls.
    return import_module("scipy.spatial").ConvexHull(points)


def _hull_surface(corners: Array, spacing_m: float) -> Array:
    hull = _convex_hull(corners)
    points: list[Array] = [corners]
    for a, b, c in corners[np.array(hull.simplices)]:
        longest = max(float(np.linalg.norm(b - a)), float(np.linalg.norm(c - a)), float(np.linalg.norm(c - b)))
        parts = max(1, math.ceil(longest / spacing_m))
        u, v = (grid.ravel() / parts for grid in np.meshgrid(np.arange(parts + 1), np.arange(parts + 1)))
        within = u + v <= 1.0 + 1e-9
        points.append(a + u[within, None] * (b - a) + v[within, None] * (c - a))
    return np.unique(np.vstack(points).round(7), axis=0)
