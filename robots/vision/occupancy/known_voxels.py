"""The voxels occupied by known obstacles and held parts; computed once per object and pose."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from engine.errors import CellError
from engine.messages.shapes import Obstacle, Solid
from robots.model.transform import RigidTransform
from robots.planning.scene.coal_shapes import coal_shape
from robots.planning.scene.convex_shapes import ConvexSolid, convex_solid, to_frame
from robots.port import Array
from robots.vision.occupancy.occupancy_kernels import BESIDE, INSIDE, NEAR, Bytes
from robots.vision.occupancy.solid_distance import solid_distance
from robots.vision.voxel_box import VoxelBox

# An object that moved less counts as unmoved.
_SAME_M, _SAME_RAD = 1e-4, 1e-3


@dataclass(frozen=True, kw_only=True)
class _Taken:
    """The voxels from `low` to before `high` that an object occupies: `levels` as in `occupancy_kernels`."""

    low: tuple[int, int, int]
    high: tuple[int, int, int]
    levels: Bytes


@dataclass(frozen=True, kw_only=True)
class _Placed:
    solids: tuple[Solid, ...]
    pose: RigidTransform
    taken: tuple[_Taken, ...]


class KnownVoxels:
    """Caches the voxels of objects by name and merges them."""

    def __init__(self, box: VoxelBox) -> None:
        self._box = box
        self._still: dict[str, _Placed] = {}
        self._moving: dict[str, _Placed] = {}
        self._held: dict[str, _Placed] = {}
        self._together: Bytes = np.zeros(box.shape, dtype=np.uint8)

    def set_still(self, obstacles: Iterable[Obstacle]) -> None:
        """Set the static objects; raises CellError for an invalid shape or pose."""
        new = {thing.name: self._placed(self._still, thing, self._box.known_margin_m) for thing in obstacles}
        if new.keys() != self._still.keys() or any(placed is not self._still[name] for name, placed in new.items()):
            self._together[:] = 0
            for placed in new.values():
                _stamp(self._together, placed.taken)
        self._still = new

    def taken(self, moving: Iterable[Obstacle], held: Iterable[Obstacle]) -> Bytes:
        """Return the voxels occupied by static, `moving` and `held` objects, flat.

        Raises:
            CellError: a shape or pose is invalid.
        """
        box = self._box
        self._moving = {thing.name: self._placed(self._moving, thing, box.known_margin_m) for thing in moving}
        self._held = {thing.name: self._placed(self._held, thing, box.robot_margin_m, near=BESIDE) for thing in held}
        levels = self._together.copy()
        for placed in (*self._moving.values(), *self._held.values()):
            _stamp(levels, placed.taken)
        return levels.ravel()

    def _placed(self, known: dict[str, _Placed], thing: Obstacle, margin_m: float, *, near: int = NEAR) -> _Placed:
        try:
            pose, old = RigidTransform.from_pose(thing.pose), known.get(thing.name)
            inner = [RigidTransform.from_pose(solid.pose) for solid in thing.solids]
        except ValueError as error:
            raise CellError(str(error), where=thing.name, hint="give its pose") from error
        if old is not None and old.solids == thing.solids and _same(old.pose, pose):
            return old
        margin_m = max(margin_m, self._box.reach_m)
        for solid in thing.solids:
            # Validates the sizes and names the invalid one.
            coal_shape(solid.shape, thing.name)
        taken = (
            self._taken(convex_solid(solid.shape), pose.then(at), margin_m, near)
            for solid, at in zip(thing.solids, inner, strict=True)
        )
        return _Placed(solids=thing.solids, pose=pose, taken=tuple(one for one in taken if one is not None))

    def _taken(self, solid: ConvexSolid, pose: RigidTransform, margin_m: float, near: int) -> _Taken | None:
        box, (low, high) = self._box, self._bounds(solid, pose, margin_m)
        if any(a >= b for a, b in zip(low, high, strict=True)):
            return None
        points = (box.centres(low, high) - pose.xyz) @ pose.rotation
        distance = solid_distance(solid, points)
        levels = np.where(distance <= 0.0, INSIDE, np.where(distance <= margin_m, near, 0)).astype(np.uint8)
        return _Taken(low=low, high=high, levels=levels.reshape(np.subtract(high, low)))

    def _bounds(
        self, solid: ConvexSolid, pose: RigidTransform, margin_m: float
    ) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
        """Return the voxel bounds, first and last + 1 along each axis, of the solid with its margin."""
        corners = to_frame(pose, _corners(*solid.box()))
        corner, voxel = np.array(self._box.corner_m), self._box.voxel_m
        first = np.floor((corners.min(axis=0) - margin_m - corner) / voxel)
        last = np.ceil((corners.max(axis=0) + margin_m - corner) / voxel)
        a, b, c = np.clip(first, 0, self._box.shape).astype(int).tolist()
        d, e, f = np.clip(last, 0, self._box.shape).astype(int).tolist()
        return (a, b, c), (d, e, f)


def _corners(low: Array, high: Array) -> Array:
    ends = np.stack((low, high))
    return np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def _stamp(levels: Bytes, taken: tuple[_Taken, ...]) -> None:
    for one in taken:
        (a, b, c), (d, e, f) = one.low, one.high
        part = levels[a:d, b:e, c:f]
        np.maximum(part, one.levels, out=part)


def _same(first: RigidTransform, second: RigidTransform) -> bool:
    return first.distance_m(second) < _SAME_M and first.angle_rad(second) < _SAME_RAD
