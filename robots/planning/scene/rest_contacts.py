"""Which bodies of a cell document touch or nearly do with its arms at home; opens no simulation or device.

An arm must keep a margin from everything but what it is bolted to. A part lies on something, and the fixtures of one
document may be built of shapes that overlap: of these only a part that is inside of another body is told, and what a
module brings into something else.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import msgspec
import numpy as np

from engine.cell import RestContact
from engine.document import Cell, MujocoWorld, cell_at_start
from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.coal_shapes import coal, corners_of, placement
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene
from robots.planning.scene.static_scene import PlacedSolid, static_solids
from robots.port import Array
from robots.scene.scene_builder import build_scene

_MARGIN_M = 0.01
"""An arm nearer than this to something at rest has hardly a way to begin."""
_OVERLAP_M = 0.001
"""Bodies that only rest on one another overlap by less than this."""
_NO_ARM = ""


def rest_contacts(cell: Cell, *, margin_m: float = _MARGIN_M) -> tuple[RestContact, ...]:
    """Return the bodies that touch at rest, and arms that are nearer than the margin to something, deepest first.

    Raises:
        CellError: the scene of the cell cannot be built.
        DocumentError: a model folder or a calibration file is invalid.
    """
    document = cell_at_start(cell)
    robots = {name: msgspec.structs.replace(robot, driver="sim") for name, robot in document.robots.items()}
    drawn = msgspec.structs.replace(document, world=document.world or MujocoWorld(), robots=robots, people={})
    scene = planning_scene(build_scene(drawn, resolve=cell.resolve))
    nearest: dict[frozenset[str], RestContact] = {}
    for found in (*_of_arms(scene, margin_m), *_of_bodies(scene, frozenset(drawn.parts))):
        pair = frozenset((found.first, found.second))
        if pair not in nearest or found.distance_m < nearest[pair].distance_m:
            nearest[pair] = found
    return tuple(sorted(nearest.values(), key=lambda each: (each.distance_m, each.first, each.second)))


def _of_arms(scene: PlanningScene, margin_m: float) -> Iterator[RestContact]:
    for arm in scene.arms:
        checker = ExactChecker(scene, arm.name)
        own = f"{arm.name}/"
        for checks in checker.checks:
            distances = checks.distances(np.array(checker.model.home_rad))
            for (first, second), distance in zip(checks.pairs, distances.tolist(), strict=True):
                # The links of an arm may be near one another; they must not touch.
                if distance < (0.0 if first.startswith(own) and second.startswith(own) else margin_m):
                    yield RestContact(first=first, second=second, distance_m=distance)


def _of_bodies(scene: PlanningScene, parts: frozenset[str]) -> Iterator[RestContact]:
    """Yield parts inside of other bodies, and what modules bring into what does not stand on them."""
    bodies = msgspec.structs.replace(scene, arms=(), attached=())
    solids = [(solid, *_bounds(solid)) for solid in static_solids(bodies, _NO_ARM)]
    for (one, low, high), (other, other_low, other_high) in itertools.combinations(solids, 2):
        if one.name == other.name or not (parts & {one.name, other.name} or _owner(one.name) != _owner(other.name)):
            continue
        if (low < other_high).all() and (other_low < high).all():
            distance = _distance(one, other)
            if distance < -_OVERLAP_M:
                yield RestContact(first=one.name, second=other.name, distance_m=distance)


def _owner(name: str) -> str:
    """Return the module that a body stands on; empty for one of the cell itself."""
    module, below, _ = name.partition("/")
    return module if below else ""


def _bounds(solid: PlacedSolid) -> tuple[Array, Array]:
    at = placement(solid.pose)
    corners = corners_of(solid.ready.geometry) @ at.rotation.T + at.translation
    return corners.min(axis=0), corners.max(axis=0)


def _distance(one: PlacedSolid, other: PlacedSolid) -> float:
    first, second = placement(one.pose), placement(other.pose)
    result = coal.DistanceResult()
    coal.distance(
        one.ready.geometry,
        coal.Transform3s(first.rotation, first.translation),
        other.ready.geometry,
        coal.Transform3s(second.rotation, second.translation),
        coal.DistanceRequest(),
        result,
    )
    return float(result.min_distance)
