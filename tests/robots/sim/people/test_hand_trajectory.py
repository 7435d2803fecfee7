"""How hands go: straight from rest, never faster than told, and off a way that they are on without a jump."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.port import Array
from robots.sim.people.hand_trajectory import GREATEST_ACCELERATION_M_S2, HandMotion, plan_hand_trajectory

_metre = st.floats(-0.6, 0.6)
places = st.tuples(_metre, _metre, _metre).map(np.array)
speeds = st.floats(0.1, 3.0)


def _at_rest(xyz: Array) -> HandMotion:
    return HandMotion(xyz=xyz, velocity=np.zeros(3))


@settings(deadline=None)
@given(places, places, speeds)
def test_from_rest_it_is_a_straight_line_that_is_no_faster_than_requested(
    start: Array, goal: Array, speed: float
) -> None:
    way = plan_hand_trajectory(_at_rest(start), goal, speed_m_s=speed)
    reached, acceleration = way.peaks()
    assert reached <= speed * 1.001
    assert acceleration <= GREATEST_ACCELERATION_M_S2 * 1.01
    line = goal - start
    if (length := float(np.linalg.norm(line))) > 1e-6:
        off = np.cross(way.places() - start, line / length)
        assert np.abs(off).max() < 1e-9


def test_it_takes_as_long_as_a_minimum_jerk_motion_of_that_peak_speed_does() -> None:
    way = plan_hand_trajectory(_at_rest(np.zeros(3)), np.array([0.4, 0.0, 0.0]), speed_m_s=0.5)
    assert way.duration_s == pytest.approx(1.875 * 0.4 / 0.5)
    assert way.peaks()[0] == pytest.approx(0.5, rel=1e-3)


@settings(deadline=None)
@given(places, places, places, speeds, speeds, st.floats(0.05, 0.95))
def test_sent_elsewhere_in_mid_motion_it_goes_on_from_where_it_is_at_the_speed_that_it_has(
    start: Array, first: Array, second: Array, speed: float, then: float, share: float
) -> None:
    before = plan_hand_trajectory(_at_rest(start), first, speed_m_s=speed)
    turned_off = before.at(share * before.duration_s)
    way = plan_hand_trajectory(turned_off, second, speed_m_s=then)
    begin, end = way.at(0.0), way.at(way.duration_s)
    if way.duration_s > 0.0:
        assert np.allclose(begin.xyz, turned_off.xyz, atol=1e-12)
        assert np.allclose(begin.velocity, turned_off.velocity, atol=1e-9)
    assert (end.xyz == second).all()
    assert (end.velocity == 0.0).all()
    reached, acceleration = way.peaks()
    assert reached <= max(then, float(np.linalg.norm(turned_off.velocity))) * 1.01
    assert acceleration <= GREATEST_ACCELERATION_M_S2 * 1.01


@settings(deadline=None)
@given(places, places, speeds, st.floats(0.1, 0.9))
def test_its_velocity_is_that_of_its_places(start: Array, goal: Array, speed: float, share: float) -> None:
    way = plan_hand_trajectory(HandMotion(xyz=start, velocity=np.array([0.3, -0.2, 0.1])), goal, speed_m_s=speed)
    time_s, small_s = share * way.duration_s, 1e-6 * way.duration_s
    slope = (way.at(time_s + small_s).xyz - way.at(time_s - small_s).xyz) / (2.0 * small_s)
    assert np.allclose(way.at(time_s).velocity, slope, atol=1e-5)
