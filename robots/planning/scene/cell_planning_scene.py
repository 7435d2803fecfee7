"""The planning scene of a cell: its arms, fixtures and parts, from the same description as the simulation."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine.errors import CellError
from engine.messages import Pose
from engine.messages.shapes import Box, Cylinder, Hull, Obstacle, Shape, Solid, Sphere
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair, PlanningScene, SceneArm
from robots.scene.sim_scene import FixtureBody, PartBody, SimScene


def planning_scene(cell: SimScene, *, parts: Mapping[str, Pose] | None = None) -> PlanningScene:
    """Return the planning scene of a cell; all arms are at home.

    Fixtures and parts become obstacles with their names, a tray five boxes with one name, a mesh its convex pieces.
    Parts have the poses of `parts`, in the world, else their initial poses. The first moving link of an arm may touch
    the fixtures that it touches at home, to which the arm is bolted.

    Raises:
        CellError: the shape of a body is unknown, or its size does not fit.
    """
    scene = PlanningScene(
        arms=tuple(SceneArm(placement=arm) for arm in cell.arms),
        obstacles=known_obstacles(cell, parts=parts),
    )
    fixtures = {fixture.name for fixture in cell.fixtures}
    allowed: list[NamePair] = []
    for arm in cell.arms:
        checker = ExactChecker(scene, arm.name)
        shoulder = f"{arm.name}/{checker.first_moving_link}"
        for a, b in checker.colliding_pairs(np.array(checker.model.home_rad)):
            if a == shoulder and b in fixtures:
                allowed.append((a, b))
    for a, b in allowed:
        scene = scene.with_allowed(a, b)
    return scene


def known_obstacles(cell: SimScene, *, parts: Mapping[str, Pose] | None = None) -> tuple[Obstacle, ...]:
    """Return the fixtures and parts of a cell; parts have the poses of `parts`, else their initial poses.

    Raises:
        CellError: the shape of a body is unknown, or its size does not fit.
    """
    part_poses = parts or {}
    obstacles = [Obstacle(name=f.name, solids=_solids(f), pose=f.pose) for f in cell.fixtures]
    obstacles += [Obstacle(name=p.name, solids=_solids(p), pose=part_poses.get(p.name, p.pose)) for p in cell.parts]
    return tuple(obstacles)


def _solids(body: FixtureBody | PartBody) -> tuple[Solid, ...]:
    if body.shape == "tray" and isinstance(body, FixtureBody):
        return _tray(body)
    if isinstance(body, FixtureBody) and body.mesh is not None:
        return tuple(Solid(shape=Hull(points_m=piece)) for piece in body.mesh.pieces)
    plate = Solid(shape=_shape(body.shape, body.size_m, of=body.name))
    if not isinstance(body, PartBody) or body.tool is None:
        return (plate,)
    more = (Solid(shape=_shape(s.shape, s.size_m, of=body.name), pose=s.at.pose()) for s in body.tool.shapes)
    return (plate, *more)


def _shape(shape: str, size_m: tuple[float, ...], *, of: str) -> Shape:
    match shape, size_m:
        case "box", (x, y, z):
            return Box(size_m=(x, y, z))
        case "cylinder", (diameter, length):
            return Cylinder(radius_m=diameter / 2.0, length_m=length)
        case "sphere", (diameter,):
            return Sphere(radius_m=diameter / 2.0)
        case _:
            raise CellError(
                f"the size {list(size_m)} does not fit a {shape}",
                where=of,
                hint="box: three edge lengths; cylinder: diameter and length; sphere: diameter",
            )


def _tray(tray: FixtureBody) -> tuple[Solid, ...]:
    """Return the floor and the four walls."""
    length, width, height = tray.size_m
    wall = tray.wall_m
    rise = height - wall
    across, along, up = (length - wall) / 2, (width - wall) / 2, wall + rise / 2
    boxes = (
        ((0.0, 0.0, wall / 2), (length, width, wall)),
        ((across, 0.0, up), (wall, width, rise)),
        ((-across, 0.0, up), (wall, width, rise)),
        ((0.0, along, up), (length - 2 * wall, wall, rise)),
        ((0.0, -along, up), (length - 2 * wall, wall, rise)),
    )
    return tuple(Solid(shape=Box(size_m=size), pose=Pose(xyz=centre)) for centre, size in boxes)
