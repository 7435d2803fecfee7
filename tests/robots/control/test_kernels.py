"""The compiled arithmetic of a control period beside the same written plainly."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.force.cholesky import solve_positive_definite
from robots.control.kernels import impedance_torque, interpolate_setpoint, pose_error, solve_in_place
from robots.model.transform import RigidTransform, conjugate, product, quaternion_of, rotation_vector
from robots.port import Array

SEEDS = st.integers(0, 2**32 - 1)
LIGHTEST = 0.01


def positive_definite(random: np.random.Generator, n: int) -> Array:
    """Return a symmetric matrix with eigenvalues from 0.1 to 10."""
    turned, _ = np.linalg.qr(random.normal(size=(n, n)))
    return turned @ np.diag(random.uniform(0.1, 10.0, n)) @ turned.T


@settings(deadline=None, max_examples=50)
@given(SEEDS)
def test_the_set_point_has_the_very_bits_that_the_spline_written_in_numpy_has(seed: int) -> None:
    """Recordings of motions repeat bit for bit, whichever of the two made them."""
    random = np.random.default_rng(seed)
    points, slopes = random.normal(size=(5, 7)), random.normal(size=(5, 7))
    index, u, h = int(random.integers(4)), float(random.uniform()), 0.001
    pace, change = float(random.uniform()), float(random.normal())
    position, velocity, acceleration = np.zeros(7), np.zeros(7), np.zeros(7)
    interpolate_setpoint(points, slopes, index, u, h, pace, pace**2, change, position, velocity, acceleration)

    p0, p1, v0, v1 = points[index], points[index + 1], slopes[index], slopes[index + 1]
    u2, u3 = u * u, u * u * u
    rise = (p1 - p0) / h
    slope = (6 * u - 6 * u * u) * rise + (1 - 4 * u + 3 * u * u) * v0 + (3 * u * u - 2 * u) * v1
    curvature = ((6 - 12 * u) * rise + (6 * u - 4) * v0 + (6 * u - 2) * v1) / h
    plain = (1 - 3 * u2 + 2 * u3) * p0 + (3 * u2 - 2 * u3) * p1 + h * ((u - 2 * u2 + u3) * v0 + (u3 - u2) * v1)
    assert position.tobytes() == plain.tobytes()
    assert velocity.tobytes() == (slope * pace).tobytes()
    assert acceleration.tobytes() == (curvature * pace**2 + slope * change).tobytes()


@settings(deadline=None, max_examples=50)
@given(SEEDS, st.integers(1, 8), st.integers(1, 6))
def test_a_positive_definite_system_is_solved(seed: int, n: int, columns: int) -> None:
    random = np.random.default_rng(seed)
    matrix, right = positive_definite(random, n), random.normal(size=(n, columns))
    assert solve_positive_definite(matrix, right) == pytest.approx(np.linalg.solve(matrix, right), abs=1e-9)
    assert solve_positive_definite(matrix, right[:, 0]) == pytest.approx(np.linalg.solve(matrix, right[:, 0]), abs=1e-9)


def test_a_matrix_that_is_not_positive_definite_is_refused() -> None:
    flat = np.diag([1.0, 0.0])
    assert not solve_in_place(flat.copy(), np.ones((2, 1)))
    with pytest.raises(ArithmeticError, match="not positive definite"):
        solve_positive_definite(flat, np.ones(2))


@settings(deadline=None, max_examples=50)
@given(SEEDS, st.sampled_from([0.0, 1e-13, 1e-6, 0.3, 2.0, 3.1]), st.booleans())
def test_a_pose_error_is_that_of_the_rigid_transforms(seed: int, angle_rad: float, other_sign: bool) -> None:
    """A quaternion and its opposite are the same orientation."""
    random = np.random.default_rng(seed)
    axis = random.normal(size=3)
    turn = quaternion_of(axis / np.linalg.norm(axis) * angle_rad)
    there = quaternion_of(random.normal(size=3))
    measured = RigidTransform.of(random.normal(size=3), there)
    wanted = RigidTransform.of(random.normal(size=3), product(turn, there) * (-1.0 if other_sign else 1.0))
    error = np.zeros(6)
    pose_error(wanted.xyz, wanted.xyzw, measured.xyz, measured.xyzw, error)
    plain = rotation_vector(product(wanted.xyzw, conjugate(measured.xyzw)))
    assert error == pytest.approx(np.concatenate((wanted.xyz - measured.xyz, plain)), abs=1e-12)


@settings(deadline=None, max_examples=50)
@given(SEEDS, st.sampled_from([2, 6, 7]))
def test_a_tool_on_springs_and_dampers_is_pulled_as_the_law_says(seed: int, n: int) -> None:
    random = np.random.default_rng(seed)
    world, mass = random.normal(size=(6, n)), positive_definite(random, n)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    error, behind, slower = random.normal(size=6), random.normal(size=n), random.normal(size=n)
    stiffness, root = random.uniform(1.0, 9.0, 6), random.uniform(0.1, 3.0, 6)
    spring, damper, torque = random.uniform(0.5, 4.0, n), random.uniform(0.1, 2.0, n), np.zeros(n)
    assert impedance_torque(world, turn, mass, error, behind, slower, stiffness, root, spring, damper, LIGHTEST, torque)

    to_base = np.kron(np.eye(2), turn.T)
    jacobian = to_base @ world
    mobility = jacobian @ np.linalg.solve(mass, jacobian.T)
    bound = [LIGHTEST / 3.0 * float(np.trace(mobility[at : at + 3, at : at + 3])) for at in (0, 0, 0, 3, 3, 3)]
    inertia = np.linalg.inv(mobility + np.diag(bound))
    force = stiffness * (to_base @ error) + root * np.sqrt(np.diag(inertia)) * (jacobian @ slower)
    joints = spring * behind + damper * np.sqrt(np.diag(mass)) * slower
    null_space = np.eye(n) - jacobian.T @ inertia @ jacobian @ np.linalg.inv(mass)
    assert torque == pytest.approx(jacobian.T @ force + null_space @ joints, rel=1e-7, abs=1e-7)


def test_a_tool_on_an_arm_without_inertia_gets_no_torque() -> None:
    ones, pair, torque = np.ones(6), np.ones(2), np.full(2, 5.0)
    done = impedance_torque(
        np.ones((6, 2)), np.eye(3), np.zeros((2, 2)), ones, torque, torque, ones, ones, pair, pair, LIGHTEST, torque
    )
    assert (done, torque.tolist()) == (False, [5.0, 5.0])
