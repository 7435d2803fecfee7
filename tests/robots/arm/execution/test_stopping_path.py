"""The path until rest: the reaction time on, then braking, straight in joint space."""

from __future__ import annotations

import numpy as np
import pytest

from robots.arm.execution.stopping_path import REACTION_S, stopping_path
from robots.port import Array

LIMITS = np.array([2.0, 4.0])


def path(velocity: tuple[float, float], requested: tuple[float, float]) -> Array:
    """Return the path from zero."""
    wanted = np.array(requested)
    ahead = stopping_path(np.zeros(2), np.array(velocity), requested=lambda _: wanted, braking_rad_s2=LIMITS)
    assert (ahead.dt_s, ahead.velocity_rad_s.any()) == (0.01, np.False_)
    return ahead.position_rad


def test_an_arm_at_rest_that_nobody_moves_stays() -> None:
    rows = path((0.0, 0.0), (0.0, 0.0))
    assert (len(rows), rows.any()) == (1 + 13, np.False_)


def test_an_arm_goes_on_for_the_reaction_time_and_then_brakes_with_what_the_slowest_joint_allows() -> None:
    rows = path((0.6, 0.3), (0.6, 0.3))
    assert rows[-1] == pytest.approx(
        [0.6 * REACTION_S + 0.5 * 0.6 * 0.3, 0.3 * REACTION_S + 0.5 * 0.3 * 0.3], abs=0.004
    )
    assert np.abs(rows[:, 0] - 2.0 * rows[:, 1]).max() < 1e-12
    assert rows[12] == pytest.approx([0.072, 0.036])
    assert len(rows) == 1 + 12 + 30
    assert (np.diff(rows[:, 0]) >= 0.0).all()


def test_an_arm_gathers_speed_towards_what_is_requested_within_the_limits() -> None:
    rows = path((0.0, 0.0), (1.0, 0.0))
    speeds = np.diff(rows[:, 0]) / 0.01
    assert speeds.max() == pytest.approx(2.0 * REACTION_S)
    assert speeds[-1] == pytest.approx(0.0)
    assert np.abs(np.diff(speeds)).max() <= 0.02 + 1e-9


def test_a_request_is_asked_again_where_the_arm_is() -> None:
    asked: list[float] = []

    def requested(joints: Array) -> Array:
        asked.append(float(joints[0]))
        return np.array([0.5, 0.0])

    stopping_path(np.zeros(2), np.array([0.5, 0.0]), requested=requested, braking_rad_s2=LIMITS)
    assert asked == pytest.approx([0.005 * k for k in range(12)])
