"""Rows of quaternions: logarithm and exponential undo each other on both covers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.model import transform as rigid
from robots.motion.dmp.quaternions import continuous, exp, log, of_matrix, product

vectors = st.tuples(*[st.floats(-3.6, 3.6)] * 3).map(np.array)
units = vectors.map(exp)


@given(vectors)
def test_the_logarithm_undoes_the_exponential_up_to_a_whole_turn(vector: np.ndarray) -> None:
    """Also past half a turn, where a logarithm of rotations would take the other way."""
    if np.linalg.norm(vector) < 6.2:
        assert log(exp(vector)) == pytest.approx(vector, abs=1e-7)


@given(units, units)
def test_products_are_those_of_single_quaternions(left: np.ndarray, right: np.ndarray) -> None:
    assert product(np.tile(left, (2, 1)), right)[1] == pytest.approx(rigid.product(left, right), abs=1e-12)


@given(units)
def test_a_rotation_matrix_gives_its_quaternion(xyzw: np.ndarray) -> None:
    matrix = rigid.RigidTransform(xyz=np.zeros(3), xyzw=xyzw).rotation
    assert abs(float(of_matrix(matrix) @ xyzw)) == pytest.approx(1.0, abs=1e-9)


@given(units, st.lists(st.sampled_from([1.0, -1.0]), min_size=50, max_size=50))
def test_a_row_with_random_signs_becomes_continuous(first: np.ndarray, signs: list[float]) -> None:
    """All around once, which brings the quaternion to its negative."""
    row = product(exp(np.linspace(0.0, 2.0 * np.pi, 50)[:, None] * np.array([0.0, 0.6, 0.8])), first)
    found = continuous(row * np.array(signs)[:, None])
    assert found == pytest.approx(row * np.sign(found[0] @ row[0]), abs=1e-12)
    assert found[-1] == pytest.approx(-found[0], abs=1e-9)
