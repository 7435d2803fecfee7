"""The state that reads the pose of an arm."""

from __future__ import annotations

import math

import pytest

from engine.errors import SkillFailed
from engine.messages import Pose, Wrench
from engine.messages.pose_algebra import compose_poses
from engine.skills.arm_control import ArmStatus, ControlSettings
from engine.state import Outcome
from states.motion.read_pose import ReadPose
from tests.states.fake_context import FakeContext

HALF = math.sqrt(0.5)
LINK = Pose(xyz=(0.4, 0.1, 0.5), xyzw=(HALF, 0.0, 0.0, HALF))
TIP = Pose(xyz=(0.01, 0.02, 0.13), xyzw=(0.0, 0.0, HALF, HALF))


def arm() -> FakeContext:
    """An arm with a tool centre point of its own."""
    status = ArmStatus(
        mode="idle",
        settings=ControlSettings(tool_xyz_m=TIP.xyz, tool_xyzw=TIP.xyzw),
        external_nm=(),
        wrench=Wrench(force_n=(0.0, 0.0, 0.0), torque_nm=(0.0, 0.0, 0.0), frame="world"),
    )
    return FakeContext({"left/forward_kinematics": compose_poses(LINK, TIP), "left/read_arm": status})


async def test_the_pose_is_that_of_the_tool_centre_point() -> None:
    assert await ReadPose(robot="left").run(arm()) == Outcome("read", {"pose": compose_poses(LINK, TIP)})


async def test_the_pose_of_the_tool_link_does_not_depend_on_the_tool_centre_point() -> None:
    outcome = await ReadPose(robot="left", of="tool_link").run(arm())
    pose = outcome.outputs["pose"]
    assert isinstance(pose, Pose)
    assert (pose.xyz, pose.xyzw) == (pytest.approx(LINK.xyz), pytest.approx(LINK.xyzw))


async def test_an_arm_that_cannot_be_read_is_an_outcome_with_the_reason() -> None:
    lost = FakeContext({"left/forward_kinematics": SkillFailed("the arm is not connected", where="left")})
    outcome = await ReadPose(robot="left").run(lost)
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert outcome.cause.chain()[-1].message == "the arm is not connected"
