"""The rotation vector between two orientations is that of the turn, the shorter way round."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.messages import Quaternion, Vector3
from engine.messages.pose_algebra import rotate_vector, rotation_vector_between

AXES: tuple[Vector3, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def turn(axis: Vector3, angle_rad: float) -> Quaternion:
    """The quaternion of a turn about a unit axis."""
    x, y, z = (value * math.sin(angle_rad / 2) for value in axis)
    return (x, y, z, math.cos(angle_rad / 2))


@given(axis=st.sampled_from(AXES), angle_rad=st.floats(-3.1, 3.1), sign=st.sampled_from((1.0, -1.0)))
def test_a_turn_about_an_axis_of_the_world_is_found_again(axis: Vector3, angle_rad: float, sign: float) -> None:
    x, y, z, w = turn(axis, angle_rad)
    found = rotation_vector_between((0.0, 0.0, 0.0, 1.0), (sign * x, sign * y, sign * z, sign * w))
    assert found == pytest.approx(tuple(value * angle_rad for value in axis), abs=1e-7)


@given(first=st.floats(-3.0, 3.0), second=st.floats(-3.0, 3.0))
def test_what_it_gives_turns_one_into_the_other(first: float, second: float) -> None:
    one, other = turn(AXES[0], first), turn(AXES[1], second)
    vector = rotation_vector_between(one, other)
    angle_rad = math.hypot(*vector)
    by = turn((vector[0] / angle_rad, vector[1] / angle_rad, vector[2] / angle_rad), angle_rad) if angle_rad else one
    for axis in AXES:
        turned = rotate_vector(by, rotate_vector(one, axis)) if angle_rad else rotate_vector(one, axis)
        assert turned == pytest.approx(rotate_vector(other, axis), abs=1e-7)
