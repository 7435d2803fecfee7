"""An arm whose controller counts two axes together goes only where that controller would let it go."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.skill import Action
from engine.skills.jogging import StepJoints
from engine.skills.motion import CartLinTask, CartTrapVel, ForwardKinematics, JointTrapVel
from robots.model.registry import robot_model
from tests.robots.arm.served import Served, served

COUPLED = robot_model("irb4600", gripper=None, coupled_joints=True)
PLAIN = robot_model("irb4600", gripper=None)
BEYOND = (0.0, 0.8, 0.9, 0.0, 0.5, 0.0)
"""Each joint within its range, both together at 1.7 rad: the controller's axis 3 ends at 1.309."""
REASON = "the controller's angle of joint_3 (joint_3 + joint_2) would leave its range"


async def pose_of(cell: Served, joints: tuple[float, ...]) -> Pose:
    """Where the tool is then."""
    return await cell.bus.call(ForwardKinematics(joints=joints), to="left")


async def goals(cell: Served) -> tuple[Action[Any, Any], ...]:
    """Ways to be told to go there."""
    there = await pose_of(cell, BEYOND)
    return (
        JointTrapVel(joints=BEYOND, speed=0.5),
        CartTrapVel(pose=there, speed=0.5),
        StepJoints(step_rad=tuple(np.subtract(BEYOND, PLAIN.home_rad).tolist()), speed=0.5),
        CartLinTask(pose=there, duration_s=20.0),
    )


@pytest.mark.virtual
async def test_a_goal_beyond_the_range_of_the_coupled_axis_is_rejected_with_its_name() -> None:
    """Whichever way it is given; nothing moves."""
    async with served(model=COUPLED) as cell:
        ends = [await cell.bus.send_goal(goal, to="left").result() for goal in await goals(cell)]
        assert cell.port.followed == []
    assert [end.status for end in ends] == [GoalStatus.REJECTED] * 4
    for end in ends:
        assert end.cause is not None
        assert REASON in end.cause.message
        assert "range -3.1415926536 to 1.308996939 rad" in end.cause.message


@pytest.mark.virtual
async def test_without_the_option_the_same_arm_goes_there() -> None:
    async with served(model=PLAIN) as cell:
        for goal in await goals(cell):
            end = await cell.bus.send_goal(goal, to="left").result()
            assert end.status is GoalStatus.SUCCEEDED, end.cause
            await cell.bus.send_goal(JointTrapVel(joints=PLAIN.home_rad, speed=1.0), to="left").result()


@pytest.mark.virtual
async def test_an_arm_that_was_jogged_beyond_may_come_back() -> None:
    """Not further out."""
    async with served(model=COUPLED) as cell:
        cell.port.lead_to(BEYOND)
        out = await cell.bus.send_goal(
            JointTrapVel(joints=(0.0, 0.9, 0.9, 0.0, 0.5, 0.0), speed=0.5), to="left"
        ).result()
        back = await cell.bus.send_goal(JointTrapVel(joints=COUPLED.home_rad, speed=0.5), to="left").result()
    assert (out.status, back.status) == (GoalStatus.REJECTED, GoalStatus.SUCCEEDED)
