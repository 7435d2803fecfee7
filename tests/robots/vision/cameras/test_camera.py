"""Tests of the numbers of a camera: where it looks, and that projection and back-projection undo each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.document.cell_perception import DepthCamera
from engine.errors import CellError
from engine.messages import Vector3
from engine.messages.sensing import CameraIntrinsics, DepthImage
from robots.model.transform import RigidTransform
from robots.vision.cameras.camera import (
    camera_of,
    depths,
    directions,
    optical_frame_pose,
    pinhole,
    pixels,
    reduced,
)
from tests.robots.vision.watched_cell import points_seen

SIZES = st.tuples(st.integers(16, 200), st.integers(16, 200))
FIELDS = st.floats(0.1, 2.5)
PLACES = st.tuples(*(st.floats(-5.0, 5.0) for _ in range(3)))


def apart(first: Vector3, second: Vector3) -> bool:
    return math.dist(first, second) > 1e-3


@given(SIZES, FIELDS, st.data())
def test_a_pixel_projects_to_where_it_came_from(size: tuple[int, int], field: float, data: st.DataObject) -> None:
    lens = pinhole(size, field)
    u, v = data.draw(st.integers(0, size[0] - 1)), data.draw(st.integers(0, size[1] - 1))
    depth = data.draw(st.floats(0.01, 100.0))
    point = directions(lens)[v * size[0] + u] * depth
    assert pixels(lens, point[None])[0] == pytest.approx((u, v), abs=1e-6)


@given(SIZES, FIELDS)
def test_the_height_of_an_image_spans_the_field_of_view(size: tuple[int, int], field: float) -> None:
    lens = pinhole(size, field)
    edges = np.array([[0.0, -math.tan(field / 2.0), 1.0], [0.0, math.tan(field / 2.0), 1.0]])
    assert pixels(lens, edges)[:, 1] == pytest.approx([-0.5, size[1] - 0.5], abs=1e-6)


@given(PLACES, PLACES)
def test_a_camera_looks_at_its_target_with_up_being_up(at: Vector3, target: Vector3) -> None:
    if not apart(at, target):
        return
    pose = RigidTransform.from_pose(optical_frame_pose(at, target))
    rotation = pose.rotation
    assert rotation.T @ rotation == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    ahead = np.subtract(target, at) / math.dist(at, target)
    assert rotation[:, 2] == pytest.approx(ahead, abs=1e-7)
    # Down in the image never points up, and the horizon is level where there is one.
    assert rotation[2, 1] <= 1e-6
    if math.hypot(ahead[0], ahead[1]) > 1e-3:
        assert rotation[2, 0] == pytest.approx(0.0, abs=1e-6)


def test_a_camera_that_looks_straight_down_has_y_up_in_its_image() -> None:
    rotation = RigidTransform.from_pose(optical_frame_pose((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))).rotation
    assert rotation == pytest.approx(np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]))


@settings(deadline=None, max_examples=40)
@given(st.tuples(st.integers(16, 40), st.integers(16, 40)), FIELDS, PLACES, PLACES, st.integers(0, 2**31))
def test_the_points_of_an_image_are_measured_where_they_are_seen(
    size: tuple[int, int], field: float, at: Vector3, target: Vector3, seed: int
) -> None:
    if not apart(at, target):
        return
    lens, pose = pinhole(size, field), optical_frame_pose(at, target)
    depth = np.random.default_rng(seed).uniform(0.1, 5.0, size=(size[1], size[0])).astype(np.float32)
    image = DepthImage(time_s=0.0, camera="one", intrinsics=lens, pose=pose, depth_m=depth.tobytes())
    rigid = RigidTransform.from_pose(pose)
    seen = (points_seen(image) - rigid.xyz) @ rigid.rotation
    assert seen[:, 2] == pytest.approx(depth.ravel(), abs=1e-5)
    v, u = np.divmod(np.arange(depth.size), size[0])
    assert pixels(lens, seen) == pytest.approx(np.column_stack((u, v)), abs=1e-3)


@pytest.mark.parametrize("step", [2, 4, 8])
def test_a_smaller_image_looks_along_the_middle_of_the_pixels_that_it_stands_for(step: int) -> None:
    whole, small = pinhole((640, 480), 1.0), reduced(pinhole((640, 480), 1.0), step)
    block = directions(whole).reshape(480, 640, 3)[:step, step : 2 * step].reshape(-1, 3).mean(axis=0)
    assert directions(small).reshape(480 // step, 640 // step, 3)[0, 1] == pytest.approx(block, abs=1e-9)


def test_a_camera_cannot_look_at_itself_nor_have_an_empty_range() -> None:
    with pytest.raises(CellError, match="camera top: `look_at` is the position of the camera itself"):
        camera_of("top", DepthCamera(at=(1.0, 0.0, 0.0), look_at=(1.0, 0.0, 0.0)))
    with pytest.raises(CellError, match="camera top: the range from 2 to 1 m is empty"):
        camera_of("top", DepthCamera(at=(1.0, 0.0, 0.0), look_at=(0.0, 0.0, 0.0), range_m=(2.0, 1.0)))


def test_an_image_with_too_few_bytes_is_none() -> None:
    lens = CameraIntrinsics(width_px=4, height_px=2, fx_px=1.0, fy_px=1.0, cx_px=0.0, cy_px=0.0)
    pose = optical_frame_pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    image = DepthImage(time_s=0.0, camera="top", intrinsics=lens, pose=pose, depth_m=b"1234")
    with pytest.raises(CellError, match="4 bytes are not an image of 4 x 2 pixels"):
        depths(image)
