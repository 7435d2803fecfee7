"""An ideal detector for simulated cameras: it detects the sufficiently visible parts.

It replaces a learned detector and uses the true shapes and poses of the parts. From the image it takes only
the visible share of each part, by ray casting at the camera's resolution: occlusion,
the edge of the image and the camera's range hide a part; light, blur and similarity have no effect. There are
no misclassifications and no false detections.
"""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass

import numpy as np

from engine.document import ObjectDetector
from engine.messages import Pose
from engine.messages.sensing import CameraIntrinsics
from engine.skills.vision import Detection, Detections, Rectangle
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.port import Array
from robots.scene.sim_scene import PartBody
from robots.vision.cameras.camera import CameraSpec, pixels
from robots.vision.cameras.depth_image import frame_number
from robots.vision.cameras.depth_rays import first_hits
from robots.vision.cameras.physics_copy import PhysicsCopy
from robots.vision.detection.visibility import bounding_edges_m, intersects_shape

# For a part that fills the image every second or third pixel suffices.
_MOST_RAYS = 4096


class PartDetector:
    """Detects the parts of a copy of the cell in its present state.

    Args:
        cell: The copy of the cell.
        parts: The parts of its scene.
        seed: Seed of the noise.
    """

    def __init__(self, cell: PhysicsCopy, parts: tuple[PartBody, ...], *, seed: int) -> None:
        self._cell = cell
        self._parts = parts
        self._seed = seed
        self._geoms = {part.name: int(cell.model.geom(part.name).id) for part in parts}

    def detections(self, camera: CameraSpec, detector: ObjectDetector, *, time_s: float) -> Detections:
        """Return the present detections of a camera's detector, most visible first."""
        poses = self._cell.moment(time_s).parts
        found: list[Detection] = []
        for part in self._parts:
            seen = self._seen(camera, part, RigidTransform.from_pose(poses[part.name]))
            if seen is None or seen.pixels < detector.min_pixels or seen.share < detector.min_share:
                continue
            found.append(
                Detection(
                    label=detector.labels.get(part.name, part.name),
                    score=seen.share,
                    pose=self._measured(camera, detector, part.name, poses[part.name], time_s),
                    size_m=bounding_edges_m(part.shape, part.size_m),
                    rectangle_px=seen.rectangle,
                )
            )
        lens = camera.intrinsics
        return Detections(
            camera=camera.name,
            frame=detector.frame,
            frame_pose=detector.frame_at.pose(),
            time_s=time_s,
            detections=tuple(sorted(found, key=lambda each: (-each.score, each.label))),
            image_px=(lens.width_px, lens.height_px),
        )

    def _seen(self, camera: CameraSpec, part: PartBody, pose: RigidTransform) -> _VisiblePixels | None:
        """Return the visible pixels of a part, None if it is invisible."""
        eye = RigidTransform.from_pose(camera.pose)
        rays = _rays_around(camera.intrinsics, eye.inverse().then(pose), bounding_edges_m(part.shape, part.size_m))
        if rays is None:
            return None
        ahead, step = rays
        world = _directions(camera.intrinsics, ahead) @ eye.rotation.T
        inside = intersects_shape(
            part.shape, part.size_m, pose.rotation.T @ (eye.xyz - pose.xyz), world @ pose.rotation
        )
        alone, world = ahead[inside], world[inside]
        if not len(alone):
            return None
        lens, (near, far) = camera.intrinsics, camera.range_m
        # Pixels beyond the edge of the image count as hidden: a larger image would show them.
        framed = ((alone >= -0.5) & (alone < (lens.width_px - 0.5, lens.height_px - 0.5))).all(axis=1)
        depth = self._depths(self._geoms[part.name], eye.xyz, world, far)
        seen = alone[framed & (depth >= near) & (depth <= far)]
        if not len(seen):
            return None
        (left, top), (right, bottom) = seen.min(axis=0).tolist(), seen.max(axis=0).tolist()
        return _VisiblePixels(len(seen) * step * step, len(seen) / len(alone), (left, top, right, bottom))

    def _depths(self, geom: int, start: Array, along: Array, far: float) -> Array:
        """Return the depth at which each ray, scaled to 1 m depth, first hits the part; else infinity."""
        lengths = np.linalg.norm(along, axis=1)
        units = np.ascontiguousarray(along / lengths[:, None]).ravel()
        hit, distance = first_hits(self._cell, start.copy(), units, reach_m=far * float(lengths.max()))
        return np.where(hit == geom, distance / lengths, np.inf)

    def _measured(self, camera: CameraSpec, detector: ObjectDetector, part: str, pose: Pose, time_s: float) -> Pose:
        """Return the pose of a part in the detector's frame, with noise."""
        true = RigidTransform.from_pose(pose)
        if detector.noise_m > 0.0 or detector.noise_rad > 0.0:
            names = (zlib.crc32(name.encode()) for name in (camera.name, part))
            stream = np.random.default_rng([self._seed, *names, frame_number(camera, time_s)])
            off, turn = stream.standard_normal((2, 3))
            true = RigidTransform(
                xyz=true.xyz + off * detector.noise_m,
                xyzw=product(true.xyzw, quaternion_of(turn * detector.noise_rad)),
            )
        return RigidTransform.from_pose(detector.frame_at.pose()).inverse().then(true).to_pose(detector.frame)


@dataclass(frozen=True)
class _VisiblePixels:
    pixels: int
    share: float
    rectangle: Rectangle


def _directions(lens: CameraIntrinsics, at_px: Array) -> Array:
    """Return the points of the pixels (k, 2) at depth 1 m, (k, 3), optical frame."""
    x, y = (at_px[:, 0] - lens.cx_px) / lens.fx_px, (at_px[:, 1] - lens.cy_px) / lens.fy_px
    return np.column_stack((x, y, np.ones(len(at_px))))


def _rays_around(
    lens: CameraIntrinsics, pose: RigidTransform, edges: tuple[float, float, float]
) -> tuple[Array, int] | None:
    """Return the pixels (k, 2) around a box, subsampled by `step` in both directions, and `step`.

    They extend beyond the image where the box does. None if the box, at `pose` in the optical frame, is not
    entirely in front of the camera, or is outside the image.
    """
    signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    corners = (signs * np.array(edges)) @ pose.rotation.T + pose.xyz
    if corners[:, 2].min() <= 0.0:
        return None
    places = pixels(lens, corners)
    low, high = np.floor(places.min(axis=0)), np.ceil(places.max(axis=0))
    if (high < 0.0).any() or (low > (lens.width_px - 1, lens.height_px - 1)).any():
        return None
    width, height = (high - low + 1.0).tolist()
    step = max(1, math.ceil(math.sqrt(width * height / _MOST_RAYS)))
    columns: Array = np.arange(float(low[0]), float(high[0]) + 1.0, step)
    rows: Array = np.arange(float(low[1]), float(high[1]) + 1.0, step)
    across, down = np.meshgrid(columns, rows)
    return np.column_stack((across.ravel(), down.ravel())), step
