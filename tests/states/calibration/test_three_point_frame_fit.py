"""Three points of a known frame give it back; more points in the plane show what does not fit."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import Cause
from engine.messages import Pose, Quaternion, Vector3
from engine.messages.pose_algebra import angle_between_rad, compose_poses
from states.calibration.three_point_frame_fit import FrameFit, fit_frame

VECTORS = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
ROTATIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda raw: math.hypot(*raw) > 0.1)
LENGTHS = st.floats(0.05, 2.0)
ERROR_M = st.floats(-0.0003, 0.0003)
ERRORS = st.lists(st.tuples(ERROR_M, ERROR_M, ERROR_M), min_size=3, max_size=3)


def frame(at: Vector3, raw: Quaternion) -> Pose:
    """A frame with an orientation of any length."""
    x, y, z, w = (value / math.hypot(*raw) for value in raw)
    return Pose(xyz=at, xyzw=(x, y, z, w))


def point(truth: Pose, x: float, y: float, z: float = 0.0) -> Vector3:
    """A point of a frame in the world."""
    return compose_poses(truth, Pose(xyz=(x, y, z))).xyz


def fitted(*points: Vector3) -> FrameFit | Cause:
    """The frame of the points."""
    return fit_frame([Pose(xyz=each) for each in points], least_m=0.05 - 1e-9, where="left")


@settings(deadline=None)
@given(VECTORS, ROTATIONS, LENGTHS, LENGTHS, st.floats(-1.0, 1.0))
def test_the_frame_is_exact(at: Vector3, raw: Quaternion, along_x: float, along_y: float, aside: float) -> None:
    truth = frame(at, raw)
    fit = fitted(at, point(truth, along_x, 0.0), point(truth, aside, along_y), point(truth, 0.3, -0.4))
    assert isinstance(fit, FrameFit)
    assert fit.pose.xyz == at
    assert math.hypot(*fit.pose.xyzw) == pytest.approx(1.0)
    assert angle_between_rad(fit.pose.xyzw, truth.xyzw) < 1e-6
    assert fit.residual_m < 1e-12


@settings(deadline=None)
@given(VECTORS, ROTATIONS, ERRORS)
def test_noise_turns_the_frame_by_its_amount_over_the_distances(
    at: Vector3, raw: Quaternion, errors: list[Vector3]
) -> None:
    """Each axis turns at most by twice the error over 0.2 m, which is 0.52 mm in space."""
    truth = frame(at, raw)
    exact = (at, point(truth, 0.2, 0.0), point(truth, 0.0, 0.2))
    origin, on_x, in_plane = (
        (x + a, y + b, z + c) for (x, y, z), (a, b, c) in zip(exact, errors, strict=True)
    )  # fmt: skip
    fit = fitted(origin, on_x, in_plane)
    assert isinstance(fit, FrameFit)
    assert math.dist(fit.pose.xyz, at) < 0.00052
    assert angle_between_rad(fit.pose.xyzw, truth.xyzw) < 2 * 2 * 0.00052 / 0.2
    assert fit.residual_m == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("on_x", "in_plane", "message"),
    [
        ((0.04, 0.0, 0.0), (0.0, 0.2, 0.0), "the point on x is 40.00 mm from the origin, at least 50.00 mm needed"),
        (
            (0.3, 0.0, 0.0),
            (0.9, 0.01, 0.0),
            "the point in the plane is 10.00 mm from the x axis, at least 50.00 mm needed",
        ),
        (
            (0.0, 0.0, 0.0),
            (0.0, 0.2, 0.0),
            "the point on x is 0.00 mm from the origin, at least 50.00 mm needed",
        ),
        (
            (0.3, 0.0, 0.0),
            (-0.9, 0.0, 0.0),
            "the point in the plane is 0.00 mm from the x axis, at least 50.00 mm needed",
        ),
    ],
)
def test_points_that_are_too_near_are_refused_with_the_distance(on_x: Vector3, in_plane: Vector3, message: str) -> None:
    refused = fitted((0.0, 0.0, 0.0), on_x, in_plane)
    assert isinstance(refused, Cause)
    assert refused.message == message
    (compared,) = refused.compared
    assert (compared.unit, compared.least) == ("mm", pytest.approx(50.0))


def test_two_points_beside_the_plane_share_the_deviation() -> None:
    fit = fitted((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.1, 0.2, 0.001), (0.2, 0.2, -0.001))
    assert isinstance(fit, FrameFit)
    assert fit.pose.xyzw == pytest.approx((0.0, 0.0, 0.0, 1.0), abs=1e-9)
    assert fit.residual_m == pytest.approx(0.001)


def test_y_points_to_the_side_of_the_first_point() -> None:
    """A second point on the other side does not turn the frame over."""
    fit = fitted((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.0, -0.06, 0.0), (0.0, 0.9, 0.0))
    assert isinstance(fit, FrameFit)
    assert angle_between_rad(fit.pose.xyzw, (1.0, 0.0, 0.0, 0.0)) < 1e-9


def test_two_points_are_too_few() -> None:
    refused = fitted((0.0, 0.0, 0.0), (0.3, 0.0, 0.0))
    assert isinstance(refused, Cause)
    assert refused.message == "2 points are given, at least 3 needed"


def test_points_of_different_frames_are_refused() -> None:
    points = [Pose(xyz=(0.0, 0.0, 0.0)), Pose(xyz=(0.3, 0.0, 0.0)), Pose(xyz=(0.0, 0.3, 0.0), frame="left/panda_link0")]
    refused = fit_frame(points, least_m=0.05, where="left")
    assert isinstance(refused, Cause)
    assert refused.message == "the points are in different frames: left/panda_link0, world"
