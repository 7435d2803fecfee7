"""Exact collision checks of an arm in a planning scene: convex shapes of all links, attached parts and obstacles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from copy import copy
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from robots.model.transform import RigidTransform
from robots.planning.scene.allowed_collisions import allowed_collision_matrix
from robots.planning.scene.arm_shapes import arm_shapes
from robots.planning.scene.coal_shapes import corners_of, pin, placement
from robots.planning.scene.motion_bound import motion_bound
from robots.planning.scene.pair_checks import PairChecks
from robots.planning.scene.planning_scene import OCCUPANCY, AttachedPart, NamePair, PlanningScene
from robots.planning.scene.shape_cache import CachedShape, cached_shape
from robots.planning.scene.static_scene import ArmInScene, PlacedSolid, arm_in_scene, held_frame, tool_joint
from robots.planning.scene.voxels import Voxels
from robots.port import Array

_STEP_SHARE, _LEAST_STEP_M, _MOST_STEP_M = 0.016, 0.01, 0.04


@dataclass(frozen=True, kw_only=True)
class Clearance:
    """The smallest distance of a pair that must not touch (0 or less if it does), and the names."""

    distance_m: float
    pair: NamePair


@dataclass(frozen=True, kw_only=True)
class PathCollision:
    """The first collision on a path: after waypoint `segment`, at `share` of the segment, at `joints` (n,)."""

    segment: int
    share: float
    joints: Array
    pairs: tuple[NamePair, ...]


class CollisionQuery(Protocol):
    """Collision queries of an arm: an exact checker, or an escape checker for a start within the margin."""

    def in_collision(self, joints: Array) -> bool:
        """Return whether any pair touches at `joints`, shape (n,)."""
        ...

    def colliding_pairs(self, joints: Array) -> tuple[NamePair, ...]:
        """Return the names of all pairs that touch at `joints`, shape (n,), each once."""
        ...


class ExactChecker:
    """Checks one arm of a scene against itself, its attached parts and everything else.

    Shapes are those of the URDF, meshes as their convex hulls. Pairs that cannot move relative to each other are
    not checked. The checker holds the interpreter lock while it works and serves one thread at a time.

    Args:
        scene: The scene; later changes need a new checker (a millisecond).
        arm: Name of the moving arm.
        margin_m: Nearer than this counts as touching an obstacle or another arm; self-collision has no margin.
        among: The result of `arm_in_scene` for this scene and arm, if available.

    Raises:
        CellError: there is no such arm, or a shape or model is invalid.
    """

    def __init__(
        self, scene: PlanningScene, arm: str, *, margin_m: float = 0.0, among: ArmInScene | None = None
    ) -> None:
        among = among or arm_in_scene(scene, arm)
        self.arm = arm
        self.scene = scene
        self.model = among.model
        self.margin_m = margin_m
        base = arm_shapes(self.model, among.placed.tool_joints)
        self._solver = base.solver
        self._geometry = base.geometry.copy()
        self._names = [f"{arm}/{link}" for link in base.links]
        self._world = RigidTransform.from_pose(among.placed.placement.base).inverse()
        candidates = [(int(pair.first), int(pair.second)) for pair in base.geometry.collisionPairs]
        candidates += self._attach(among.held)
        own = len(self._names)
        self._held = range(len(base.links), own)
        at_tool = tool_joint(self.model, self._solver)
        moves_along = [shape.parentJoint == at_tool for shape in self._geometry.geometryObjects]
        self._at_tool = tuple(index for index in range(own) if moves_along[index] or index in self._held)
        candidates += self._add_obstacles(among.outside)
        allowed = allowed_collision_matrix(scene, self._names[:own], self._names)
        pairs = [pair for pair in candidates if not allowed[pair]]
        self.bound_m = motion_bound(self._solver, self._geometry)
        self.step_m = min(max(_STEP_SHARE * float(self.bound_m.max()), _LEAST_STEP_M), _MOST_STEP_M)
        margins = [margin_m if second >= own else 0.0 for _, second in pairs]
        self._checks = PairChecks(self._solver, self._geometry, self._names, pairs, margins)
        self._voxels: Voxels | None = None
        self._octree: PairChecks | None = None
        self._may_meet: Callable[[Array], bool] = _always

    def seeing(self, voxels: Voxels, *, may_meet: Callable[[Array], bool] | None = None) -> ExactChecker:
        """Return a checker that also checks the voxels of the cameras, named `occupancy`; it shares the rest.

        Creates its octree at first use. `may_meet` may return False for configurations (n,) that are certainly
        farther than the margin from every occupied voxel: an octree check takes longer than all others.
        """
        other = copy(self)
        other._voxels, other._octree = voxels, None
        other._may_meet = may_meet or _always
        return other

    @property
    def dof(self) -> int:
        """Number of arm joints n."""
        return self.model.dof

    @property
    def first_moving_link(self) -> str:
        """The link after the first joint."""
        frames = self._solver.frames
        return next(str(f.name) for f in frames if f.parentJoint == 1 and f.type == pin.FrameType.BODY)

    def in_collision(self, joints: Array) -> bool:
        """Return whether any pair touches at `joints`, shape (n,)."""
        return any(checks.in_collision(joints) for checks in self._checks_at(joints))

    def touches_known_geometry(self, joints: Array) -> bool:
        """Return whether any pair except those with `occupancy` touches at `joints`, shape (n,)."""
        return self._checks.in_collision(joints)

    def colliding_pairs(self, joints: Array) -> tuple[NamePair, ...]:
        """Return the names of all pairs that touch at `joints`, shape (n,), each once."""
        return tuple(pair for checks in self._checks_at(joints) for pair in checks.colliding_pairs(joints))

    @property
    def looked_at(self) -> frozenset[frozenset[str]]:
        """The pairs of names that must not touch."""
        return frozenset(frozenset(pair) for checks in self.checks for pair in checks.pairs)

    def held_points(self, joints: Array) -> Array:
        """Return the corners of the bounding boxes of the held parts at `joints` (n,), shape (points, 3)."""
        return self._corners(joints, self._held)

    @property
    def tool_bodies(self) -> frozenset[str]:
        """The names of the links that move with the tool link, and of the parts attached to the arm."""
        return frozenset(self._names[index] for index in self._at_tool)

    def tool_points(self, joints: Array) -> Array:
        """Return the corners of the bounding boxes of the tool bodies at `joints` (n,), shape (points, 3)."""
        return self._corners(joints, self._at_tool)

    def _corners(self, joints: Array, shapes: Iterable[int]) -> Array:
        data = self._solver.createData()
        pin.forwardKinematics(self._solver, data, joints)
        corners = [np.empty((0, 3))]
        for index in shapes:
            shape = self._geometry.geometryObjects[index]
            at = data.oMi[shape.parentJoint] * shape.placement
            corners.append(corners_of(shape.geometry) @ at.rotation.T + at.translation)
        return np.vstack(corners)

    def depth(self, joints: Array, pair: frozenset[str]) -> float:
        """Return the penetration depth of two objects, by name, at `joints` (n,), meters; negative if apart."""
        return -min(
            (
                float(distance)
                for checks in self.checks
                for one, distance in zip(checks.pairs, checks.distances(joints), strict=True)
                if frozenset(one) == pair
            ),
            default=math.inf,
        )

    def clearance(self, joints: Array) -> Clearance:
        """Return the smallest distance of a pair that must not touch, at `joints` (n,), without the margin."""
        nearest_pair = Clearance(distance_m=math.inf, pair=("", ""))
        for checks in self.checks:
            distances = checks.distances(joints)
            if len(distances) and float(distances.min()) < nearest_pair.distance_m:
                nearest = int(np.argmin(distances))
                nearest_pair = Clearance(distance_m=float(distances[nearest]), pair=checks.pairs[nearest])
        return nearest_pair

    @property
    def checks(self) -> tuple[PairChecks, ...]:
        """The checked pairs: those of the scene, and those with `occupancy`."""
        if self._voxels is None:
            return (self._checks,)
        if self._octree is None:
            self._octree = self._octree_checks(self._voxels)
        return self._checks, self._octree

    def checks_along(self, rows: Array) -> tuple[PairChecks, ...]:
        """Return the checks that apply at any of `rows` (k, n): `occupancy` only if the arm may be near it."""
        if self._voxels is None or not any(self._may_meet(row) for row in rows):
            return (self._checks,)
        return self.checks

    def first_collision(
        self, path: Array, *, step_m: float | None = None, query: CollisionQuery | None = None
    ) -> PathCollision | None:
        """Return the first collision on a path of straight joint lines, shape (waypoints, n); None if it is free.

        No point of the arm moves farther than `step_m` between two checked configurations;
        by default the checker's own `step_m`, 1.6 % of the arm's reach but at least 1 cm and at most 4 cm.
        `query` is queried in place of the checker itself, configuration after configuration.
        """
        query = query or self
        if len(path) and query.in_collision(path[0]):
            return PathCollision(segment=0, share=0.0, joints=path[0], pairs=query.colliding_pairs(path[0]))
        for segment in range(len(path) - 1):
            start, delta = path[segment], path[segment + 1] - path[segment]
            count = self.steps(path[segment], path[segment + 1], step_m=step_m)
            for i in range(1, count + 1):
                joints = start + delta * (i / count)
                if query.in_collision(joints):
                    return PathCollision(
                        segment=segment, share=i / count, joints=joints, pairs=query.colliding_pairs(joints)
                    )
        return None

    def is_edge_free(self, start: Array, end: Array) -> bool:
        """Return whether the straight joint line is free of collisions; does not check `start`.

        Checks the end first, then the middle, then ever finer steps, to find obstacles early.
        """
        count = self.steps(start, end)
        delta = end - start
        return not any(self.in_collision(start + delta * (i / count)) for i in _ever_finer(count))

    def steps(self, start: Array, end: Array, *, step_m: float | None = None) -> int:
        """Return the number of steps of a straight joint line in which no point moves farther than `step_m`."""
        return max(1, math.ceil(float(np.abs(end - start) @ self.bound_m) / (step_m or self.step_m)))

    def _checks_at(self, joints: Array) -> Iterator[PairChecks]:
        """Yield the checks that apply at `joints`: those with `occupancy` only if the arm may be near it."""
        yield self._checks
        if self._voxels is not None and self._may_meet(joints):
            yield from self.checks[1:]

    def _attach(self, parts: tuple[AttachedPart, ...]) -> list[tuple[int, int]]:
        pairs: list[tuple[int, int]] = []
        for part in parts:
            frame = held_frame(self.model, self._solver, part)
            own = range(len(self._names))
            for solid in part.solids:
                at = frame.placement * placement(
                    RigidTransform.from_pose(part.pose).then(RigidTransform.from_pose(solid.pose))
                )
                index = self._add(part.name, frame.parentJoint, at, cached_shape(solid.shape, part.name))
                # Links that move with the part, such as the tool that holds it, cannot collide with it.
                pairs += [
                    (other, index)
                    for other in own
                    if self._geometry.geometryObjects[other].parentJoint != frame.parentJoint
                ]
        return pairs

    def _add_obstacles(self, outside: tuple[PlacedSolid, ...]) -> list[tuple[int, int]]:
        moving = [i for i, g in enumerate(self._geometry.geometryObjects) if g.parentJoint > 0]
        added = [self._add(solid.name, 0, placement(self._world.then(solid.pose)), solid.ready) for solid in outside]
        return [(own, index) for index in added for own in moving]

    def _octree_checks(self, voxels: Voxels) -> PairChecks:
        geometry, names = pin.GeometryModel(), list[str]()
        for name, shape in zip(self._names, self._geometry.geometryObjects, strict=True):
            if shape.parentJoint > 0 and not self.scene.may_touch(name, OCCUPANCY):
                geometry.addGeometryObject(shape)
                names.append(name)
        at = placement(self._world.then(voxels.corner))
        index = int(geometry.addGeometryObject(pin.GeometryObject(OCCUPANCY, 0, at, voxels.octree)))
        pairs = [(own, index) for own in range(len(names))]
        return PairChecks(self._solver, geometry, [*names, OCCUPANCY], pairs, [self.margin_m] * len(names))

    def _add(self, name: str, joint: int, at: Any, ready: CachedShape) -> int:
        self._names.append(name)
        unique = f"{name}#{len(self._names)}"
        return int(self._geometry.addGeometryObject(pin.GeometryObject(unique, joint, at, ready.geometry)))


def _always(_joints: Array) -> bool:
    return True


def _ever_finer(count: int) -> Iterator[int]:
    """Yield 1 … `count`: the last first, then halves, then quarters."""
    yield count
    stride = 1 << max(0, (count - 1).bit_length())
    while stride > 1:
        yield from range(stride // 2, count, stride)
        stride //= 2
