"""`<arm>/device_joints`: what the robot's own controller would show, of arms where that is not the same."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.messages import JointState, Pose
from robots.model.registry import model_by_name
from robots.port import Tolerance
from robots.scene.sim_scene import ArmPlacement, SimScene
from tests.robots.sim.sim_cell import opened, smooth


def one(model: str, *, coupled_joints: bool = False) -> SimScene:
    """A cell with one arm."""
    placement = ArmPlacement(
        name="arm", model=model, gripper=None, base=Pose(xyz=(0.0, 0.0, 0.0)), coupled_joints=coupled_joints
    )
    return SimScene(arms=(placement,))


@pytest.mark.virtual
async def test_a_coupled_axis_is_shown_as_its_controller_counts_it_position_speed_and_torque() -> None:
    """Axis 3 is joint 3 plus joint 2; what turns axis 3 alone turns nothing else, so the torques differ at axis 2."""
    async with opened(one("irb4600", coupled_joints=True)) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        arm = world.arm("arm")
        start = arm.sample().desired_rad
        path = smooth(
            start, start + np.array((0.0, 0.3, 0.1, 0.0, 0.0, 0.0)), 2.0, limits=model_by_name("irb4600").limits
        )
        arm.follow(path, tolerance=Tolerance())
        await asyncio.sleep(1.0)
        joints = bus.topic("arm/joint_state", JointState).latest
        device = bus.topic("arm/device_joints", JointState).latest
        heard: list[JointState] = []
        bus.topic("arm/device_joints", JointState).subscribe(heard.append)
        await asyncio.sleep(0.5)
        assert 45 <= len(heard) <= 55
    assert joints is not None
    assert device is not None
    added = np.array(((0, 0, 0, 0, 0, 0), (0, 0, 0, 0, 0, 0), (0, 1, 0, 0, 0, 0), *((0,) * 6,) * 3))
    assert device.names == joints.names
    assert np.allclose(device.position_rad, np.array(joints.position_rad) + added @ joints.position_rad)
    assert np.allclose(device.velocity_rad_s, np.array(joints.velocity_rad_s) + added @ joints.velocity_rad_s)
    assert abs(device.velocity_rad_s[2]) > abs(joints.velocity_rad_s[2]) + 0.1
    power = np.dot(joints.effort_nm, joints.velocity_rad_s)
    assert np.dot(device.effort_nm, device.velocity_rad_s) == pytest.approx(power)


@pytest.mark.virtual
async def test_the_servos_of_the_small_arm_show_0_and_160_degrees_at_home() -> None:
    async with opened(one("servo_arm")) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        device = bus.topic("arm/device_joints", JointState).latest
    assert device is not None
    assert np.degrees(device.position_rad) == pytest.approx((0.0, 160.0), abs=0.1)


@pytest.mark.virtual
@pytest.mark.parametrize("model", ["irb4600", "ur10"])
async def test_where_both_are_the_same_nothing_is_reported_twice(model: str) -> None:
    async with opened(one(model)) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        names = {entry.name for entry in bus.listing()}
    assert "arm/joint_state" in names
    assert "arm/device_joints" not in names
