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


class RayDepthRenderer:
    """Casts a ray for each pixel of a reduced image; `voxel_m` and `middle_m` determine the reduction."""

    words = "by ray casting, at reduced resolution"

    def __init__(
        self, cell: PhysicsCopy, cameras: tuple[CameraSpec, ...], *, voxel_m: float, middle_m: tuple[float, ...]
    ) -> None:
        self._cell = cell
        self._rays = {camera.name: _Rays(camera, _step(camera, voxel_m, np.array(middle_m))) for camera in cameras}

    def intrinsics(self, camera: CameraSpec) -> CameraIntrinsics:
        """Return the intrinsics of the reduced image."""
        return self._rays[camera.name].intrinsics

    def exact(self, camera: CameraSpec) -> Image:
        """Return the exact depths, (height, width), infinite where nothing is hit."""
        rays = self._rays[camera.name]
        if (camera.pose, camera.intrinsics) != (rays.camera.pose, rays.camera.intrinsics):
            # A camera that stands elsewhere, or has another lens, than it is calibrated.
            rays = _Rays(camera, rays.step)
        hit, distance = first_hits(self._cell, rays.start, rays.flat, reach_m=2.0 * camera.range_m[1])
        depth = np.where(hit >= 0, distance * rays.along, np.inf).astype(np.float32)
        return depth.reshape(rays.intrinsics.height_px, rays.intrinsics.width_px)

    def close(self) -> None:
        """Nothing to release."""


def first_hits(cell: PhysicsCopy, start: Array, along: Array, *, reach_m: float) -> tuple[NDArray[np.int32], Array]:
    """Return the first shape that each ray hits, below 0 for none, and its distance, metres.

    Args:
        cell: The cell in its present state.
        start: Origin of all rays, (3,).
        along: Directions, k unit vectors in the world, flat (3 k,).
        reach_m: Maximum distance.
    """
    count = len(along) // 3
    hit, distance = np.empty(count, dtype=np.int32), np.empty(count)
    mujoco.mj_multiRay(
        cell.model, cell.data, start, along, _SEEN, True, -1, hit, distance, None, count, reach_m
    )  # fmt: skip
    return hit, distance


def _step(camera: CameraSpec, voxel_m: float, middle_m: np.ndarray[Any, Any]) -> int:
    away = max(float(np.linalg.norm(middle_m - camera.pose.xyz)), camera.range_m[0])
    finest = _PITCH_VOXELS * voxel_m * camera.intrinsics.fx_px / away
    return next((step for step in _STEPS if step <= finest), 1)


class _Rays:
    def __init__(self, camera: CameraSpec, step: int) -> None:
        self.camera, self.step = camera, step
        pose = RigidTransform.from_pose(camera.pose)
        self.intrinsics = reduced(camera.intrinsics, step)
        ahead = directions(self.intrinsics)
        length = np.linalg.norm(ahead, axis=1)
        self.start = pose.xyz.copy()
        self.flat = np.ascontiguousarray((ahead / length[:, None]) @ pose.rotation.T).ravel()
        self.along = 1.0 / length
        """depth of a point for each metre along its ray"""
