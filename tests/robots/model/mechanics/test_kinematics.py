"""Forward kinematics and Jacobian of the Panda at a base."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from engine.errors import CellError
from robots.model.inverse_kinematics import pose_error
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array
from tests.robots.panda_arm import BASE, configurations, home, panda_kinematics, panda_model


def test_the_tool_at_home_is_where_the_data_sheet_puts_it() -> None:
    """Flange 0.107, hand 0.1034 m below it: x 0.307, z 0.487 before the base, pointing down."""
    pose = panda_kinematics().tool_pose(home())
    assert np.allclose(pose.xyz, [-0.55 + 0.3069, 0.0, 0.4869], atol=1e-4)
    assert np.allclose(np.abs(pose.xyzw), [1.0, 0.0, 0.0, 0.0], atol=1e-6)


@settings(max_examples=25, deadline=None)
@given(configurations())
def test_a_turned_base_turns_the_tool_with_it(joints: Array) -> None:
    """The base pose is applied in the world."""
    base = RigidTransform.of((0.55, 0.1, 0.2), (0.0, 0.0, math.sin(1.2), math.cos(1.2)))
    turned = ArmKinematics(panda_model(), base=base).tool_pose(joints)
    expected = base.then(BASE.inverse().then(panda_kinematics().tool_pose(joints)))
    assert turned.distance_m(expected) < 1e-9
    assert turned.angle_rad(expected) < 1e-6


@settings(max_examples=25, deadline=None)
@given(configurations())
def test_the_jacobian_predicts_small_motions_in_world_axes(joints: Array) -> None:
    """By differences, under a turned base."""
    base = RigidTransform.of((0.55, 0.1, 0.2), (0.0, 0.0, math.sin(1.2), math.cos(1.2)))
    kinematics = ArmKinematics(panda_model(), base=base)
    pose, jacobian = kinematics.tool_pose_and_jacobian(joints)
    for joint in range(7):
        moved = joints.copy()
        moved[joint] += 1e-6
        slope = pose_error(pose, kinematics.tool_pose(moved)) / 1e-6
        assert np.allclose(slope, jacobian[:, joint], atol=1e-4)


def test_a_twin_does_not_disturb_its_sibling() -> None:
    """Each has working memory of its own."""
    first = panda_kinematics()
    pose, jacobian = first.tool_pose_and_jacobian(home())
    first.twin().tool_pose_and_jacobian(home() + 0.3)
    again, jacobian_again = first.tool_pose_and_jacobian(home())
    assert again.distance_m(pose) == 0.0
    assert (jacobian == jacobian_again).all()


def test_a_stretched_arm_is_next_to_a_singularity() -> None:
    """Dexterity is about zero there, and far from it at home."""
    stretched = np.array([0.0, 0.0, 0.0, -0.07, 0.0, 1.5, 0.0])
    assert panda_kinematics().dexterity(stretched) < 0.03 < 0.2 < panda_kinematics().dexterity(home())


def test_a_model_that_does_not_fit_its_urdf_is_refused() -> None:
    """Wrong tool link."""
    with pytest.raises(CellError, match="no link panda_claw"):
        ArmKinematics(replace(panda_model(), tool_link="panda_claw"), base=BASE)
