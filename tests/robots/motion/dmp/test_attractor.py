"""The attractor of orientations: rotations of any size are exact, and its pull is along the shortest rotation."""

from __future__ import annotations

import math

import pytest

from robots.motion.dmp.attractor import integrate_rotation, orientation_acceleration

STILL = (0.0, 0.0, 0.0)
NO_TURN = (0.0, 0.0, 0.0, 1.0)
TURNED = (math.sin(0.4), 0.0, 0.0, math.cos(0.4))
"""By 0.8 rad about x."""


@pytest.mark.parametrize("angle_rad", [0.0, 1e-13, 1e-6, 0.1, 1.0, 3.0, 6.0])
@pytest.mark.parametrize("span", [0.01, 1.0, 2.5])
def test_a_rotation_at_a_constant_rate_turns_by_rate_times_time(angle_rad: float, span: float) -> None:
    """About the axes of the world, whatever the orientation before."""
    half = angle_rad / 2.0
    assert integrate_rotation(NO_TURN, (0.0, 0.0, angle_rad / span), span) == pytest.approx(
        (0.0, 0.0, math.sin(half), math.cos(half)), abs=1e-12
    )
    x, w = math.sin(0.4), math.cos(0.4)
    assert integrate_rotation(TURNED, (0.0, 0.0, angle_rad / span), span) == pytest.approx(
        (math.cos(half) * x, math.sin(half) * x, math.sin(half) * w, math.cos(half) * w), abs=1e-12
    )


def test_the_goal_pulls_by_the_angle_to_it_and_a_rotation_is_braked() -> None:
    """Critically damped: a_z²/4 for each radian, a_z for each radian per time."""
    goal, force = list(TURNED), [0.1, 0.2, 0.3]
    assert orientation_acceleration(NO_TURN, STILL, goal, [0.0] * 3, 20.0) == pytest.approx((80.0, 0.0, 0.0))
    assert orientation_acceleration(TURNED, (1.0, 2.0, 3.0), goal, force, 20.0) == pytest.approx((-19.9, -39.8, -59.7))
