"""A trajectory that is slowed on a section: the same path, within the limits, and as fast as before elsewhere."""

from __future__ import annotations

from typing import cast

import numpy as np
import pytest

from robots.motion import plan_joints
from robots.motion.slow_section import slow_section
from robots.port import Array, JointTrajectory
from tests.robots.panda_arm import panda_model

LIMITS = panda_model().limits
START = np.array((1.2, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8))
END = np.array((-1.2, -0.2, 0.3, -2.0, 0.0, 1.6, 0.4))
SLOW = 0.1


def fast() -> JointTrajectory:
    """Return a motion to joints at half of the speed limits."""
    return plan_joints(START, END, limits=LIMITS, speed=0.5, joint_names=panda_model().arm_joints)


def shares(trajectory: JointTrajectory) -> Array:
    """Return the speed of the fastest joint in each row, as a share of its limit."""
    return cast("Array", (np.abs(trajectory.velocity_rad_s) / np.array(LIMITS.velocity_rad_s)).max(axis=1))


def along(trajectory: JointTrajectory) -> Array:
    """Return the completed share of the first joint's path in each row."""
    return cast("Array", (trajectory.position_rad[:, 0] - START[0]) / (END[0] - START[0]))


def peaks(trajectory: JointTrajectory) -> tuple[Array, Array]:
    """Return the greatest acceleration and jerk of each joint, from the positions that are sent."""
    dt = trajectory.dt_s
    q = trajectory.position_rad
    return np.abs(np.diff(q, 2, axis=0)).max(axis=0) / dt**2, np.abs(np.diff(q, 3, axis=0)).max(axis=0) / dt**3


@pytest.mark.parametrize(("from_share", "to_share"), [(0.4, 0.6), (0.0, 0.3), (0.7, 1.0), (0.0, 1.0)])
def test_the_section_is_slow_and_the_rest_keeps_path_limits_and_speed(from_share: float, to_share: float) -> None:
    given = fast()
    from_s, to_s = (share * given.duration_s for share in (from_share, to_share))
    slowed = slow_section(given, from_s=from_s, to_s=to_s, speed=SLOW, limits=LIMITS)
    section = np.interp((from_s, to_s), np.arange(len(given.position_rad)) * given.dt_s, along(given))
    inside = (along(slowed) >= section[0]) & (along(slowed) <= section[1])
    assert shares(slowed)[inside].max() <= SLOW * 1.001
    np.testing.assert_allclose(slowed.position_rad[[0, -1]], given.position_rad[[0, -1]], atol=1e-9)
    assert np.abs(slowed.velocity_rad_s[[0, -1]]).max() < 1e-6
    for joint in range(1, 7):
        same = np.interp(along(slowed), along(given), given.position_rad[:, joint])
        assert np.abs(same - slowed.position_rad[:, joint]).max() < 1e-4
    uniform_s = given.duration_s * shares(given).max() / SLOW
    assert slowed.duration_s < uniform_s * (to_share - from_share) + given.duration_s + 5.0
    if to_share - from_share < 0.5:
        assert slowed.duration_s < 0.75 * uniform_s
    for after, before, limit in zip(
        peaks(slowed), peaks(given), (LIMITS.acceleration_rad_s2, LIMITS.jerk_rad_s3), strict=True
    ):
        assert (after <= 1.05 * np.maximum(limit, before)).all()


def test_the_velocities_are_those_of_the_positions() -> None:
    slowed = slow_section(fast(), from_s=1.0, to_s=1.5, speed=SLOW, limits=LIMITS)
    central = (slowed.position_rad[2:] - slowed.position_rad[:-2]) / (2.0 * slowed.dt_s)
    np.testing.assert_allclose(slowed.velocity_rad_s[1:-1], central, atol=2e-3)


def test_what_is_slow_already_stays_as_it_is() -> None:
    slow = plan_joints(START, END, limits=LIMITS, speed=0.09, joint_names=panda_model().arm_joints)
    assert slow_section(slow, from_s=0.5, to_s=1.0, speed=SLOW, limits=LIMITS) is slow
