"""The geometry of six legs: lengths follow the platform, and what is beyond limits is told with leg and amount."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.hexapods.hexapod_geometry import beyond_limits, leg_lengths_m, legs_at, path_beyond_limits
from engine.document.hexapods.hexapod_spec import HexapodSpec, JointPattern
from engine.document.placement import Placement
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, rotate_vector

HEXAPOD = HexapodSpec(
    base="base",
    platform="platform",
    base_joints=JointPattern(radius_m=0.13, spread_rad=0.4, z_m=0.01),
    platform_joints=JointPattern(radius_m=0.08, spread_rad=0.4, z_m=-0.008),
    length_m=(0.15, 0.23),
    lean_rad=1.0,
    brakes="release",
    grip="grip",
)
HOME = Pose(xyz=(0.0, 0.0, 0.18))
HELD = Pose(xyz=(0.0, 0.0, 0.05), xyzw=(1.0, 0.0, 0.0, 0.0))


def pose_near_home(x: float, y: float, z: float, a: float, b: float, c: float) -> Pose:
    """Return a pose by how far it is from the middle, and how much it is turned."""
    return Placement(xyz=(x, y, 0.18 + z), rpy=(a, b, c)).pose()


lengths, angles = st.floats(-0.05, 0.05), st.floats(-0.5, 0.5)
poses = st.builds(pose_near_home, lengths, lengths, lengths, angles, angles, angles)


def test_all_legs_of_a_level_platform_are_alike() -> None:
    lengths_m = leg_lengths_m(HEXAPOD, HOME)
    assert lengths_m == pytest.approx([lengths_m[0]] * 6)
    # The joints of a leg are 60° less half of both spreads apart, and 0.162 m in height.
    across = 0.13**2 + 0.08**2 - 2 * 0.13 * 0.08 * math.cos(math.pi / 3 - 0.4)
    assert lengths_m[0] == pytest.approx(math.sqrt(across + 0.162**2))


@given(pose=poses)
def test_a_leg_ends_at_its_joint_on_the_platform(pose: Pose) -> None:
    for leg, foot, joint in zip(
        legs_at(HEXAPOD, pose), HEXAPOD.joints_of_base(), HEXAPOD.joints_of_platform(), strict=True
    ):
        x, y, z = rotate_vector(pose.xyzw, joint)
        assert [a + b for a, b in zip(foot, leg, strict=True)] == pytest.approx(
            [x + pose.xyz[0], y + pose.xyz[1], z + pose.xyz[2]], abs=1e-12
        )


@given(pose=poses)
def test_a_third_of_a_turn_about_the_axis_passes_the_lengths_on_by_one_pair(pose: Pose) -> None:
    third = Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, math.sin(math.pi / 3), math.cos(math.pi / 3)))
    back = Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, -third.xyzw[2], third.xyzw[3]))
    before = leg_lengths_m(HEXAPOD, pose)
    after = leg_lengths_m(HEXAPOD, compose_poses(compose_poses(third, pose), back))
    assert after == pytest.approx(before[-2:] + before[:-2], abs=1e-9)


@given(pose=poses)
def test_what_is_beyond_the_limits_is_named_with_leg_and_amount(pose: Pose) -> None:
    """Just the legs whose lengths are outside of the limits are named, with how far they are."""
    told = {
        int(leg): float(mm) for leg, mm in re.findall(r"leg (\d) would be ([\d.]+) mm", beyond_limits(HEXAPOD, pose))
    }
    shortest, longest = HEXAPOD.length_m
    due = {
        leg: 1e3 * max(length - longest, shortest - length)
        for leg, length in enumerate(leg_lengths_m(HEXAPOD, pose), start=1)
        if length > longest or length < shortest
    }
    assert told.keys() == due.keys()
    assert all(abs(told[leg] - due[leg]) <= 0.051 for leg in due)


def test_a_leg_that_leans_too_much_is_named() -> None:
    aside = Pose(xyz=(0.14, 0.0, 0.12))
    assert re.search(r"leg \d would lean [\d.]+° more than 57.3° at the base", beyond_limits(HEXAPOD, aside))


def test_a_line_between_two_poses_within_limits_is_refused_where_it_leaves_them() -> None:
    """With the turn about a tool far above, the platform swings out on its way from one tilt to the other."""
    high = Pose(xyz=(0.0, 0.0, 1.2), xyzw=HELD.xyzw)
    left = Placement(xyz=(0.0, 0.0, 0.19), rpy=(0.0, 0.3, 0.0)).pose()
    right = Placement(xyz=(0.0, 0.0, 0.19), rpy=(0.0, -0.3, 0.0)).pose()
    assert (beyond_limits(HEXAPOD, left), beyond_limits(HEXAPOD, right)) == ("", "")
    assert path_beyond_limits(HEXAPOD, left, right, tool=HELD) == ""
    assert re.match(r"after \d+ % of the line: leg 1 would be", path_beyond_limits(HEXAPOD, left, right, tool=high))


@given(pose=poses)
def test_a_line_to_a_pose_beyond_limits_is_refused(pose: Pose) -> None:
    found = beyond_limits(HEXAPOD, pose)
    if found:
        assert "leg" in path_beyond_limits(HEXAPOD, HOME, pose, tool=HELD)
