"""What a world tells on the bus: right latest values without readers, streams at their rates with them."""

from __future__ import annotations

import asyncio

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.messages import (
    ExternalTorque,
    FramePoses,
    GripperState,
    JointState,
    PartPoses,
    SceneDescription,
    Wrench,
)
from tests.robots.sim.sim_cell import HOME, box, move, one_arm, opened


@pytest.mark.virtual
async def test_latest_values_are_right_though_nobody_subscribes() -> None:
    async with opened(one_arm(box("part", (-0.09, 0.28, 0.2)))) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        await move(world.arm("left"), HOME + 0.1, 0.5)
        joints = bus.topic("left/joint_state", JointState).latest
        gripper = bus.topic("left/gripper/state", GripperState).latest
        parts = bus.topic("cell/parts", PartPoses).latest
        assert joints is not None
        assert gripper is not None
        assert parts is not None
        assert joints.position_rad == pytest.approx(tuple(HOME + 0.1), abs=0.002)
        assert (gripper.width_m, gripper.held) == (pytest.approx(0.08, abs=0.001), False)
        assert parts.poses["part"].xyz == pytest.approx((-0.09, 0.28, 0.02), abs=0.001)


@pytest.mark.virtual
async def test_streams_come_at_their_rates_in_world_time() -> None:
    async with opened(one_arm()) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        joints: list[float] = []
        frames: list[float] = []
        bus.topic("left/joint_state", JointState).subscribe(lambda message: joints.append(message.time_s))
        bus.topic("cell/frames", FramePoses).subscribe(lambda message: frames.append(message.time_s))
        await asyncio.sleep(1.0)
        assert len(joints) == 100
        assert 29 <= len(frames) <= 31
        assert joints == sorted(joints)


@pytest.mark.virtual
async def test_what_an_arm_feels_is_reported_as_wrench_and_joint_torques() -> None:
    async with opened(one_arm()) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        heard: list[Wrench] = []
        bus.topic("left/wrench", Wrench).subscribe(heard.append)
        world.push("left/panda_hand_tcp", force_n=(0.0, 12.0, 0.0), duration_s=2.0)
        await asyncio.sleep(1.0)
        torque = bus.topic("left/external", ExternalTorque).latest
        assert torque is not None
        # The tool is 0.307 m before the base's axis; friction holds back up to 1.1 N m.
        assert torque.torque_nm[0] == pytest.approx(12.0 * 0.307, abs=1.2)
        assert (torque.names[0], len(heard), heard[-1].frame) == ("panda_joint1", 100, "world")
        assert heard[-1].force_n == pytest.approx((0.0, 12.0, 0.0), abs=0.8)


async def test_streams_come_in_real_time_as_well() -> None:
    async with opened(one_arm()) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        stream = bus.topic("left/joint_state", JointState).stream()
        with stream:
            first, second = await stream.next(), await stream.next()
        assert second.time_s > first.time_s


@pytest.mark.virtual
async def test_every_frame_that_is_drawn_has_a_pose() -> None:
    async with opened(one_arm(box("part"))) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        scene = bus.topic("cell/scene", SceneDescription).latest
        poses = bus.topic("cell/frames", FramePoses).latest
        assert scene is not None
        assert poses is not None
        drawn = {geometry.frame for geometry in scene.geometries}
        assert drawn <= {"world", *poses.names}
        assert {"world", "part", "left/panda_hand", "left/panda_leftfinger"} <= drawn
