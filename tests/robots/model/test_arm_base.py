"""The base of an arm is one fact: kinematics made before it moves, and their inverse, follow it."""

from __future__ import annotations

import numpy as np
import pytest

from robots.model.arm_base import ArmBase
from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform

UPRIGHT = (0.0, 0.0, 0.0, 1.0)
TURNED = (0.0, 0.0, np.sin(0.4), np.cos(0.4))
START, THERE = RigidTransform.of((0.1, 0.2, 0.3), UPRIGHT), RigidTransform.of((0.1, 1.0, 0.3), TURNED)


@pytest.mark.parametrize("made", ["twin", "with a tool", "itself"])
def test_all_kinematics_of_an_arm_follow_its_base(made: str) -> None:
    model, base = robot_model("ur10", gripper=None), ArmBase(START)
    arm, home = ArmKinematics(model, base=base), np.array(model.home_rad)
    tool = RigidTransform.of((0.0, 0.0, 0.1), UPRIGHT)
    one = {"twin": arm.twin(), "with a tool": arm.with_tool(tool), "itself": arm}[made]
    in_base = START.inverse().then(one.tool_pose(home))
    jacobian = one.tool_pose_and_jacobian(home)[1]
    base.stand_at(THERE)
    assert one.base is THERE
    assert one.tool_pose(home).distance_m(THERE.then(in_base)) < 1e-12
    turned = one.tool_pose_and_jacobian(home)[1]
    assert turned[:3] == pytest.approx(THERE.rotation @ jacobian[:3], abs=1e-12)


def test_inverse_kinematics_that_has_answered_answers_for_the_new_base() -> None:
    model, base = robot_model("ur10", gripper=None), ArmBase(START)
    arm, home = ArmKinematics(model, base=base), np.array(model.home_rad)
    inverse, goal = InverseKinematicsSolver(arm), RigidTransform.of((0.6, 0.6, 0.6), (1.0, 0.0, 0.0, 0.0))
    first = inverse.nearest(goal, seed=home)
    base.stand_at(THERE)
    second = inverse.nearest(goal, seed=first)
    assert np.abs(second - first).max() > 0.1
    assert arm.tool_pose(second).distance_m(goal) < 1e-4
