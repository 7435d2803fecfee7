"""Straight lines of the tool: straight, within limits when accepted, refused with the reason."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import CubicSpline

from engine.errors import RobotError
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.motion import plan_line
from robots.motion.cart_line import spline_trajectory
from robots.motion.min_jerk import min_jerk
from robots.motion.slerp import slerp
from robots.motion.tool_path import KNOT_M, KNOT_RAD, KNOT_S
from robots.port import Array, JointTrajectory
from tests.robots.panda_arm import home, panda_kinematics, panda_model, played

LIMITS = panda_model().limits
vectors = st.tuples(st.floats(-0.35, 0.35), st.floats(-0.35, 0.35), st.floats(-0.35, 0.35)).map(np.array)
turns = st.tuples(st.floats(-0.8, 0.8), st.floats(-0.8, 0.8), st.floats(-0.8, 0.8)).map(np.array)


def shifted(start: Array, move: Array, turn: Array) -> RigidTransform:
    """The tool pose at `start`, moved and turned."""
    pose = panda_kinematics().tool_pose(start)
    return RigidTransform(xyz=pose.xyz + move, xyzw=product(quaternion_of(turn), pose.xyzw))


def plan(move: Array, turn: Array, *, duration_s: float) -> JointTrajectory:
    """Plan from home."""
    return plan_line(panda_kinematics(), home(), shifted(home(), move, turn), duration_s=duration_s)


@settings(max_examples=25, deadline=None)
@given(vectors, turns, st.floats(0.4, 6.0))
def test_an_accepted_line_is_straight_in_time_and_within_every_limit(
    move: Array, turn: Array, duration_s: float
) -> None:
    """Between the samples as well: within 0.5 mm and 2 mrad of minimum jerk on the line and SLERP."""
    end = shifted(home(), move, turn)
    try:
        way = plan(move, turn, duration_s=duration_s)
    except RobotError:
        return
    position, velocity, acceleration = played(way, between=3)
    assert (np.abs(velocity) <= np.array(LIMITS.velocity_rad_s) * (1 + 1e-6)).all()
    assert (np.abs(acceleration) <= np.array(LIMITS.acceleration_rad_s2) * (1 + 1e-6)).all()
    assert (position >= np.array(LIMITS.lower_rad) - 1e-3).all()
    assert (position <= np.array(LIMITS.upper_rad) + 1e-3).all()
    start = panda_kinematics().tool_pose(home())
    intervals = len(way.position_rad) - 1
    passed = (np.arange(intervals)[:, None] + np.linspace(0.0, 1.0, 3)).reshape(-1) / intervals
    for joints, share in zip(position[::5], min_jerk(passed)[::5], strict=True):
        pose = panda_kinematics().tool_pose(joints)
        wanted = RigidTransform(
            xyz=start.xyz + share * (end.xyz - start.xyz), xyzw=slerp(start.xyzw, end.xyzw, float(share))
        )
        assert pose.distance_m(wanted) < 0.0005
        assert pose.angle_rad(wanted) < 0.002


def test_a_line_starts_and_ends_exactly_at_rest() -> None:
    """At the given joints, at the given pose."""
    move = np.array([0.05, 0.2, -0.15])
    way = plan(move, np.zeros(3), duration_s=2.0)
    end = panda_kinematics().tool_pose(way.position_rad[-1])
    assert (way.position_rad[0] == home()).all()
    assert not way.velocity_rad_s[[0, -1]].any()
    assert end.distance_m(shifted(home(), move, np.zeros(3))) < 1e-6
    assert way.duration_s == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("move", "turn", "duration_s"),
    [
        ((0.001, 0.0, 0.0), (0.0, 0.0, 0.0), 6.0),
        ((0.0, 0.2, 0.0), (0.0, 0.0, 0.0), 1.0),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.8), 0.8),
    ],
)
def test_the_joints_are_solved_often_enough_in_time_in_space_and_in_angle(
    move: tuple[float, ...], turn: tuple[float, ...], duration_s: float
) -> None:
    """A slow, a long and a turning line: between two solutions the spline has little to guess."""
    way = plan(np.array(move), np.array(turn), duration_s=duration_s)
    poses = [panda_kinematics().tool_pose(joints) for joints in way.position_rad]
    pairs = list(pairwise(poses))
    assert way.dt_s <= KNOT_S * (1 + 1e-9)
    assert max(one.distance_m(other) for one, other in pairs) <= KNOT_M * 1.001
    assert max(one.angle_rad(other) for one, other in pairs) <= KNOT_RAD * 1.001


def test_a_line_that_is_too_fast_names_joint_time_and_limit_and_the_time_it_asks_for_suffices() -> None:
    """RCL 4.3.4: rejected before execution."""
    move, turn = np.array([0.0, 0.3, -0.2]), np.zeros(3)
    with pytest.raises(RobotError) as refusal:
        plan(move, turn, duration_s=0.3)
    found = re.fullmatch(
        r"(panda_joint\d) would need ([\d.]+) rad/s at t=([\d.]+) s, limit ([\d.]+), to arrive"
        r" after [\d.]+ s \(allow at least ([\d.]+) s\)",
        str(refusal.value),
    )
    assert found, str(refusal.value)
    needed, time_s, limit, least_s = (float(word) for word in found.groups()[1:])
    assert needed > limit
    assert 0.0 < time_s < 0.3
    plan(move, turn, duration_s=least_s)
    with pytest.raises(RobotError):
        plan(move, turn, duration_s=least_s - 0.15)


@pytest.mark.parametrize(
    ("move", "words"),
    [
        ((0.5, 0.0, 0.0), "singularity"),
        ((-0.4, 0.0, 0.0), "panda_joint2 would leave its range"),
    ],
)
def test_a_line_that_cannot_be_followed_says_why(move: tuple[float, float, float], words: str) -> None:
    """Singularities and joint limits on the way."""
    with pytest.raises(RobotError, match=words):
        plan(np.array(move), np.zeros(3), duration_s=5.0)


def test_a_line_on_the_spot_stands_still() -> None:
    """The goal is where the tool is."""
    way = plan(np.zeros(3), np.zeros(3), duration_s=1.0)
    assert np.abs(way.position_rad - home()).max() < 1e-6


def test_half_a_turn_of_the_hand_is_followed() -> None:
    """Pure rotation about the tool's axis, close to where SLERP has two ways."""
    way = plan(np.zeros(3), np.array([0.0, 0.0, 2.0]), duration_s=4.0)
    assert way.position_rad[-1][6] - home()[6] == pytest.approx(-2.0, abs=0.5)


@pytest.mark.parametrize("duration_s", [0.0, -1.0, 1e308, math.nan, math.inf])
def test_a_duration_that_is_no_time_is_refused(duration_s: float) -> None:
    end = RigidTransform(
        xyz=panda_kinematics().tool_pose(home()).xyz + 0.01, xyzw=panda_kinematics().tool_pose(home()).xyzw
    )
    with pytest.raises(RobotError, match="a line cannot take"):
        plan_line(panda_kinematics(), home(), end, duration_s=duration_s)


@given(arrays(np.float64, st.tuples(st.integers(2, 300), st.just(7)), elements=st.floats(-3, 3)), st.floats(0.01, 20))
def test_the_velocity_at_the_knots_is_that_of_the_spline_which_is_flat_at_both_ends(
    knots: Array, duration_s: float
) -> None:
    way = spline_trajectory(knots, duration_s=duration_s)
    times = np.linspace(0.0, duration_s, len(knots))
    wanted = CubicSpline(times, knots, bc_type="clamped")(times, 1)
    np.testing.assert_allclose(way.velocity_rad_s, wanted, rtol=0, atol=1e-12 * len(knots) / duration_s)
