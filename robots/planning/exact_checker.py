"""Tells exactly what an arm touches in a planning scene: convex shapes, all links, held parts and obstacles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.model.rigid import Rigid
from robots.planning.arm_shapes import arm_shapes
from robots.planning.coal_shapes import coal_shape, pin, placement
from robots.planning.motion_bound import motion_bound
from robots.planning.scene import AttachedPart, NamePair, PlanningScene
from robots.planning.surroundings import held_frame, surroundings
from robots.port import Array

# Coal's test without contacts ends at its tolerance and then calls cylinders that are millimetres deep in one
# another free; a margin above that tolerance makes it certain.
_TOUCHING_M = 1e-5
_STEP_SHARE, _LEAST_STEP_M, _MOST_STEP_M = 0.016, 0.01, 0.04


@dataclass(frozen=True, kw_only=True)
class Clearance:
    """The smallest distance of two things that must not touch (0 or less where they do), and their names."""

    distance_m: float
    pair: NamePair


@dataclass(frozen=True, kw_only=True)
class Hit:
    """Where a way first touches: after waypoint `segment`, at `share` of the way to the next, at `joints` (n,)."""

    segment: int
    share: float
    joints: Array
    pairs: tuple[NamePair, ...]


class ExactChecker:
    """One arm of a scene against itself, what it holds and everything else.

    Shapes are those of the URDF, meshes as their convex hulls. What cannot move against each other is
    not looked at. It holds the interpreter lock while it works and serves one thread at a time.

    Args:
        scene: The scene; later changes need another checker (a millisecond).
        arm: Name of the arm that moves.
        margin_m: Nearer than this counts as touching an obstacle or another arm; the arm itself has no margin.

    Raises:
        CellError: there is no such arm, or a shape or model is wrong.
    """

    def __init__(self, scene: PlanningScene, arm: str, *, margin_m: float = 0.0) -> None:
        placed = scene.arm(arm)
        self.arm = arm
        self.scene = scene
        self.model = placed.placement.robot()
        base = arm_shapes(self.model, placed.tool_joints)
        # Pinocchio's managers keep none of these alive: this object does.
        self._solver = base.solver
        self._geometry = base.geometry.copy()
        self._names = [f"{arm}/{link}" for link in base.links]
        self._outside: list[int] = []
        self._attach(tuple(part for part in scene.attached if part.arm == arm))
        self._surround(Rigid.from_pose(placed.placement.base).inverse())
        self._drop_allowed()
        self.bound_m = motion_bound(self._solver, self._geometry)
        self.step_m = min(max(_STEP_SHARE * float(self.bound_m.max()), _LEAST_STEP_M), _MOST_STEP_M)
        self._data, self._geometry_data = self._solver.createData(), self._geometry.createData()
        for index in range(len(self._geometry.collisionPairs)):
            self._geometry_data.collisionRequests[index].security_margin = _TOUCHING_M
        for index in self._outside:
            self._geometry_data.collisionRequests[index].security_margin = max(margin_m, _TOUCHING_M)
        self._manager = pin.BroadPhaseManager_DynamicAABBTreeCollisionManager(
            self._solver, self._geometry, self._geometry_data
        )

    @property
    def dof(self) -> int:
        """Number of arm joints n."""
        return self.model.dof

    @property
    def first_moving_link(self) -> str:
        """The link behind the first joint."""
        frames = self._solver.frames
        return next(str(f.name) for f in frames if f.parentJoint == 1 and f.type == pin.FrameType.BODY)

    def in_collision(self, joints: Array) -> bool:
        """Return whether anything touches at `joints`, shape (n,)."""
        return bool(pin.computeCollisions(self._solver, self._data, self._manager, joints, True))

    def colliding_pairs(self, joints: Array) -> tuple[NamePair, ...]:
        """Return the names of all pairs that touch at `joints`, shape (n,), each once."""
        pin.computeCollisions(self._solver, self._data, self._geometry, self._geometry_data, joints, False)
        found: dict[NamePair, None] = {}
        for index, pair in enumerate(self._geometry.collisionPairs):
            if self._geometry_data.collisionResults[index].isCollision():
                found[self._names_of(pair)] = None
        return tuple(found)

    @property
    def looked_at(self) -> frozenset[frozenset[str]]:
        """The pairs of names that must not touch."""
        pairs = self._geometry.collisionPairs
        return frozenset(frozenset(self._names_of(pair)) for pair in pairs)

    def depth(self, joints: Array, pair: frozenset[str]) -> float:
        """Return how deep two things, by name, are in one another at `joints`, shape (n,), metres; negative apart."""
        pin.computeDistances(self._solver, self._data, self._geometry, self._geometry_data, joints)
        found = [
            float(result.min_distance)
            for result, one in zip(self._geometry_data.distanceResults, self._geometry.collisionPairs, strict=True)
            if frozenset(self._names_of(one)) == pair
        ]
        return -min(found, default=math.inf)

    def clearance(self, joints: Array) -> Clearance:
        """Return the smallest distance of a pair that must not touch, at `joints` (n,); the margin is not in it."""
        pin.computeDistances(self._solver, self._data, self._geometry, self._geometry_data, joints)
        distances: list[float] = [result.min_distance for result in self._geometry_data.distanceResults]
        if not distances:
            return Clearance(distance_m=math.inf, pair=("", ""))
        nearest = int(np.argmin(distances))
        pair = self._geometry.collisionPairs[nearest]
        return Clearance(distance_m=float(distances[nearest]), pair=self._names_of(pair))

    def first_collision(self, path: Array, *, step_m: float | None = None) -> Hit | None:
        """Return where a way of straight joint lines, shape (waypoints, n), first touches something; None if nowhere.

        No point of the arm moves farther than `step_m` between two configurations that are looked at;
        by default the checker's own `step_m`, 1.6 % of the arm's reach but 1 cm at least and 4 cm at most.
        """
        if len(path) and self.in_collision(path[0]):
            return Hit(segment=0, share=0.0, joints=path[0], pairs=self.colliding_pairs(path[0]))
        for segment in range(len(path) - 1):
            start, way = path[segment], path[segment + 1] - path[segment]
            count = self.steps(path[segment], path[segment + 1], step_m=step_m)
            for i in range(1, count + 1):
                joints = start + way * (i / count)
                if self.in_collision(joints):
                    return Hit(segment=segment, share=i / count, joints=joints, pairs=self.colliding_pairs(joints))
        return None

    def is_edge_free(self, start: Array, end: Array) -> bool:
        """Return whether the straight joint line touches nothing; `start` is not looked at.

        The end first, then the middle, then ever finer: what is in the way is met early.
        """
        count = self.steps(start, end)
        way = end - start
        return not any(self.in_collision(start + way * (i / count)) for i in _ever_finer(count))

    def steps(self, start: Array, end: Array, *, step_m: float | None = None) -> int:
        """Return into how many parts a straight joint line is cut so that no point moves farther than `step_m`."""
        return max(1, math.ceil(float(np.abs(end - start) @ self.bound_m) / (step_m or self.step_m)))

    def _names_of(self, pair: Any) -> NamePair:
        return self._names[int(pair.first)], self._names[int(pair.second)]

    def _attach(self, parts: tuple[AttachedPart, ...]) -> None:
        for part in parts:
            frame = held_frame(self.model, self._solver, part)
            own = range(len(self._names))
            for solid in part.solids:
                at = frame.placement * placement(Rigid.from_pose(part.pose).then(Rigid.from_pose(solid.pose)))
                index = self._add(part.name, frame.parentJoint, at, coal_shape(solid.shape, part.name))
                for other in own:
                    # What moves along with the part, as the tool that holds it, cannot hit it.
                    if self._geometry.geometryObjects[other].parentJoint != frame.parentJoint:
                        self._geometry.addCollisionPair(pin.CollisionPair(other, index))

    def _surround(self, world: Rigid) -> None:
        moving = [i for i, g in enumerate(self._geometry.geometryObjects) if g.parentJoint > 0]
        for solid in surroundings(self.scene, self.arm):
            at = placement(world.then(solid.pose))
            index = self._add(solid.name, 0, at, coal_shape(solid.shape, solid.name))
            for own in moving:
                self._geometry.addCollisionPair(pin.CollisionPair(own, index))

    def _add(self, name: str, joint: int, at: Any, shape: Any) -> int:
        self._names.append(name)
        unique = f"{name}#{len(self._names)}"
        return int(self._geometry.addGeometryObject(pin.GeometryObject(unique, joint, at, shape)))

    def _drop_allowed(self) -> None:
        # Copies: the pairs of the model are views that removing would move.
        pairs = [(int(pair.first), int(pair.second)) for pair in self._geometry.collisionPairs]
        verdicts: dict[NamePair, bool] = {}
        kept: list[tuple[int, int]] = []
        for a, b in pairs:
            names = (self._names[a], self._names[b])
            if names not in verdicts:
                verdicts[names] = self.scene.may_touch(*names)
            if not verdicts[names]:
                kept.append((a, b))
        if len(kept) < len(pairs):
            self._geometry.removeAllCollisionPairs()
            for a, b in kept:
                self._geometry.addCollisionPair(pin.CollisionPair(a, b))
        fixed = [g.parentJoint == 0 for g in self._geometry.geometryObjects]
        own = {i for i, name in enumerate(self._names) if name.startswith(f"{self.arm}/")}
        self._outside = [k for k, (_, b) in enumerate(kept) if fixed[b] and b not in own]


def _ever_finer(count: int) -> Iterator[int]:
    """Yield 1 … `count`: the last first, then halves, quarters, …"""
    yield count
    stride = 1 << max(0, (count - 1).bit_length())
    while stride > 1:
        yield from range(stride // 2, count, stride)
        stride //= 2
