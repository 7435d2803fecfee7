"""Rigid transforms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.messages import Pose
from robots.model.transform import RigidTransform, quaternion_of, rotation_vector

numbers = st.floats(-2.0, 2.0)
vectors = st.tuples(numbers, numbers, numbers)
rigids = st.builds(
    RigidTransform.of,
    vectors,
    st.tuples(numbers, numbers, numbers, numbers).filter(lambda q: math.hypot(*q) > 0.1),
)


@given(rigids, rigids)
def test_a_transform_and_its_inverse_cancel(first: RigidTransform, second: RigidTransform) -> None:
    """Composed in either order, also after another one."""
    back = first.inverse().then(first.then(second))
    assert back.distance_m(second) < 1e-9
    assert back.angle_rad(second) < 1e-6


@given(rigids, rigids)
def test_composition_multiplies_the_matrices(first: RigidTransform, second: RigidTransform) -> None:
    """Quaternions and rotation matrices say the same."""
    assert np.allclose(first.then(second).rotation, first.rotation @ second.rotation, atol=1e-9)


@given(vectors.filter(lambda v: math.hypot(*v) < 3.1))
def test_a_rotation_vector_survives_the_quaternion(vector: tuple[float, float, float]) -> None:
    """Up to half a turn."""
    assert np.allclose(rotation_vector(quaternion_of(np.array(vector))), vector, atol=1e-7)


def test_a_pose_keeps_its_numbers() -> None:
    """x y z w at the border, normalised."""
    pose = RigidTransform.from_pose(Pose(xyz=(1.0, 2.0, 3.0), xyzw=(0.0, 0.0, 0.0, 2.0))).to_pose("left")
    assert pose == Pose(xyz=(1.0, 2.0, 3.0), xyzw=(0.0, 0.0, 0.0, 1.0), frame="left")


@pytest.mark.parametrize("xyzw", [(0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0)])
def test_what_is_no_orientation_is_refused(xyzw: tuple[float, float, float, float]) -> None:
    """Zero or not a number."""
    with pytest.raises(ValueError, match="is not a pose"):
        RigidTransform.of((0.0, 0.0, 0.0), xyzw)
