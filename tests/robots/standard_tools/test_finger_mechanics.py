"""Friction alone holds a part: lifted, carried, released, or lost when it is too heavy.

All in virtual time: a sleep lets simulated seconds pass, in which what is held must not slip.
"""

from __future__ import annotations

import asyncio
import math

import msgspec
import pytest

from engine.messages import Pose
from robots.port import MotionEnd
from tests.robots.sim.sim_cell import (
    ABOVE_PART,
    AT_PART,
    LIFTED,
    PART_XYZ,
    box,
    grasp,
    move,
    one_arm,
    opened,
    part_xyz,
    until,
)


@pytest.mark.virtual
async def test_a_grasped_part_is_lifted_held_and_falls_when_released() -> None:
    async with opened(one_arm(box("part"))) as world:
        gripper = world.gripper("left")
        await grasp(world)
        sample = gripper.sample()
        assert sample.contacts == ("part", "part")
        assert sample.width_m == pytest.approx(0.03, abs=0.0005)
        assert sample.force_n == pytest.approx(20.0, abs=1.0)

        assert (await move(world.arm("left"), LIFTED)).end is MotionEnd.REACHED
        await asyncio.sleep(2.0)
        x, y, z = part_xyz(world, "part")
        assert (x, y) == pytest.approx(PART_XYZ[:2], abs=0.002)
        assert z == pytest.approx(PART_XYZ[2] + 0.178, abs=0.002)

        assert (await gripper.close_to(width_m=0.08, speed_m_s=0.2, force_n=20.0).report()).end is MotionEnd.REACHED
        await until(lambda: part_xyz(world, "part")[2] < 0.035)
        assert gripper.sample().contacts == ("", "")


@pytest.mark.virtual
async def test_a_part_jammed_askew_between_the_pads_is_pressed_with_the_whole_force_for_as_long_as_it_is_held() -> None:
    turned = Pose(xyz=PART_XYZ, xyzw=(0.0, 0.0, math.sin(0.1), math.cos(0.1)))
    async with opened(one_arm(msgspec.structs.replace(box("part"), pose=turned))) as world:
        await grasp(world)
        await move(world.arm("left"), LIFTED)
        for _ in range(3):
            await asyncio.sleep(0.5)
            sample = world.gripper("left").sample()
            assert sample.contacts == ("part", "part")
            assert sample.force_n == pytest.approx(20.0, abs=1.0)


@pytest.mark.virtual
async def test_an_arm_that_carries_the_part_reaches_its_goal_within_five_milliradians() -> None:
    async with opened(one_arm(box("part"))) as world:
        await grasp(world)
        assert (await move(world.arm("left"), LIFTED)).end is MotionEnd.REACHED
        sample = world.arm("left").sample()
        assert abs(sample.position_rad - LIFTED).max() < 0.005


@pytest.mark.virtual
async def test_a_part_of_forty_kilograms_slips_out_of_the_fingers_and_stays() -> None:
    async with opened(one_arm(box("ingot", mass_kg=40.0))) as world:
        await grasp(world, force_n=40.0)
        report = await move(world.arm("left"), LIFTED)
        assert part_xyz(world, "ingot")[2] < 0.03
        if report.end is MotionEnd.FAILED:
            assert "ingot" in report.reason
        else:
            assert world.gripper("left").sample().contacts == ("", "")


@pytest.mark.virtual
async def test_a_hand_that_runs_onto_a_part_fails_naming_it() -> None:
    async with opened(one_arm(box("ingot", mass_kg=40.0))) as world:
        await world.gripper("left").close_to(width_m=0.0, speed_m_s=0.1, force_n=30.0).report()
        await move(world.arm("left"), ABOVE_PART, 1.2)
        report = await move(world.arm("left"), AT_PART)
        assert report.end is MotionEnd.FAILED
        assert "finger touches part ingot" in report.reason


@pytest.mark.virtual
async def test_without_a_part_the_fingers_close_on_nothing() -> None:
    async with opened(one_arm()) as world:
        await grasp(world)
        sample = world.gripper("left").sample()
        assert sample.contacts == ("", "")
        assert sample.width_m < 0.001


@pytest.mark.virtual
async def test_the_fingers_open_to_a_width_at_a_speed() -> None:
    async with opened(one_arm()) as world:
        gripper = world.gripper("left")
        start = world.measured().time_s
        report = await gripper.close_to(width_m=0.03, speed_m_s=0.1, force_n=30.0).report()
        assert report.end is MotionEnd.REACHED
        assert gripper.sample().width_m == pytest.approx(0.03, abs=0.001)
        assert 0.5 < world.measured().time_s - start < 0.8


@pytest.mark.virtual
async def test_fingers_cancelled_on_their_way_stop_there() -> None:
    async with opened(one_arm()) as world:
        gripper = world.gripper("left")
        motion = gripper.close_to(width_m=0.0, speed_m_s=0.05, force_n=30.0)
        await until(lambda: gripper.sample().width_m < 0.05)
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert gripper.sample().width_m == pytest.approx(0.05, abs=0.005)
        assert abs(gripper.sample().velocity_m_s) < 0.002


@pytest.mark.virtual
async def test_pressing_harder_on_a_held_part_does_not_drop_it() -> None:
    async with opened(one_arm(box("part"))) as world:
        await grasp(world)
        await move(world.arm("left"), LIFTED)
        await world.gripper("left").close_to(width_m=0.0, speed_m_s=0.05, force_n=40.0).report()
        assert world.gripper("left").sample().force_n == pytest.approx(40.0, abs=2.0)
        assert part_xyz(world, "part")[2] > 0.19
