"""What an FR3 permits near the ends of its joints."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.franka.fr3_limits import limit_violation, lower_velocity_rad_s, upper_velocity_rad_s
from tests.robots.drivers.franka.emulated_cabinet import FR3_MODEL, FR3_START

LOWER, UPPER = np.array(FR3_MODEL.limits.lower_rad), np.array(FR3_MODEL.limits.upper_rad)
shares = st.lists(st.floats(0.0, 1.0), min_size=7, max_size=7).map(np.array)


def test_the_speeds_in_the_middle_and_near_an_end_are_those_of_the_specification() -> None:
    middle = np.array((0.0, 0.0, 0.0, -1.57, 0.0, 2.5, 0.0))
    assert upper_velocity_rad_s(middle) == pytest.approx([2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26])
    near = middle.copy()
    near[0], near[3] = 2.7, -0.2
    assert upper_velocity_rad_s(near)[[0, 3]] == pytest.approx([0.4754, 0.3585], abs=1e-4)
    assert lower_velocity_rad_s(near)[[0, 3]] == pytest.approx([-2.62, -2.62])


@given(shares)
def test_inside_its_range_an_arm_at_rest_violates_nothing(share: np.ndarray) -> None:
    position = LOWER + share * (UPPER - LOWER)
    assert limit_violation(position, np.zeros(7)) == ""
    assert (upper_velocity_rad_s(position) >= 0.0).all()
    assert (lower_velocity_rad_s(position) <= 0.0).all()


@given(shares, st.integers(0, 6), st.sampled_from((-1.0, 1.0)))
def test_a_joint_beyond_its_speed_is_named(share: np.ndarray, joint: int, direction: float) -> None:
    position = LOWER + share * (UPPER - LOWER)
    velocity = np.zeros(7)
    velocity[joint] = 6.0 * direction
    assert limit_violation(position, velocity).startswith(
        f"joint {joint + 1} would move at {6.0 * direction:.2f} rad/s"
    )


def test_the_limits_of_the_model_are_within_those_of_the_specification() -> None:
    assert (np.array(FR3_MODEL.limits.velocity_rad_s) < upper_velocity_rad_s(FR3_START)).all()
    assert max(FR3_MODEL.limits.acceleration_rad_s2) < 10.0
    assert max(FR3_MODEL.limits.jerk_rad_s3) < 5000.0
