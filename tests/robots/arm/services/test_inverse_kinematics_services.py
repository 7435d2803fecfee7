"""Inverse kinematics as services of an arm."""

from __future__ import annotations

import numpy as np
import pytest

from engine.errors import SkillFailed
from engine.messages import Pose
from engine.skills.arm_control import SetEndEffectorFrame
from engine.skills.motion import AllInverseKinematics, ForwardKinematics, InverseKinematics
from tests.robots.arm.served import served
from tests.robots.panda_arm import home

THERE = Pose(xyz=(-0.15, 0.2, 0.3), xyzw=(1.0, 0.0, 0.0, 0.0))


@pytest.mark.virtual
async def test_the_answer_puts_the_tool_where_it_was_asked_for() -> None:
    """Also with another tool centre point."""
    async with served() as cell:
        for offset_m in (0.0, 0.1):
            await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, offset_m)), to="left")
            found = await cell.bus.call(InverseKinematics(pose=THERE), to="left")
            reached = await cell.bus.call(ForwardKinematics(joints=found.joints), to="left")
            assert np.allclose(reached.xyz, THERE.xyz, atol=1e-4)
            assert (found.singular, found.remark) == (False, "")
            assert found.dexterity > 0.03


async def test_all_solutions_reach_the_pose_the_nearest_first() -> None:
    """In real time, beside the event loop."""
    seed = tuple(home().tolist())
    async with served() as cell:
        found = await cell.bus.call(AllInverseKinematics(pose=THERE, seed=seed), to="left")
        poses = [await cell.bus.call(ForwardKinematics(joints=joints), to="left") for joints in found.solutions]
    assert len(poses) > 3
    assert not found.complete
    assert all(np.allclose(pose.xyz, THERE.xyz, atol=1e-4) for pose in poses)


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("request_", "words"),
    [
        (InverseKinematics(pose=Pose(xyz=(3.0, 0.0, 0.3))), "is out of reach by"),
        (InverseKinematics(pose=Pose(xyz=(0.0, 0.0, 0.3), frame="tray")), "the frame 'tray' is not known"),
        (InverseKinematics(pose=THERE, seed=(0.1,)), "is not a configuration of panda"),
    ],
)
async def test_what_has_no_answer_fails_with_the_reason(request_: InverseKinematics, words: str) -> None:
    """As the motions that need it do."""
    async with served() as cell:
        with pytest.raises(SkillFailed, match=words):
            await cell.bus.call(request_, to="left")
