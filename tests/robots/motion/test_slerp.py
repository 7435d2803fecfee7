"""Interpolation of orientations."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from robots.model.transform import RigidTransform
from robots.motion.slerp import slerp
from robots.port import Array

ORIGIN = np.zeros(3)
numbers = st.floats(-1.0, 1.0)
quaternions = (
    st.tuples(numbers, numbers, numbers, numbers)
    .filter(lambda q: math.hypot(*q) > 0.1)
    .map(lambda q: np.array(q) / math.hypot(*q))
)


def angle_rad(one: Array, other: Array) -> float:
    """Angle between two orientations."""
    return RigidTransform(xyz=ORIGIN, xyzw=one).angle_rad(RigidTransform(xyz=ORIGIN, xyzw=other))


@given(quaternions, quaternions, st.floats(0.0, 1.0))
def test_it_takes_the_short_way_at_a_constant_rate(start: Array, end: Array, share: float) -> None:
    """After `share` of the way, that share of the smallest angle is done and the rest is left."""
    whole = angle_rad(start, end)
    middle = slerp(start, end, share)
    assert whole <= math.pi + 1e-9
    assert abs(angle_rad(start, middle) - share * whole) < 1e-6
    assert abs(angle_rad(middle, end) - (1.0 - share) * whole) < 1e-6
    assert abs(float(np.linalg.norm(middle)) - 1.0) < 1e-9


@given(quaternions, quaternions, st.floats(0.01, 0.99))
def test_the_sign_of_a_quaternion_means_nothing(start: Array, end: Array, share: float) -> None:
    """q and -q are one orientation, so they give one path; half a turn has two equal ways."""
    if angle_rad(start, end) < math.pi - 1e-3:
        assert angle_rad(slerp(start, end, share), slerp(start, -end, share)) < 1e-6


def test_a_quarter_turn_is_halved() -> None:
    """A value worked out by hand."""
    quarter = np.array([0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4)])
    eighth = [0.0, 0.0, math.sin(math.pi / 8), math.cos(math.pi / 8)]
    assert np.allclose(slerp(np.array([0.0, 0.0, 0.0, 1.0]), quarter, 0.5), eighth)
