"""Depth images by ray casting against the collision shapes: no graphics, bit-identical everywhere, slower."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.messages.sensing import CameraIntrinsics
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.sim.physics.physics import mujoco
from robots.vision.cameras.camera import CameraSpec, Image, directions, reduced
from robots.vision.cameras.physics_copy import PhysicsCopy

SEEN_GROUPS = 3
"""Geometry groups below this are visible to cameras; helpers are in groups above."""
_SEEN = np.array([group < SEEN_GROUPS for group in range(6)], dtype=np.uint8)
# With rays farther apart than this share of a voxel, surfaces would have holes that no neighbour fills.
_PITCH_VOXELS = 1.5
_STEPS = (8, 4, 2)
_UNSEEN_GROUP = 5
# Boxes are projected from there on.
_NEAREST_M = 0.01
_CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


class RayDepthRenderer:
    """Casts a ray for each pixel of a reduced image; `voxel_m` and `middle_m` determine the reduction.

    What cannot move is looked at once for each camera; later images cast the rays that pass something that can.
    """

    words = "by ray casting, at reduced resolution"

    def __init__(
        self, cell: PhysicsCopy, cameras: tuple[CameraSpec, ...], *, voxel_m: float, middle_m: tuple[float, ...]
    ) -> None:
        self._cell = cell
        self._moving = _MovingGeoms(cell)
        self._rays = {camera.name: _Rays(camera, _step(camera, voxel_m, np.array(middle_m))) for camera in cameras}
        self._changed: dict[str, _Rays] = {}

    def intrinsics(self, camera: CameraSpec) -> CameraIntrinsics:
        """Return the intrinsics of the reduced image."""
        return self._rays[camera.name].intrinsics

    def exact(self, camera: CameraSpec) -> Image:
        """Return the exact depths, (height, width), infinite where nothing is hit."""
        rays = self._rays[camera.name]
        if not rays.are_of(camera):
            # A camera that stands elsewhere, or has another lens, than it is calibrated.
            changed = self._changed.get(camera.name)
            if changed is None or not changed.are_of(camera):
                changed = self._changed[camera.name] = _Rays(camera, rays.step)
            rays = changed
        reach_m = 2.0 * camera.range_m[1]
        if rays.still_m is None or rays.still_version != self._cell.still_version:
            rays.still_m = self._moving.beyond(rays, reach_m=reach_m)
            rays.still_version = self._cell.still_version
        distance_m = rays.still_m.copy()
        passing = np.flatnonzero(self._moving.passed_by(rays))
        if len(passing):
            distance_m[passing] = np.minimum(
                distance_m[passing], self._moving.distances(rays, passing, reach_m=reach_m)
            )
        depth = (distance_m * rays.along).astype(np.float32)
        return depth.reshape(rays.intrinsics.height_px, rays.intrinsics.width_px)

    def close(self) -> None:
        """Nothing to release."""


def first_hits(
    cell: PhysicsCopy, start: Array, along: Array, *, reach_m: float, still: bool = True
) -> tuple[NDArray[np.int32], Array]:
    """Return the first shape that each ray hits, below 0 for none, and its distance, metres.

    Args:
        cell: The cell in its present state.
        start: Origin of all rays, (3,).
        along: Directions, k unit vectors in the world, flat (3 k,).
        reach_m: Maximum distance.
        still: Whether what cannot move counts.
    """
    count = len(along) // 3
    hit, distance = np.empty(count, dtype=np.int32), np.empty(count)
    mujoco.mj_multiRay(
        cell.model, cell.data, start, along, _SEEN, still, -1, hit, distance, None, count, reach_m
    )  # fmt: skip
    return hit, distance


def _step(camera: CameraSpec, voxel_m: float, middle_m: np.ndarray[Any, Any]) -> int:
    away = max(float(np.linalg.norm(middle_m - camera.pose.xyz)), camera.range_m[0])
    finest = _PITCH_VOXELS * voxel_m * camera.intrinsics.fx_px / away
    return next((step for step in _STEPS if step <= finest), 1)


class _Rays:
    """The rays of one camera; `still_m` (k,) are the distances of what cannot move, None before they are known.

    They hold for this `still_version` of the cell.
    """

    def __init__(self, camera: CameraSpec, step: int) -> None:
        self.camera, self.step = camera, step
        pose = RigidTransform.from_pose(camera.pose)
        self.intrinsics = reduced(camera.intrinsics, step)
        ahead = directions(self.intrinsics)
        length = np.linalg.norm(ahead, axis=1)
        self.start = pose.xyz.copy()
        self.units = np.ascontiguousarray((ahead / length[:, None]) @ pose.rotation.T)
        self.turn = pose.rotation
        self.along = 1.0 / length
        """depth of a point for each metre along its ray"""
        self.still_m: Array | None = None
        self.still_version = 0

    def are_of(self, camera: CameraSpec) -> bool:
        """Return whether the camera stands there, with this lens."""
        return (camera.pose, camera.intrinsics) == (self.camera.pose, self.camera.intrinsics)


class _MovingGeoms:
    """The visible shapes that can move."""

    def __init__(self, cell: PhysicsCopy) -> None:
        self._cell = cell
        model = cell.model
        fixed = model.body_weldid[model.geom_bodyid] == 0
        self._all = np.flatnonzero(~fixed)
        self._seen = np.flatnonzero(~fixed & (model.geom_group < SEEN_GROUPS))
        # Bounding boxes, in the frames of the shapes; a plane has none.
        self._middles: Array = model.geom_aabb[self._seen, :3]
        self._halves: Array = model.geom_aabb[self._seen, 3:]
        self._is_endless = bool((model.geom_rbound[self._seen] == 0.0).any())

    def beyond(self, rays: _Rays, *, reach_m: float) -> Array:
        """Return the distances of what cannot move, infinite for nothing, (k,)."""
        groups = self._cell.model.geom_group
        before = groups.copy()
        groups[self._all] = _UNSEEN_GROUP
        try:
            return _distances(*first_hits(self._cell, rays.start, rays.units.ravel(), reach_m=reach_m))
        finally:
            groups[:] = before

    def passed_by(self, rays: _Rays) -> NDArray[np.bool_]:
        """Return which rays pass the bounding box of a shape, and maybe some beside it, (height, width)."""
        lens = rays.intrinsics
        passed = np.zeros((lens.height_px, lens.width_px), dtype=np.bool_)
        corners = (self._corners() - rays.start) @ rays.turn
        corners = corners[(corners[..., 2] > 0.0).any(axis=1)]
        ahead = corners[..., 2]
        if self._is_endless or (ahead < _NEAREST_M).any():
            passed[:] = True
            return passed
        across = lens.cx_px + lens.fx_px * corners[..., 0] / ahead
        down = lens.cy_px + lens.fy_px * corners[..., 1] / ahead
        low = np.floor((down.min(axis=1), across.min(axis=1)))
        high = np.ceil((down.max(axis=1), across.max(axis=1))) + 1.0
        for top, left, bottom, right in np.vstack((low, high)).clip(0.0, max(passed.shape)).astype(int).T.tolist():
            passed[top:bottom, left:right] = True
        return passed

    def _corners(self) -> Array:
        """Return the corners of the bounding boxes in the world, (shapes, 8, 3)."""
        turns: Array = self._cell.data.geom_xmat[self._seen].reshape(-1, 3, 3)
        corners = self._middles[:, None] + _CORNERS * self._halves[:, None]
        return corners @ turns.transpose(0, 2, 1) + self._cell.data.geom_xpos[self._seen][:, None]

    def distances(self, rays: _Rays, passing: NDArray[np.intp], *, reach_m: float) -> Array:
        """Return the distances of what can move along some rays, infinite for nothing, (m,)."""
        along = rays.units[passing].ravel()
        return _distances(*first_hits(self._cell, rays.start, along, reach_m=reach_m, still=False))


def _distances(hit: NDArray[np.int32], distance: Array) -> Array:
    return np.where(hit >= 0, distance, np.inf)
