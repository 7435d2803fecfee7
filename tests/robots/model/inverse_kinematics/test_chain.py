"""The numbers that fast kinematics works on are those of the arm."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from engine.errors import CellError
from robots.model.inverse_kinematics import PoseMatch
from robots.model.inverse_kinematics.chain import KinematicChain, chain_of, matrix_of, tool_at
from robots.model.inverse_kinematics.fast_kinematics import FastKinematics, is_solved, new_fast_kinematics
from robots.model.inverse_kinematics.ideal_arm import ideal_arm
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array
from tests.robots.model.inverse_kinematics.ik_arms import ARMS, arm, at_shares, shares


@pytest.mark.parametrize("name", [*ARMS, "servo_arm"])
@settings(max_examples=30, deadline=None)
@given(shares())
def test_the_compiled_tool_pose_is_that_of_pinocchio(name: str, share: Array) -> None:
    """Within 1e-12 metres and entries of the rotation, everywhere within the limits."""
    kinematics = arm(name)
    joints = at_shares(kinematics, share)
    expected = matrix_of(kinematics.tool_pose(joints))
    assert np.abs(new_fast_kinematics(kinematics).lines(joints)[2] - expected).max() < 1e-12
    assert np.abs(tool_at(chain_of(kinematics), joints) - expected).max() < 1e-12


def test_the_tool_centre_point_of_a_tool_in_hand_is_the_end_of_the_chain() -> None:
    """Each tool has a chain of its own."""
    held = arm("ur10").with_tool(RigidTransform.of((0.02, 0.01, 0.3), (0.0, 0.3, 0.0, 1.0)))
    joints = np.array([0.4, -1.2, 1.1, -0.7, 0.9, 0.3])
    assert np.abs(new_fast_kinematics(held).lines(joints)[2] - matrix_of(held.tool_pose(joints))).max() < 1e-12


def test_an_arm_that_is_no_chain_of_single_joints_is_refused() -> None:
    """Rather than solved wrongly."""

    class Sagging(ArmKinematics):
        def tool_pose(self, joints: Array) -> RigidTransform:
            pose = super().tool_pose(joints)
            return RigidTransform(xyz=pose.xyz - [0.0, 0.0, 1e-6 * float(joints @ joints)], xyzw=pose.xyzw)

    with pytest.raises(CellError, match=r"not a serial chain of one-axis joints: tool pose error "):
        chain_of(Sagging(arm("ur10").model, base=arm("ur10").base))


def test_sliding_joints_are_moved_to_the_goal() -> None:
    """A gantry of three axes, of which the second is at its limit on the way."""
    chain = _gantry()
    gantry = FastKinematics(chain=chain, ideal=ideal_arm(chain), analytic=None)
    goal = np.column_stack((np.eye(3), [0.3, -0.5, 0.9]))
    found = gantry.descend(goal, PoseMatch.POSITION, np.array([0.0, 0.5, 0.0]), near=np.zeros(3))
    assert is_solved(found)
    assert np.abs(found.joints - [0.3, -0.5, 0.9]).max() < 1e-6


def _gantry() -> KinematicChain:
    along_x = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    placements = np.zeros((4, 3, 4))
    rotation = np.eye(3)
    for placement, frame in zip(placements, [along_x, along_x @ along_x, np.eye(3), np.eye(3)], strict=True):
        placement[:, :3] = rotation.T @ frame
        rotation = frame
    return KinematicChain(
        placements=placements,
        sliding=np.array([True, True, True]),
        bounds=np.array([[-1.0] * 3, [1.0] * 3, [1.0] * 3]),
        axes=np.eye(3),
        points=np.zeros((3, 3)),
        tool=np.column_stack((np.eye(3), np.zeros(3))),
    )
