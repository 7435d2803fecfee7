"""The kinematics of the emulator against the models that the rest of the house has, and against themselves."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robots.drivers.universal_robots.emulator.pose_vectors import (
    interpolate,
    inverse_of,
    matrix_of,
    pose_of,
    rotation_of,
    rotation_vector_of,
)
from robots.drivers.universal_robots.emulator.ur_kinematics import UrKinematics
from robots.drivers.universal_robots.emulator.ur_models import ARMS
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform, quaternion_of

JOINTS = st.tuples(*[st.floats(-3.0, 3.0)] * 6)
HOME = [0.0, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0]
VECTORS = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@example("ur10", (1.75, 0.0, 0.0, -1.0, 0.0, 0.0))  # elbow and wrist straight at once
@given(st.sampled_from(sorted(ARMS)), JOINTS)
def test_the_inverse_of_a_pose_reaches_it(model: str, q: tuple[float, ...]) -> None:
    """From the configuration that has it, it is that configuration unless the wrist is straight."""
    kinematics = UrKinematics(ARMS[model])
    flange = kinematics.flange(q)
    found = kinematics.inverse(flange, q)
    assert found is not None
    assert np.allclose(kinematics.flange(found), flange, atol=1e-6)
    assert np.abs(found - np.array(q)).max() < 1e-2 or abs(math.sin(q[4])) < 1e-2 or abs(math.sin(q[2])) < 1e-2


@pytest.mark.parametrize("q", [HOME, [0.3, -1.1, 1.4, -0.7, 1.2, 2.0], [-2.0, -2.2, -1.3, 0.4, -1.9, -0.6]])
def test_the_flange_is_where_the_model_of_the_arm_has_it(q: list[float]) -> None:
    """Whose base is turned by half a turn against that of the controller, as its file says."""
    base = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    origin = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    pose = pose_of(UrKinematics(ARMS["ur10"]).flange(q))
    flange = base.then(RigidTransform.of(tuple(pose[:3]), tuple(quaternion_of(np.array(pose[3:])))))
    expected = ArmKinematics(robot_model("ur10", gripper=None), base=origin).tool_pose(np.array(q))
    assert flange.distance_m(expected) < 1e-6
    assert flange.angle_rad(expected) < 1e-6


def test_what_is_out_of_reach_has_no_inverse() -> None:
    """Too far, and too near to the axis of the base."""
    kinematics = UrKinematics(ARMS["ur10"])
    for x_m in (2.0, 0.05):
        assert kinematics.inverse(matrix_of((x_m, 0.0, 0.3, math.pi, 0.0, 0.0)), [0.0] * 6) is None


@given(JOINTS)
def test_the_jacobian_is_the_derivative(q: tuple[float, ...]) -> None:
    """By differences."""
    kinematics = UrKinematics(ARMS["ur5e"])
    tool = matrix_of((0.0, 0.05, 0.1, 0.2, 0.0, 0.0))
    jacobian = kinematics.jacobian(q, tool)
    for joint in range(6):
        step = np.zeros(6)
        step[joint] = 1e-6
        before, after = (kinematics.flange(np.array(q) + sign * step) @ tool for sign in (-1.0, 1.0))
        assert np.allclose((after[:3, 3] - before[:3, 3]) / 2e-6, jacobian[:3, joint], atol=1e-5)
        turn = rotation_vector_of(after[:3, :3] @ before[:3, :3].T) / 2e-6
        assert np.allclose(turn, jacobian[3:, joint], atol=1e-5)


@given(VECTORS, VECTORS)
def test_a_pose_is_its_matrix(position: tuple[float, ...], vector: tuple[float, ...]) -> None:
    """And a matrix its pose, with a rotation of at most half a turn."""
    matrix = matrix_of([*position, *vector])
    pose = pose_of(matrix)
    assert np.linalg.norm(pose[3:]) <= math.pi + 1e-9
    assert np.allclose(matrix_of(pose), matrix, atol=1e-6)
    assert np.allclose(inverse_of(matrix) @ matrix, np.eye(4), atol=1e-9)


@pytest.mark.parametrize("axis", np.eye(3).tolist())
def test_half_a_turn_about_an_axis_is_found(axis: list[float]) -> None:
    """Where the rotation matrix is symmetric."""
    vector = rotation_vector_of(rotation_of([math.pi * value for value in axis]))
    assert np.abs(vector) == pytest.approx([math.pi * value for value in axis], abs=1e-6)


def test_interpolation_is_on_the_straight_line_with_half_of_the_rotation() -> None:
    """At half of the line."""
    start, end = matrix_of((0.0, 0.0, 0.0, 0.0, 0.0, 0.2)), matrix_of((0.2, 0.4, 0.0, 0.0, 0.0, 1.0))
    assert pose_of(interpolate(start, end, 0.5)) == pytest.approx([0.1, 0.2, 0.0, 0.0, 0.0, 0.6])
