"""Speed along a path that slows down before something may be touched."""

from __future__ import annotations

import numpy as np
import pytest

from robots.motion.min_jerk import PEAK_SPEED
from robots.motion.speed_profile import MIN_JERK, plan_approach
from robots.port import Array

SPEED_M_S, TOUCH_M_S = 0.1, 0.005


def sampled(distance_m: float, clear_m: float, speed_m_s: float = SPEED_M_S) -> tuple[Array, Array, float]:
    """Return distances and speeds every half millisecond, and the whole time."""
    profile, duration_s = plan_approach(distance_m, clear_m=clear_m, speed_m_s=speed_m_s, touch_m_s=TOUCH_M_S)
    times_s = np.arange(0.0, duration_s, 0.0005)
    distances = profile.shares(times_s / duration_s) * distance_m
    return distances, np.gradient(distances, times_s), duration_s


@pytest.mark.parametrize("clear_m", [0.0, 0.003, 0.02, 0.08])
def test_nothing_beyond_the_clear_distance_is_passed_faster_than_the_touch_speed(clear_m: float) -> None:
    distances, speeds, _ = sampled(0.1, clear_m)
    assert speeds[distances > clear_m + 1e-4].max() <= TOUCH_M_S * 1.001
    assert speeds.min() >= -1e-9
    assert (distances[0], distances[-1]) == (0.0, pytest.approx(0.1, abs=1e-4))
    assert max(speeds[1], speeds[-1]) < TOUCH_M_S / 10.0


def test_a_long_clear_distance_is_passed_at_the_whole_speed_and_a_short_one_as_fast_as_it_can_be_left() -> None:
    _, fast, short_s = sampled(0.3, 0.28)
    _, slower, long_s = sampled(0.3, 0.02)
    assert fast.max() == pytest.approx(SPEED_M_S, rel=1e-3)
    assert 2.0 * TOUCH_M_S < slower.max() < 0.9 * SPEED_M_S
    assert short_s < 0.2 * long_s


def test_the_speed_changes_within_the_acceleration_and_without_steps() -> None:
    _, speeds, _ = sampled(0.2, 0.15)
    accelerations = np.gradient(speeds, 0.0005)
    assert np.abs(accelerations).max() < 0.51
    assert np.abs(np.diff(accelerations)).max() < 0.51 * 0.0005 * 40.0


def test_a_path_too_short_to_reach_the_touch_speed_has_minimum_jerk() -> None:
    profile, duration_s = plan_approach(0.0001, clear_m=0.0, speed_m_s=SPEED_M_S, touch_m_s=TOUCH_M_S)
    assert profile is MIN_JERK
    assert duration_s == pytest.approx(PEAK_SPEED * 0.0001 / TOUCH_M_S)


def test_the_peak_is_that_of_the_fastest_moment() -> None:
    profile, duration_s = plan_approach(0.2, clear_m=0.15, speed_m_s=SPEED_M_S, touch_m_s=TOUCH_M_S)
    assert profile.peak * 0.2 / duration_s == pytest.approx(SPEED_M_S)
