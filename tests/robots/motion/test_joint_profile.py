"""Point-to-point joint profiles."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.model.registry import model_by_name
from robots.motion import plan_joints
from robots.port import Array, JointTrajectory
from tests.robots.panda_arm import configurations, home, panda_model, played
from tests.tiers import examples

LIMITS = panda_model().limits
NAMES = panda_model().arm_joints


def plan(start: Array, goal: Array, *, speed: float) -> JointTrajectory:
    """Plan for the Panda."""
    return plan_joints(start, goal, speed=speed, limits=LIMITS, joint_names=NAMES)


@settings(max_examples=examples(30, nightly=120), deadline=None)
@given(configurations(), configurations(), st.floats(0.05, 1.0))
def test_a_profile_starts_and_ends_exactly_at_rest_and_never_exceeds_a_limit(
    start: Array, goal: Array, speed: float
) -> None:
    """Also between the samples, as a port interpolates them."""
    way = plan(start, goal, speed=speed)
    position, velocity, acceleration = played(way, between=3)
    assert (way.position_rad[0] == start).all()
    assert (way.position_rad[-1] == goal).all()
    assert not way.velocity_rad_s[[0, -1]].any()
    assert (position >= np.minimum(start, goal) - 1e-6).all()
    assert (position <= np.maximum(start, goal) + 1e-6).all()
    assert (np.abs(velocity) <= speed * np.array(LIMITS.velocity_rad_s) + 1e-9).all()
    assert (np.abs(acceleration) <= np.array(LIMITS.acceleration_rad_s2)).all()


@settings(max_examples=30, deadline=None)
@given(configurations(), configurations(), st.floats(0.05, 1.0))
def test_all_joints_are_in_phase(start: Array, goal: Array, speed: float) -> None:
    """At any time every joint has done the same share of its way."""
    way = plan(start, goal, speed=speed)
    moved = np.abs(goal - start) > 1e-3
    shares = (way.position_rad - start)[:, moved] / (goal - start)[moved]
    if moved.any():
        assert np.ptp(shares, axis=1).max() < 1e-3


def test_a_long_way_reaches_its_share_of_the_speed_limit_and_keeps_it() -> None:
    """The plateau of the trapezoid."""
    goal = home()
    goal[0] = 2.5
    fastest = plan(home(), goal, speed=0.4).velocity_rad_s[:, 0]
    assert fastest.max() == pytest.approx(0.4 * LIMITS.velocity_rad_s[0], rel=0.01)
    assert (fastest > 0.999 * fastest.max()).mean() > 0.3


def test_half_the_speed_takes_longer() -> None:
    """Speed is a share of the joint speed limits."""
    goal = home() + 0.5
    goal[3] = -1.0
    slow, fast = plan(home(), goal, speed=0.3), plan(home(), goal, speed=0.6)
    assert len(slow.position_rad) * slow.dt_s > 1.6 * len(fast.position_rad) * fast.dt_s


@pytest.mark.parametrize("name", ["panda", "ur10", "irb4600"])
def test_as_it_is_played_a_profile_never_exceeds_the_jerk_limits(name: str) -> None:
    model = model_by_name(name)
    start = np.array(model.home_rad)
    way = plan_joints(start, start + 0.4, speed=1.0, limits=model.limits, joint_names=model.arm_joints)
    playback = TrajectoryPlayback(
        way,
        acceleration_rad_s2=np.array(model.limits.acceleration_rad_s2),
        jerk_rad_s3=np.array(model.limits.jerk_rad_s3),
    )
    positions = [start] * 3
    while not playback.at_end:
        playback.step(0.001, target_pace=1.0)
        positions.append(playback.position.copy())
    jerk = np.diff(np.array([*positions, *positions[-1:] * 3]), 3, axis=0) / 1e-9
    assert (np.abs(jerk) <= np.array(model.limits.jerk_rad_s3) * 1.02).all()


def test_standing_still_is_a_motion_too() -> None:
    """A goal that is reached already."""
    way = plan(home(), home(), speed=0.5)
    assert (way.position_rad == home()).all()


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ((0.0,) * 6, "the goal has 6 joints (this arm has 7)"),
        ((0.0, 0.0, 0.0, 0.14, 0.0, 0.0, 0.0), "panda_joint4 cannot go to 0.1400 rad (its range is -3.0718"),
        ((math.nan, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0), "panda_joint1 cannot go to nan rad"),
    ],
)
def test_a_goal_that_cannot_be_is_refused_with_the_joint(goal: tuple[float, ...], message: str) -> None:
    """Before any profile is made."""
    with pytest.raises(RobotError) as refusal:
        plan(home(), np.array(goal), speed=0.5)
    assert str(refusal.value).startswith(message)


def test_where_a_joint_was_measured_at_its_limit_it_can_go_again() -> None:
    """A loaded joint stands a little beyond the limit; the motion goes to the limit itself."""
    goal = home()
    goal[3] = LIMITS.upper_rad[3] + 5e-4
    assert plan(home(), goal, speed=0.5).position_rad[-1, 3] == LIMITS.upper_rad[3]
    goal[3] += 1e-3
    with pytest.raises(RobotError, match="panda_joint4 cannot go to"):
        plan(home(), goal, speed=0.5)


def test_the_slowest_motion_has_no_more_samples_than_a_long_one() -> None:
    model = panda_model()
    way = plan_joints(home(), home() + 0.3, speed=1e-5, limits=model.limits, joint_names=model.arm_joints)
    _, velocity, acceleration = played(way, between=3)
    assert len(way.position_rad) <= 20_001
    assert (np.abs(velocity) <= 1e-5 * np.array(model.limits.velocity_rad_s)).all()
    assert (np.abs(acceleration) <= np.array(model.limits.acceleration_rad_s2)).all()


@pytest.mark.parametrize("speed", [0.0, -0.1, 1.1, 1e-9, math.nan, math.inf])
def test_a_speed_that_is_no_share_is_refused(speed: float) -> None:
    model = panda_model()
    with pytest.raises(RobotError, match=r"the speed cannot be .*give a share from 1e-05 to 1"):
        plan_joints(home(), home() + 0.3, speed=speed, limits=model.limits, joint_names=model.arm_joints)
