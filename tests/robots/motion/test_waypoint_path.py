"""Waypoints become configurations near one another, or say by their index why not."""

from __future__ import annotations

import numpy as np
import pytest

from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform
from robots.motion.waypoint_path import waypoint_joints
from robots.port import Array
from tests.robots.panda_arm import home, panda_kinematics

UR10 = ArmKinematics(robot_model("ur10"), base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))


def panda(*waypoints: Array | RigidTransform, match: PoseMatch = PoseMatch.POSE) -> Array:
    return waypoint_joints(panda_kinematics(), home(), waypoints, match=match)


def beside(joints: Array, x_m: float) -> RigidTransform:
    tool = panda_kinematics().tool_pose(joints)
    return RigidTransform(xyz=tool.xyz + np.array((x_m, 0.0, 0.0)), xyzw=tool.xyzw)


def test_a_pose_becomes_the_configuration_nearest_to_the_previous_waypoint() -> None:
    turned = home() + np.array([0.6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    rows = panda(turned, beside(turned, 0.03))
    assert np.array_equal(rows[:2], (home(), turned))
    assert np.abs(rows[2] - turned).max() < 0.2
    assert panda_kinematics().tool_pose(rows[2]).distance_m(beside(turned, 0.03)) < 1e-4


def test_a_swing_around_the_base_is_no_change_of_configuration() -> None:
    across = home() + np.array([2.6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    rows = panda(panda_kinematics().tool_pose(across))
    assert panda_kinematics().tool_pose(rows[1]).distance_m(panda_kinematics().tool_pose(across)) < 1e-4


@pytest.mark.parametrize(
    ("waypoint", "message"),
    [
        (beside(home(), 2.0), r"^waypoints\[1\]: .*out of reach"),
        (home() + 4.0, r"^waypoints\[1\]: panda_joint1 cannot go to 4"),
        (home()[:3], r"^waypoints\[1\]: the goal has 3 joints"),
        (home() * np.nan, r"^waypoints\[1\]: panda_joint1 cannot go to nan"),
    ],
)
def test_a_waypoint_out_of_reach_is_refused_by_its_index(waypoint: Array | RigidTransform, message: str) -> None:
    with pytest.raises(RobotError, match=message):
        panda(home(), waypoint, home())


def test_a_pose_in_another_configuration_is_refused_and_its_joints_are_taken() -> None:
    """A wrist that stands at the end of its range would have to turn the other way round."""
    before = np.array([0.3, -1.2, 1.6, -1.9, -1.5, 6.2])
    after = before + np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.3])
    tool = UR10.tool_pose(after)
    found = InverseKinematicsSolver(UR10).nearest(tool, seed=before)
    assert np.abs(found - before).max() > 1.0
    with pytest.raises(
        RobotError, match=r"^waypoints\[0\]: the pose needs another configuration of the arm: .* rad"
    ) as error:
        waypoint_joints(UR10, before, (tool,), match=PoseMatch.POSE)
    assert error.value.hint == "add a waypoint between, or give the joints"
    assert np.array_equal(waypoint_joints(UR10, before, (found,), match=PoseMatch.POSE)[1], found)
    # Where only the position counts, the tool need not turn.
    position = waypoint_joints(UR10, before, (tool,), match=PoseMatch.POSITION)
    assert np.abs(position[1] - before).max() < 0.1
