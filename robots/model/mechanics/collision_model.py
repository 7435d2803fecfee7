"""Self-collision of an arm with its tool: convex shapes of all links, and the checked pairs."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from itertools import combinations
from typing import Any

import numpy as np

from engine.errors import CellError
from robots.model.mechanics.pinocchio_model import locked_joints, pin, rest_configuration, whole_model
from robots.model.robot_model import RobotModel
from robots.port import Array

coal: Any = import_module("coal")

Pair = tuple[str, str]


class CollisionModel:
    """The colliding links of one arm at a configuration; shapes are convex hulls of the URDF's.

    Links without relative motion, neighbours at a joint, and the pairs of
    `RobotModel.allowed_collisions` are excluded. One instance serves one thread at a time.
    Obstacles may be added to `geometry` (pinocchio's GeometryModel); call `renew` afterwards.

    Args:
        model: The arm.
        tool_joints: Positions of the tool's joints; 0 for those not named.

    Raises:
        CellError: a mesh is missing, or a named joint is not the tool's.
    """

    def __init__(self, model: RobotModel, *, tool_joints: Mapping[str, float] | None = None) -> None:
        self.model = model
        self.solver, self.geometry = _built(model, tool_joints or {})
        links = [_link(self.solver, shape) for shape in self.geometry.geometryObjects]
        self.pairs = _counting_pairs(model, self.solver, self.geometry, links)
        checked = {frozenset(pair) for pair in self.pairs}
        for i, j in combinations(range(len(links)), 2):
            if frozenset((links[i], links[j])) in checked:
                self.geometry.addCollisionPair(pin.CollisionPair(i, j))
        self._links = links
        self.renew()

    def renew(self) -> None:
        """Rebuild the working data; required after shapes or pairs were added."""
        # A GeometryData belongs to the GeometryModel as it was at its creation; both live as long as this object.
        self._data = self.solver.createData()
        self._geometry_data = self.geometry.createData()

    def in_collision(self, joints: Array) -> bool:
        """Return whether any checked pair touches at `joints`, shape (n,)."""
        return bool(pin.computeCollisions(self.solver, self._data, self.geometry, self._geometry_data, joints, True))

    def colliding_pairs(self, joints: Array) -> tuple[Pair, ...]:
        """Return the pairs of links that touch at `joints`, shape (n,), each once."""
        pin.computeCollisions(self.solver, self._data, self.geometry, self._geometry_data, joints, False)
        found: dict[Pair, None] = {}
        for index, pair in enumerate(self.geometry.collisionPairs):
            if self._geometry_data.collisionResults[index].isCollision():
                found[self._name(pair.first), self._name(pair.second)] = None
        return tuple(found)

    def clearance(self, joints: Array) -> tuple[float, Pair]:
        """Return the smallest distance of a checked pair in metres (0 or less if they touch), and the pair."""
        pin.computeDistances(self.solver, self._data, self.geometry, self._geometry_data, joints)
        distances = [result.min_distance for result in self._geometry_data.distanceResults]
        if not distances:
            return float("inf"), ("", "")
        nearest = int(np.argmin(distances))
        pair = self.geometry.collisionPairs[nearest]
        return float(distances[nearest]), (self._name(pair.first), self._name(pair.second))

    def hulls(self) -> tuple[tuple[str, Array], ...]:
        """Return the link and the corners, shape (points, 3) in the link's frame, of every hull of a mesh."""
        found: list[tuple[str, Array]] = []
        for link, shape in zip(self._links, self.geometry.geometryObjects, strict=False):
            if isinstance(shape.geometry, coal.ConvexBase):
                at = self.solver.frames[shape.parentFrame].placement.inverse() * shape.placement
                found.append((link, np.array(shape.geometry.points()) @ at.rotation.T + at.translation))
        return tuple(found)

    def _name(self, shape: int) -> str:
        return self._links[shape] if shape < len(self._links) else str(self.geometry.geometryObjects[shape].name)


def sampled_pairs(model: RobotModel, *, samples: int = 20_000, seed: int = 0) -> tuple[tuple[Pair, ...], ...]:
    """Return the pairs that touch in every, and those that touch in no, random configuration, in link order.

    For `collisions: {allowed: …}` of a `robot.yaml` without an SRDF.
    """
    collision = CollisionModel(model)
    lower, upper = np.array(model.limits.lower_rad), np.array(model.limits.upper_rad)
    random = np.random.default_rng(seed)
    counts = dict.fromkeys(collision.pairs, 0)
    for _ in range(samples):
        for pair in collision.colliding_pairs(random.uniform(lower, upper)):
            counts[pair if pair in counts else (pair[1], pair[0])] += 1
    always = tuple(pair for pair, count in counts.items() if count == samples)
    return always, tuple(pair for pair, count in counts.items() if count == 0)


def _built(model: RobotModel, tool_joints: Mapping[str, float]) -> tuple[Any, Any]:
    full = whole_model(model)
    try:
        geometry = pin.buildGeomFromUrdfString(
            full,
            model.urdf_text,
            pin.GeometryType.COLLISION,
            package_dirs=[str(folder) for folder in model.package_dirs],
        )
    except ValueError as error:
        raise CellError(f"the collision shapes cannot be read: {error}", where=model.name) from error
    for shape in geometry.geometryObjects:
        if isinstance(shape.geometry, coal.BVHModelBase):
            shape.geometry.buildConvexHull(True, "Qt")
            shape.geometry = shape.geometry.convex
    at = rest_configuration(full, model)
    for name, value in tool_joints.items():
        if name in model.arm_joints or not full.existJointName(name):
            raise CellError(f"{name} is not a joint of the tool", where=model.name)
        at[full.joints[full.getJointId(name)].idx_q] = value
    return pin.buildReducedModel(full, geometry, locked_joints(full, model), at)


def _link(solver: Any, shape: Any) -> str:
    return str(solver.frames[shape.parentFrame].name)


def _counting_pairs(model: RobotModel, solver: Any, geometry: Any, links: list[str]) -> tuple[Pair, ...]:
    joint_of = {link: int(shape.parentJoint) for link, shape in zip(links, geometry.geometryObjects, strict=True)}
    allowed = {frozenset(pair) for pair in model.allowed_collisions} | _neighbours(solver, model, joint_of)
    return tuple(
        (a, b) for a, b in combinations(joint_of, 2) if joint_of[a] != joint_of[b] and frozenset((a, b)) not in allowed
    )


def _neighbours(solver: Any, model: RobotModel, joint_of: dict[str, int]) -> set[frozenset[str]]:
    """Return the pairs of arm links with a joint between them, excluding those between the last link and a tool."""
    tool = set(model.tool.links) if model.tool is not None else set[str]()
    return {
        frozenset((a, b))
        for a, b in combinations(joint_of, 2)
        if not {a, b} & tool
        and (solver.parents[joint_of[a]] == joint_of[b] or solver.parents[joint_of[b]] == joint_of[a])
        and joint_of[a] != joint_of[b]
    }
