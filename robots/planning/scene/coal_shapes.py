"""Converts shapes of the planning scene to Coal and back; the only module that depends on both."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from engine.errors import CellError
from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere
from robots.model.transform import RigidTransform
from robots.port import Array

coal: Any = import_module("coal")
pin: Any = import_module("pinocchio")


def coal_shape(shape: Shape, name: str) -> Any:
    """Return Coal's convex shape.

    Raises:
        CellError: a size is not positive, or the points of a hull enclose no volume.
    """
    match shape:
        case Box(size_m=size):
            _check(size, name)
            return coal.Box(*size)
        case Cylinder(radius_m=radius, length_m=length):
            _check((radius, length), name)
            return coal.Cylinder(radius, length)
        case Sphere(radius_m=radius):
            _check((radius,), name)
            return coal.Sphere(radius)
        case Capsule(radius_m=radius, length_m=length):
            _check((radius, length), name)
            return coal.Capsule(radius, length)
        case Hull(points_m=points):
            return _hull(np.array(points, dtype=np.float64), name)


def shape_of(geometry: Any) -> Shape:
    """Return the shape of a convex Coal geometry.

    Raises:
        CellError: the kind of geometry is not supported.
    """
    match geometry:
        case coal.Box():
            x, y, z = (2.0 * np.array(geometry.halfSide)).tolist()
            return Box(size_m=(x, y, z))
        case coal.Sphere():
            return Sphere(radius_m=float(geometry.radius))
        case coal.Capsule():
            return Capsule(radius_m=float(geometry.radius), length_m=2.0 * float(geometry.halfLength))
        case coal.Cylinder():
            return Cylinder(radius_m=float(geometry.radius), length_m=2.0 * float(geometry.halfLength))
        case coal.ConvexBase():
            points: list[list[float]] = np.array(geometry.points()).tolist()
            return Hull(points_m=tuple((x, y, z) for x, y, z in points))
        case _:
            raise CellError(
                f"the planning scene does not support {type(geometry).__name__}",
                hint="give the link boxes, cylinders, spheres, capsules or meshes",
            )


def corners_of(geometry: Any) -> Array:
    """Return the corners of the bounding box of a Coal geometry along its own axes, shape (8, 3)."""
    geometry.computeLocalAABB()
    ends = np.array([geometry.aabb_local.min_, geometry.aabb_local.max_])
    return np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def placement(pose: RigidTransform) -> Any:
    """Return the pose as a Pinocchio transform."""
    return pin.SE3(pose.rotation, pose.xyz)


def rigid_of(transform: Any) -> RigidTransform:
    """Return a Pinocchio transform as a rigid transform."""
    return RigidTransform.of(np.array(transform.translation), np.array(pin.Quaternion(transform.rotation).coeffs()))


def _hull(points: Array, name: str) -> Any:
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 4 or not np.isfinite(points).all():
        raise CellError("a hull needs at least four finite points of 3 coordinates", where=name)
    if np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-6) < 3:
        raise CellError("the points of a hull lie in one plane", where=name, hint="give it some thickness")
    corners = coal.StdVec_Vec3s()
    corners.extend(list(points))
    return coal.Convex.convexHull(corners, True, "Qt")


def _check(sizes: tuple[float, ...], name: str) -> None:
    if not all(np.isfinite(size) and size > 0.0 for size in sizes):
        raise CellError(f"invalid sizes {list(sizes)} m of a shape", where=name, hint="give positive numbers")
