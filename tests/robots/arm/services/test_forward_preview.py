"""Where an arm would be along an entry: the same as when it goes there."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import pytest

from engine.errors import SkillFailed
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.skills.dmp import LearnCartDmp, LearnJointDmp
from engine.skills.motion_trace import Trace, TraceMotion
from engine.store.entry_kinds import Joints
from robots.model.transform import RigidTransform
from tests.robots.arm.served import Served, served
from tests.robots.panda_arm import home, panda_kinematics

TIMES = np.linspace(0.0, 2.0, 201)
WAY = home() + np.outer(0.5 - 0.5 * np.cos(np.pi * TIMES / 2.0), (0.3, 0.2, 0.0, 0.2, 0.0, 0.1, 0.0))
LED = Trajectory(times_s=tuple(TIMES.tolist()), joints=tuple(map(tuple, WAY.tolist())))


async def traced(cell: Served, kind: Any, value: msgspec.Struct, most: int = 200) -> Trace:
    return await cell.bus.call(TraceMotion(kind=kind, value=msgspec.to_builtins(value), most=most), to="left")


def tool(joints: tuple[float, ...]) -> RigidTransform:
    return panda_kinematics().tool_pose(np.array(joints))


@pytest.mark.virtual
async def test_a_configuration_and_a_pose_are_where_the_arm_is_there() -> None:
    async with served() as cell:
        at = await traced(cell, "joints", Joints(joints=tuple(home().tolist())))
        pose = tool(tuple(home())).to_pose("world")
        there = await traced(cell, "pose", pose)
    assert np.allclose(at.joints, [home()])
    assert np.allclose(at.poses[0][:3], pose.xyz, atol=1e-9)
    assert np.allclose(tool(there.joints[0]).xyz, pose.xyz, atol=1e-4)


@pytest.mark.virtual
async def test_primitives_go_along_the_demonstration() -> None:
    """Within half a centiradian of each joint, and two millimetres of the tool."""
    async with served() as cell:
        joint = await cell.bus.call(LearnJointDmp(trajectory=LED), to="left")
        cart = await cell.bus.call(LearnCartDmp(trajectory=LED), to="left")
        led = await traced(cell, "trajectory", LED, most=50)
        by_joints = await traced(cell, "dmp", joint.dmp)
        by_tool = await traced(cell, "cart_dmp", cart.dmp)
    assert len(led.times_s) == 50
    assert (led.times_s[0], led.times_s[-1]) == (0.0, 2.0)
    for joint_at in range(7):
        wanted = np.interp(np.array(by_joints.times_s) + joint.fit.cut.start_s, TIMES, WAY[:, joint_at])
        assert np.abs(np.array(by_joints.joints)[:, joint_at] - wanted).max() < 5e-3
    assert np.linalg.norm(np.subtract(by_tool.poses[-1][:3], led.poses[-1][:3])) < 2e-3
    assert np.allclose(tool(by_tool.joints[-1]).xyz, by_tool.poses[-1][:3], atol=1e-3)


@pytest.mark.virtual
async def test_what_the_arm_cannot_do_is_said() -> None:
    async with served() as cell:
        far = await traced(cell, "pose", Pose(xyz=(3.0, 0.0, 0.3)))
        with pytest.raises(SkillFailed, match="the entry has 2 joints"):
            await traced(cell, "joints", Joints(joints=(0.0, 0.0)))
        with pytest.raises(SkillFailed, match="not a valid joints"):
            await traced(cell, "joints", Pose(xyz=(0.0, 0.0, 0.0)))
    assert far.joints == ()
    assert "out of reach" in far.remark
    assert far.poses[0][:3] == (3.0, 0.0, 0.3)
