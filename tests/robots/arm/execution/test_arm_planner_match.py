"""What of a pose counts: all of it, the position, or position and direction of the tool's axis."""

from __future__ import annotations

import numpy as np
import pytest

from engine.bus import GoalEnd, GoalStatus
from engine.errors import SkillFailed
from engine.messages import Pose
from engine.skills.motion import (
    AllInverseKinematics,
    CartMotionResult,
    CartTrapVel,
    ForwardKinematics,
    InverseKinematics,
    PoseMatch,
)
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform
from tests.robots.arm.served import Served, served

SERVO_ARM = robot_model("servo_arm")
CYLINDER = Pose(xyz=(0.0, 0.225, 0.275))
"""On the sphere that the claw can reach, in an orientation that it cannot have there."""


async def moved(cell: Served, pose: Pose, match: PoseMatch) -> GoalEnd[CartMotionResult]:
    """Send the arm there and return how it ended."""
    return await cell.bus.send_goal(CartTrapVel(pose=pose, speed=0.5, match=match), to="left").result()


@pytest.mark.virtual
async def test_an_arm_of_two_joints_goes_to_a_position_in_the_orientation_it_has_there() -> None:
    async with served(model=SERVO_ARM) as cell:
        base = cell.arm.description().base
        pose = Pose(xyz=tuple(np.add(base.xyz, CYLINDER.xyz).tolist()))
        end = await moved(cell, pose, "position")
    assert end.result is not None, end.cause
    assert np.allclose(end.result.pose.xyz, pose.xyz, atol=1e-4)


@pytest.mark.virtual
@pytest.mark.parametrize(("off_m", "status"), [(0.0008, GoalStatus.SUCCEEDED), (0.002, GoalStatus.REJECTED)])
async def test_a_position_less_than_a_millimetre_off_its_sphere_will_do(off_m: float, status: GoalStatus) -> None:
    """As somebody writes it down; the claw goes to the nearest position on the sphere, and what is missing is told."""
    async with served(model=SERVO_ARM) as cell:
        base = cell.arm.description().base
        end = await moved(cell, Pose(xyz=tuple(np.add(base.xyz, (0.0, 0.225 + off_m, 0.275)).tolist())), "position")
    assert end.status is status
    if end.result is not None:
        assert np.allclose(end.result.pose.xyz, np.add(base.xyz, CYLINDER.xyz), atol=1e-4)
    else:
        assert end.cause is not None
        assert "is out of reach by 0.002 m" in end.cause.message


@pytest.mark.virtual
async def test_a_whole_pose_is_refused_by_an_arm_of_two_joints_that_says_what_to_ask_for() -> None:
    """Nothing moves."""
    async with served(model=SERVO_ARM) as cell:
        base = cell.arm.description().base
        end = await moved(cell, Pose(xyz=tuple(np.add(base.xyz, CYLINDER.xyz).tolist())), "pose")
        assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])
    assert end.cause is not None
    assert "is reachable, but not in this orientation" in end.cause.message
    assert "an arm of 2 joints cannot choose its orientation: request the position only (`match`)" in end.cause.message


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("match", "x_m", "whole"),
    [("position", 0.28, GoalStatus.REJECTED), ("axis", 0.2, GoalStatus.SUCCEEDED)],
)
async def test_what_does_not_count_comes_as_it_comes(match: PoseMatch, x_m: float, whole: GoalStatus) -> None:
    """So far out a Panda cannot point down; nearer it can, and needs not turn its hand for it."""
    goal = Pose(xyz=(x_m, 0.0, 0.2), xyzw=(float(np.cos(1.2)), float(np.sin(1.2)), 0.0, 0.0))
    async with served() as cell:
        end = await moved(cell, goal, match)
        assert (await moved(cell, goal, "pose")).status is whole
    assert end.result is not None, end.cause
    reached = RigidTransform.from_pose(end.result.pose)
    assert np.allclose(reached.xyz, goal.xyz, atol=1e-4)
    assert reached.angle_rad(RigidTransform.from_pose(goal)) > 0.1
    assert (float(reached.rotation[2, 2]) == pytest.approx(-1.0, abs=1e-4)) is (match == "axis")


@pytest.mark.virtual
async def test_the_services_of_inverse_kinematics_know_the_match_as_well() -> None:
    async with served(model=SERVO_ARM) as cell:
        base = cell.arm.description().base
        pose = Pose(xyz=tuple(np.add(base.xyz, CYLINDER.xyz).tolist()))
        one = await cell.bus.call(InverseKinematics(pose=pose, match="position"), to="left")
        every = await cell.bus.call(AllInverseKinematics(pose=pose, match="position"), to="left")
        assert np.allclose(every.solutions[0], one.joints, atol=1e-4)
        there = await cell.bus.call(ForwardKinematics(joints=one.joints), to="left")
        assert np.allclose(there.xyz, pose.xyz, atol=1e-4)
        with pytest.raises(SkillFailed, match="but not in this orientation"):
            await cell.bus.call(InverseKinematics(pose=pose), to="left")
