"""Metres and newton become counts and back at the edge of the driver."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.robotiq.gripper_units import (
    count_of_width,
    force_count,
    force_of_count,
    speed_count,
    speed_of_count,
    width_of_count,
)

TWO_POINTS = ((3, 0.085), (230, 0.0))
MEASURED = ((3, 0.085), (100, 0.052), (180, 0.017), (230, 0.0))


@pytest.mark.parametrize(("speed_m_s", "count"), [(0.001, 0), (0.02, 0), (0.085, 128), (0.15, 255), (9.0, 255)])
def test_speeds_are_clipped_to_20_to_150_mm_a_second(speed_m_s: float, count: int) -> None:
    assert speed_count(speed_m_s) == count
    assert 0.02 <= speed_of_count(count) <= 0.15


@pytest.mark.parametrize(("force_n", "count"), [(1.0, 0), (20.0, 0), (127.5, 128), (235.0, 255), (900.0, 255)])
def test_forces_are_clipped_to_20_to_235_newton(force_n: float, count: int) -> None:
    assert force_count(force_n) == count
    assert 20.0 <= force_of_count(count) <= 235.0


def test_fully_open_and_closed_request_the_ends_of_the_range_although_fingers_end_before() -> None:
    assert (count_of_width(0.085, TWO_POINTS), count_of_width(0.0, TWO_POINTS)) == (0, 255)
    assert (width_of_count(3, TWO_POINTS), width_of_count(0, TWO_POINTS)) == (0.085, 0.085)
    assert (width_of_count(230, TWO_POINTS), width_of_count(255, TWO_POINTS)) == (0.0, 0.0)


@given(st.floats(0.001, 0.084), st.sampled_from([TWO_POINTS, MEASURED]))
def test_an_opening_survives_its_count_within_a_count(width_m: float, table: tuple[tuple[int, float], ...]) -> None:
    steepest_m = max((upper[1] - lower[1]) / (lower[0] - upper[0]) for upper, lower in pairwise(table))
    assert width_of_count(count_of_width(width_m, table), table) == pytest.approx(width_m, abs=steepest_m)


def test_a_measured_table_corrects_the_linkage() -> None:
    assert width_of_count(100, MEASURED) == pytest.approx(0.052)
    assert count_of_width(0.017, MEASURED) == 180
