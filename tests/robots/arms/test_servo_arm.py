"""The 2-DOF servo arm against the equations of its thesis."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform

ARM = robot_model("servo_arm")
KINEMATICS = ArmKinematics(ARM, base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
A1_M, A2_M = 0.275, 0.225


@given(st.floats(0.0, math.pi), st.floats(-2.61, 0.52))
def test_the_claw_is_where_the_homogeneous_transforms_put_it(theta_1: float, theta_2: float) -> None:
    """H02 = H01 H12 of section 3.2.3; the z axis of the tool is the x axis of frame 2."""
    c1, s1, c2, s2 = math.cos(theta_1), math.sin(theta_1), math.cos(theta_2), math.sin(theta_2)
    h01 = np.array([[c1, 0, s1, 0], [s1, 0, -c1, 0], [0, 1, 0, A1_M], [0, 0, 0, 1]])
    h12 = np.array([[c2, -s2, 0, A2_M * c2], [s2, c2, 0, A2_M * s2], [0, 0, 1, 0], [0, 0, 0, 1]])
    expected = h01 @ h12
    pose = KINEMATICS.tool_pose(np.array([theta_1, theta_2]))
    assert np.allclose(pose.xyz, expected[:3, 3], atol=1e-9)
    assert np.allclose(pose.rotation[:, 2], expected[:3, 0], atol=1e-9)


def test_home_is_written_to_the_servos_as_0_and_160_degrees() -> None:
    assert np.allclose(np.degrees(ARM.joint_map.to_device(np.array(ARM.home_rad))), (0.0, 160.0), atol=1e-6)


def test_the_range_is_what_the_servos_turn() -> None:
    """0 to 180 degrees each, whatever the joints of the model are called there."""
    lower, upper = (ARM.joint_map.to_device(np.array(side)) for side in (ARM.limits.lower_rad, ARM.limits.upper_rad))
    assert np.allclose(np.degrees(lower), (0.0, 0.0), atol=1e-6)
    assert np.allclose(np.degrees(upper), (180.0, 180.0), atol=1e-6)


def test_with_a_level_arm_the_claw_closes_horizontally_on_an_upright_tube() -> None:
    """The fingers open to the sides: along y of the world when the arm points along x."""
    pose = KINEMATICS.tool_pose(np.zeros(2))
    assert np.allclose(np.abs(pose.rotation[:, 1]), (0.0, 1.0, 0.0), atol=1e-9)
