"""The IRB 4600 against the five poses that the thesis read off the real controller's simulation (table 4)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform

IRB = robot_model("irb4600", gripper=None)
KINEMATICS = ArmKinematics(IRB, base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))

# Position, quaternion x y z w, joints as observed; the last digits that tell nothing are left out.
TABLE_4 = [
    (
        (0.85428, 0.08989, 2.22860),
        (-0.00019, 0.70706, 0.00012, 0.70715),
        (0.124277457541, 0.049236952194, -0.895120963340, 6.118493236814, 0.852627378532, 0.108765929659),
    ),
    (
        (0.33941, -0.05050, 1.13170),
        (-0.00026, 0.70705, 0.00021, 0.70716),
        (-0.242649394086, -1.282470280009, 1.062010982100, -5.434866064367, 0.326738755470, -0.821434535713),
    ),
    (
        (-0.07833, 0.091300, 1.60476),
        (-0.00013, 0.70710, 0.00014, 0.70711),
        (-0.404264921402, -1.291509418978, 0.389581462800, 6.782803322414, 0.964070354870, -6.584852886844),
    ),
    (
        (1.20480, -0.37843, 1.06333),
        (-0.000009, 0.70703, 0.000006, 0.70718),
        (-0.339996958867, 0.046411412489, 0.479820632600, -0.613805682574, -0.617993426829, 0.521305239361),
    ),
    (
        (1.14443, -0.04791, 0.46990),
        (-0.00013, 0.70702, 0.000004, 0.70718),
        (-0.047393187444, 0.409016123220, 0.830670937380, -0.050376296509, -1.240252904623, 0.016314488009),
    ),
]


@pytest.mark.parametrize(("xyz", "xyzw", "joints"), TABLE_4, ids=["pose 1", "pose 2", "pose 3", "pose 4", "pose 5"])
def test_the_flange_is_where_the_table_says(
    xyz: tuple[float, ...], xyzw: tuple[float, ...], joints: tuple[float, ...]
) -> None:
    """Within 0.2 mm and 1 mrad, of the plain flange."""
    pose, expected = KINEMATICS.tool_pose(np.array(joints)), RigidTransform.of(xyz, xyzw)
    assert pose.distance_m(expected) < 2e-4
    assert pose.angle_rad(expected) < 1e-3


def test_at_zero_the_flange_stands_1270_before_and_1570_above_the_base() -> None:
    pose = KINEMATICS.tool_pose(np.zeros(6))
    assert np.allclose(pose.xyz, (1.27, 0.0, 1.57), atol=1e-9)
    assert np.allclose(pose.rotation[:, 2], (1.0, 0.0, 0.0), atol=1e-9)


def test_the_table_is_within_the_joint_limits() -> None:
    """Axes 4 and 6 turn more than once."""
    limits = IRB.limits
    for _, _, joints in TABLE_4:
        assert (np.array(limits.lower_rad) <= joints).all()
        assert (np.array(joints) <= limits.upper_rad).all()


joint = st.floats(-3.0, 3.0)


@given(st.tuples(joint, joint, joint, joint, joint, joint))
def test_with_coupled_joints_the_third_is_counted_from_the_horizontal(joints: tuple[float, ...]) -> None:
    """The controller adds joint 2; the way back gives the same joints."""
    coupled = robot_model("irb4600", gripper=None, coupled_joints=True).joint_map
    q = np.array(joints)
    device = coupled.to_device(q)
    assert np.allclose(device - q, (0.0, 0.0, q[1], 0.0, 0.0, 0.0), atol=1e-12)
    assert np.allclose(coupled.to_model(device), q, atol=1e-12)
    assert np.allclose(coupled.rates_to_device(q), device, atol=1e-12)


def test_without_the_option_both_sides_are_the_same() -> None:
    assert IRB.joint_map.is_identity
    assert not robot_model("irb4600", gripper=None, coupled_joints=True).joint_map.is_identity


def test_coupled_the_forearm_keeps_its_tilt_while_the_lower_arm_swings() -> None:
    """That is what the coupling is for: the same commanded axis 3, another axis 2."""
    coupled = robot_model("irb4600", gripper=None, coupled_joints=True).joint_map
    tilts = [
        KINEMATICS.tool_pose(coupled.to_model(np.array([0.0, axis_2, 0.4, 0.0, 0.0, 0.0]))).rotation[:, 2]
        for axis_2 in (-0.5, 0.0, 0.9)
    ]
    assert np.allclose(tilts, tilts[0], atol=1e-12)
