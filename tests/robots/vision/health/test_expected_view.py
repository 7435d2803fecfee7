"""What of an arm must be visible, against a search through all rays and balls."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.document.cell_perception import DepthCamera
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.vision.cameras.camera import CameraSpec, directions
from robots.vision.health.expected_view import ExpectedView
from tests.robots.vision.watched_cell import cameras

BACKGROUND_M = 4.0


def _camera() -> CameraSpec:
    (camera,) = cameras(front=DepthCamera(at=(0.0, 0.0, 1.0), look_at=(1.0, 0.3, 0.6), size_px=(64, 48)))
    return camera


def _hit(camera: CameraSpec, balls: Array, *, larger_m: float) -> Array:
    """Return which pixels' rays hit one of the balls, larger by that, before the range ends; (pixels,)."""
    pose = RigidTransform.from_pose(camera.pose)
    ahead = directions(camera.intrinsics)
    length = np.linalg.norm(ahead, axis=1)
    units = (ahead / length[:, None]) @ pose.rotation.T
    to_balls = balls[:, :3] - pose.xyz
    middle = units @ to_balls.T
    square = (to_balls**2).sum(axis=1) - middle**2
    radius = balls[:, 3] + larger_m
    half = np.sqrt(np.maximum(radius**2 - square, 0.0))
    front = np.where((square < radius**2) & (middle > 0.0), middle - half, math.inf).min(axis=1)
    return (front > camera.range_m[0] * length) & (front < camera.range_m[1] * length)


@pytest.mark.parametrize("seed", range(8))
def test_the_silhouette_of_an_arm_is_that_of_all_rays(seed: int) -> None:
    """Balls before, beside and behind the camera."""
    camera, random = _camera(), np.random.default_rng(seed)
    view = ExpectedView(camera, camera.intrinsics, ())
    away = random.uniform(-1.5, 2.5, (30, 3)) if seed % 2 else random.normal((0.3, 0.1, -0.1), 0.4, (30, 3))
    radii = np.minimum(random.uniform(0.05, 0.35, 30), np.linalg.norm(away, axis=1) - 0.3).clip(0.01)
    balls = np.column_stack((away + camera.pose.xyz, radii))
    depth = np.full((48, 64), BACKGROUND_M, dtype=np.float32)
    silhouette = view.compare(depth, balls).silhouette
    assert silhouette.any()
    assert (silhouette == _hit(camera, balls, larger_m=0.03)).all()
