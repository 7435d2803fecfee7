"""The minimum-jerk profile."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.motion.min_jerk import PEAK_SPEED, min_jerk


def test_it_goes_from_nothing_to_all_and_no_further() -> None:
    """Also asked before the start and after the end."""
    ends = np.array([-1.0, 0.0, 1.0, 2.0])
    assert min_jerk(ends).tolist() == [0.0, 0.0, 1.0, 1.0]


@given(st.floats(0.0, 1.0))
def test_it_is_symmetric(share: float) -> None:
    """The second half mirrors the first."""
    way, mirrored = min_jerk(np.array([share, 1.0 - share]))
    assert abs(way + mirrored - 1.0) < 1e-12


def test_it_starts_and_ends_without_speed_or_acceleration_and_never_turns_back() -> None:
    """The defining conditions of minimum jerk, by differences; the peak of the speed is in the middle."""
    t = np.linspace(0.0, 1.0, 2001)
    speed = np.gradient(min_jerk(t), t)
    acceleration = np.gradient(speed, t)
    assert np.abs(speed[[0, -1]]).max() < 1e-5
    assert np.abs(acceleration[[0, -1]]).max() < 0.05
    assert speed.min() >= 0.0
    assert (speed.max(), t[speed.argmax()]) == (pytest.approx(PEAK_SPEED, abs=1e-5), pytest.approx(0.5))
