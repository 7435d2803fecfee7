"""Poses around a known tip give it back; noise shifts it by a bounded amount; alike orientations are refused."""

from __future__ import annotations

import math
import random

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from engine.errors import Cause
from engine.messages import Pose, Quaternion, Vector3
from engine.messages.pose_algebra import compose_rotations, rotate_vector
from states.calibration.tool_point_regression import ToolPointEstimate, estimate_tool_point

LEAST_RAD = 0.35
VECTORS = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
ROTATIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda raw: math.hypot(*raw) > 0.1)


def unit(raw: tuple[float, ...]) -> Quaternion:
    """The rotation of a quaternion of any length."""
    x, y, z, w = (value / math.hypot(*raw) for value in raw)
    return (x, y, z, w)


def turned(axis: Vector3, angle_rad: float) -> Quaternion:
    """A rotation about an axis."""
    x, y, z = (value * math.sin(angle_rad / 2) / math.hypot(*axis) for value in axis)
    return (x, y, z, math.cos(angle_rad / 2))


def touching(point: Vector3, tip: Vector3, rotation: Quaternion, *, off: Vector3 = (0.0, 0.0, 0.0)) -> Pose:
    """The pose of a tool link whose tip touches a point, up to an error."""
    x, y, z = (p - r + e for p, r, e in zip(point, rotate_vector(rotation, tip), off, strict=True))
    return Pose(xyz=(x, y, z), xyzw=rotation)


def estimated(poses: list[Pose]) -> ToolPointEstimate | Cause:
    """What the poses give."""
    return estimate_tool_point(poses, least_tilt_rad=LEAST_RAD, where="left")


@settings(deadline=None)
@given(VECTORS, VECTORS, st.lists(ROTATIONS, min_size=4, max_size=9))
def test_without_noise_the_tip_and_the_point_are_exact(point: Vector3, tip: Vector3, raw: list[Quaternion]) -> None:
    estimate = estimated([touching(point, tip, unit(each)) for each in raw])
    assume(isinstance(estimate, ToolPointEstimate))
    assert isinstance(estimate, ToolPointEstimate)
    assert estimate.tool_xyz_m == pytest.approx(tip, abs=1e-9)
    assert estimate.point_m == pytest.approx(point, abs=1e-9)
    assert max(estimate.residuals_m) < 1e-9
    assert estimate.tilt_rad >= LEAST_RAD


@settings(deadline=None)
@given(VECTORS, st.lists(ROTATIONS, min_size=4, max_size=9), st.integers(0, 1000))
def test_noise_shifts_the_tip_at_most_by_its_amount_over_the_tilt(
    tip: Vector3, raw: list[Quaternion], seed: int
) -> None:
    """The least eigenvalue of the normal matrix is at least half of the squared chord of the tilt."""
    draw, noise_m = random.Random(seed), 0.0003
    errors = [tuple(draw.uniform(-noise_m, noise_m) for _ in range(3)) for _ in raw]
    poses = [
        touching((0.1, 0.2, 0.3), tip, unit(each), off=(x, y, z))
        for each, (x, y, z) in zip(raw, errors, strict=True)
    ]  # fmt: skip
    estimate = estimated(poses)
    assume(isinstance(estimate, ToolPointEstimate))
    assert isinstance(estimate, ToolPointEstimate)
    whole_m = math.sqrt(sum(math.hypot(*error) ** 2 for error in errors))
    least_eigenvalue = (2.0 * math.sin(estimate.tilt_rad / 2.0)) ** 2 / 2.0
    assert math.dist(estimate.tool_xyz_m, tip) <= whole_m / math.sqrt(least_eigenvalue) + 1e-12
    assert math.sqrt(sum(each**2 for each in estimate.residuals_m)) <= whole_m + 1e-12


@settings(deadline=None)
@given(VECTORS.filter(lambda axis: math.hypot(*axis) > 0.1), ROTATIONS, st.lists(st.floats(-3.0, 3.0), min_size=4))
def test_turns_about_one_axis_are_refused_with_that_axis(axis: Vector3, raw: Quaternion, angles: list[float]) -> None:
    """The tip could lie anywhere along it."""
    poses = [
        touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), compose_rotations(unit(raw), turned(axis, angle)))
        for angle in angles
    ]
    refused = estimated(poses)
    assert isinstance(refused, Cause)
    assert "tilted by 0.0 deg at most between two poses, at least 20.1 deg needed" in refused.message
    (compared,) = refused.compared
    assert compared.measured == pytest.approx(0.0, abs=1e-4)
    assert compared.least == pytest.approx(math.degrees(LEAST_RAD))


@settings(deadline=None)
@given(st.lists(ROTATIONS, min_size=4, max_size=6))
def test_poses_are_refused_exactly_below_the_least_tilt(raw: list[Quaternion]) -> None:
    poses = [touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), unit(each)) for each in raw]
    estimate = estimate_tool_point(poses, least_tilt_rad=0.01, where="left")
    assume(isinstance(estimate, ToolPointEstimate))
    assert isinstance(estimate, ToolPointEstimate)
    least_rad = estimate.tilt_rad
    assert estimate_tool_point(poses, least_tilt_rad=least_rad * 0.999, where="left") == estimate
    refused = estimate_tool_point(poses, least_tilt_rad=least_rad * 1.001, where="left")
    assert isinstance(refused, Cause)
    assert refused.compared[0].measured == pytest.approx(math.degrees(least_rad))


def test_the_refusal_names_axis_and_angle() -> None:
    poses = [
        touching((0.5, 0.0, 0.2), (0.0, 0.0, 0.1), turned((0.0, 0.0, 1.0), angle)) for angle in (0.0, 0.5, 1.0, 1.5)
    ]
    refused = estimated(poses)
    assert isinstance(refused, Cause)
    assert refused.message == (
        "the orientations are too alike: the axis (0.00, 0.00, 1.00) of the tool link is tilted by 0.0 deg"
        " at most between two poses, at least 20.1 deg needed"
    )


def test_three_poses_are_too_few() -> None:
    pose = touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0))
    refused = estimated([pose] * 3)
    assert isinstance(refused, Cause)
    assert refused.message == "3 poses are given, at least 4 needed"


def test_poses_in_different_frames_are_refused() -> None:
    pose = touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0))
    other = Pose(xyz=pose.xyz, xyzw=pose.xyzw, frame="left/panda_link0")
    refused = estimated([pose, pose, pose, other])
    assert isinstance(refused, Cause)
    assert refused.message == "the poses are in different frames: left/panda_link0, world"


@pytest.mark.parametrize(
    "broken", [Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 0.0)), Pose(xyz=(math.nan, 0.0, 0.0))]
)
def test_numbers_that_are_no_pose_are_refused_with_their_place(broken: Pose) -> None:
    pose = touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0))
    refused = estimated([pose, broken, pose, pose])
    assert isinstance(refused, Cause)
    assert refused.message == "pose 2 has no position or no orientation"


def test_one_pose_that_misses_the_point_has_the_greatest_residual() -> None:
    turns = [turned(axis, angle) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)) for angle in (-0.7, 0.7)]
    turns.append(turned((1.0, 1.0, 0.0), 0.3))
    poses = [touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), turn) for turn in turns]
    poses[1] = touching((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), turns[1], off=(0.0, 0.0, 0.004))
    estimate = estimated(poses)
    assert isinstance(estimate, ToolPointEstimate)
    assert estimate.residuals_m.index(max(estimate.residuals_m)) == 1
    assert 0.001 < max(estimate.residuals_m) < 0.004
