"""Cached shapes for both checkers: each is created once, even if the scene changes often."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from engine.errors import CellError
from engine.messages.shapes import Shape
from robots.model.robot_model import RobotModel
from robots.planning.scene.arm_shapes import arm_shapes
from robots.planning.scene.coal_shapes import coal_shape, shape_of
from robots.planning.scene.convex_shapes import ConvexSolid, convex_solid


@dataclass(frozen=True, kw_only=True, eq=False)
class CachedShape:
    """A convex shape, as arrays for the compiled core and as a Coal geometry, which must not be modified."""

    shape: Shape
    solid: ConvexSolid
    geometry: Any


def cached_shape(shape: Shape, name: str) -> CachedShape:
    """Return the cached shape.

    Raises:
        CellError: a size is not positive, or the points of a hull enclose no volume; `name` is the owner.
    """
    try:
        return _create(shape)
    except CellError as error:
        raise CellError(error.message, where=name, hint=error.hint) from error


@lru_cache(maxsize=64)
def cached_link_shapes(model: RobotModel, tool_joints: tuple[tuple[str, float], ...]) -> tuple[CachedShape, ...]:
    """Return the cached shapes of `arm_shapes`, in its order."""
    objects = arm_shapes(model, tool_joints).geometry.geometryObjects
    shapes = [shape_of(one.geometry) for one in objects]
    return tuple(
        CachedShape(shape=shape, solid=convex_solid(shape), geometry=one.geometry)
        for shape, one in zip(shapes, objects, strict=True)
    )


@lru_cache(maxsize=1024)
def _create(shape: Shape) -> CachedShape:
    return CachedShape(geometry=coal_shape(shape, "shape"), shape=shape, solid=convex_solid(shape))
