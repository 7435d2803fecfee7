"""Joints along a path of the tool: away from their limits where the arm is redundant, and how far where it ends."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from engine.errors import RobotError
from robots.model.inverse_kinematics import pose_error
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.motion.tool_path import SINGULARITY_CAUTION, ToolPath, follow_tool_path
from tests.robots.panda_arm import BASE, home, panda_kinematics, panda_model


def path_along(poses: list[RigidTransform]) -> ToolPath:
    """A path through poses, evenly in time and length."""
    steps = np.array([pose_error(*pair) for pair in pairwise(poses)])
    lengths = np.linalg.norm(steps[:, :3], axis=1) + np.linalg.norm(steps[:, 3:], axis=1)
    return ToolPath(
        poses=poses,
        steps=steps,
        drifts=SINGULARITY_CAUTION * lengths,
        shares=np.linspace(0.0, 1.0, len(poses)),
        duration_s=2.0,
        word="path",
    )


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_on_its_way_a_redundant_arm_drifts_from_a_joint_limit(side: float) -> None:
    """A joint in the last tenth of its range leaves it as the tool goes to and fro, which keeps to its path."""
    start = home()
    start[6] = side * 0.95 * panda_model().limits.upper_rad[6]
    here = panda_kinematics().tool_pose(start)
    moves = np.linspace(0.0, 0.25, 51)
    there = [RigidTransform(xyz=here.xyz + np.array([0.0, -side * move, -move]), xyzw=here.xyzw) for move in moves]
    to_and_fro = [*there, *there[-2::-1]]
    path = path_along([*to_and_fro, *to_and_fro[1:], *to_and_fro[1:]])
    knots = follow_tool_path(panda_kinematics(), start, path)
    careless = follow_tool_path(panda_kinematics(), start, replace(path, drifts=np.zeros_like(path.drifts)))
    assert side * (start[6] - knots[-1, 6]) > 0.05
    assert side * (careless[-1, 6] - knots[-1, 6]) > 0.05
    for joints, pose in zip(knots[:51], there, strict=True):
        assert panda_kinematics().tool_pose(joints).distance_m(pose) < 1e-6


def test_in_the_middle_of_their_ranges_joints_do_not_drift() -> None:
    here = panda_kinematics().tool_pose(home())
    moves = np.linspace(0.0, 0.1, 21)
    path = path_along([RigidTransform(xyz=here.xyz + np.array([0.0, move, 0.0]), xyzw=here.xyzw) for move in moves])
    careless = replace(path, drifts=np.zeros_like(path.drifts))
    knots = [follow_tool_path(panda_kinematics(), home(), each) for each in (path, careless)]
    assert knots[0] == pytest.approx(knots[1], abs=1e-9)


def test_an_arm_of_few_joints_says_how_far_it_keeps_position_and_orientation() -> None:
    """About its first axis it does; then the tool would have to turn on the spot."""
    arm = ArmKinematics(robot_model("servo_arm"), base=BASE)
    start = np.array(robot_model("servo_arm").home_rad)
    poses = [arm.tool_pose(start + np.array([0.02 * step, 0.0])) for step in range(4)]
    turned = RigidTransform(xyz=poses[-1].xyz, xyzw=product(quaternion_of(np.array([0.3, 0.0, 0.0])), poses[-1].xyzw))
    with pytest.raises(RobotError, match=r"an arm of 2 joints cannot keep .* on this path beyond 60% of it"):
        follow_tool_path(arm, start, path_along([*poses, turned, turned]))
