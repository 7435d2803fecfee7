"""Exciting motions stay within the limits of any arm, end where they began, and refuse a joint without room."""

from __future__ import annotations

import numpy as np
import pytest

from engine.errors import RobotError
from robots.arm.identification.excitation import swing_joints, swing_wrist
from robots.model import model_by_name
from robots.port import Array, JointTrajectory

ARMS = pytest.mark.parametrize("name", ["panda", "ur10", "irb4600", "servo_arm"])


def middle(name: str) -> Array:
    """A configuration in the middle of the range, away from the limits."""
    limits = model_by_name(name).limits
    return (np.array(limits.lower_rad) + np.array(limits.upper_rad)) / 2.0


def check(trajectory: JointTrajectory, start: Array, name: str) -> None:
    """At rest at the start at both ends, consistent, and within half of the limits."""
    limits, position = model_by_name(name).limits, trajectory.position_rad
    assert position[0] == pytest.approx(start)
    assert position[-1] == pytest.approx(start)
    assert not trajectory.velocity_rad_s[[0, -1]].any()
    velocity = np.gradient(position, trajectory.dt_s, axis=0)
    acceleration = np.gradient(trajectory.velocity_rad_s, trajectory.dt_s, axis=0)
    jerk = np.gradient(acceleration, trajectory.dt_s, axis=0)
    assert np.abs(velocity - trajectory.velocity_rad_s).max() < 0.01
    assert (np.abs(velocity) < 0.55 * np.array(limits.velocity_rad_s)).all()
    assert (np.abs(acceleration) < 0.5 * np.array(limits.acceleration_rad_s2)).all()
    assert (np.abs(jerk) < 0.6 * np.array(limits.jerk_rad_s3)).all()
    assert (position > np.array(limits.lower_rad)).all()
    assert (position < np.array(limits.upper_rad)).all()


@ARMS
def test_a_wrist_swings_within_its_limits(name: str) -> None:
    model = model_by_name(name)
    swung = swing_wrist(middle(name), amplitude_rad=1.0, limits=model.limits, joints=model.arm_joints)
    check(swung, middle(name), name)
    moved = np.ptp(swung.position_rad, axis=0)
    assert (moved[-3:] > 0.5).all()
    assert not moved[:-3].any()


@ARMS
def test_joints_swing_one_after_the_other(name: str) -> None:
    model = model_by_name(name)
    moved = range(model.dof)
    swung = swing_joints(middle(name), moved, amplitude_rad=1.0, limits=model.limits, joints=model.arm_joints)
    check(swung, middle(name), name)
    assert ((np.abs(swung.velocity_rad_s) > 0.0).sum(axis=1) <= 1).all()
    assert (np.ptp(swung.position_rad, axis=0) > 0.5).all()


def test_a_joint_near_its_limit_swings_less_and_one_at_its_limit_not_at_all() -> None:
    model = model_by_name("panda")
    near = middle("panda")
    near[5] = model.limits.upper_rad[5] - 0.3
    swung = swing_joints(near, [5], amplitude_rad=0.5, limits=model.limits, joints=model.arm_joints)
    assert 0.4 < np.ptp(swung.position_rad[:, 5]) <= 0.5
    near[5] = model.limits.upper_rad[5] - 0.1
    with pytest.raises(RobotError, match=r"panda_joint6 at 3\.65 rad has 0\.05 rad of room"):
        swing_joints(near, [5], amplitude_rad=0.5, limits=model.limits, joints=model.arm_joints)
