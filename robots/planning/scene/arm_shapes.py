"""An arm's collision shapes for planning: those of its model, cylinders with end spheres merged to capsules."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from robots.model.mechanics.collision_model import CollisionModel
from robots.model.robot_model import RobotModel
from robots.planning.scene.coal_shapes import coal, pin

_SAME_M = 1e-6


@dataclass(frozen=True, kw_only=True)
class ArmShapes:
    """Pinocchio's model of an arm with its tool locked, its shapes and their collision pairs; do not modify.

    `links` names the link of each shape, `pairs` the collision pairs of links.
    """

    solver: Any
    geometry: Any
    links: tuple[str, ...]
    pairs: tuple[tuple[str, str], ...]


@lru_cache(maxsize=64)
def arm_shapes(model: RobotModel, tool_joints: tuple[tuple[str, float], ...]) -> ArmShapes:
    """Return the shapes of an arm with its tool; created once.

    URDF has no capsules, so descriptions use three shapes for each: nine pairs for every two links.

    Raises:
        CellError: a mesh is missing, or a named joint is not the tool's.
    """
    collision = CollisionModel(model, tool_joints=dict(tool_joints))
    solver, old = collision.solver, list(collision.geometry.geometryObjects)
    geometry = pin.GeometryModel()
    merged: set[int] = set()
    for index, shape in enumerate(old):
        ends = _ends(shape, old) if isinstance(shape.geometry, coal.Cylinder) else ()
        solid = shape.geometry
        if len(ends) == 2:
            merged.update(ends)
            solid = coal.Capsule(float(solid.radius), 2.0 * float(solid.halfLength))
        if index not in merged:
            geometry.addGeometryObject(
                pin.GeometryObject(shape.name, shape.parentJoint, shape.parentFrame, shape.placement, solid)
            )
    # A sphere may precede its cylinder.
    for index in sorted(merged):
        if geometry.existGeometryName(old[index].name):
            geometry.removeGeometryObject(old[index].name)
    links = tuple(str(solver.frames[shape.parentFrame].name) for shape in geometry.geometryObjects)
    checked = {frozenset(pair) for pair in collision.pairs}
    for i in range(len(links)):
        for j in range(i + 1, len(links)):
            if frozenset((links[i], links[j])) in checked:
                geometry.addCollisionPair(pin.CollisionPair(i, j))
    return ArmShapes(solver=solver, geometry=geometry, links=links, pairs=collision.pairs)


def _ends(cylinder: Any, shapes: list[Any]) -> tuple[int, ...]:
    """Return the spheres of the cylinder's radius that are centered on its two ends, one for each."""
    radius, half = float(cylinder.geometry.radius), float(cylinder.geometry.halfLength)
    spheres: list[int] = []
    for side in (-half, half):
        end = np.array(cylinder.placement.act(np.array([0.0, 0.0, side])))
        for index, shape in enumerate(shapes):
            if (
                isinstance(shape.geometry, coal.Sphere)
                and shape.parentFrame == cylinder.parentFrame
                and abs(float(shape.geometry.radius) - radius) < _SAME_M
                and float(np.linalg.norm(np.array(shape.placement.translation) - end)) < _SAME_M
            ):
                spheres.append(index)
                break
    return tuple(spheres)
