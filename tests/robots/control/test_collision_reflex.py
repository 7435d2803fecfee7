"""An arm that is pushed or runs into something harder than it was told to bear stops by itself, and says why."""

from __future__ import annotations

import asyncio
import os
import re

import numpy as np
import pytest

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.port import ArmPort, MotionEnd, Tolerance
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import (
    ABOVE_PART,
    HOME,
    both_hosts,
    both_hosts_nightly,
    move,
    one_arm,
    opened,
    smooth,
    until,
)

TORQUE = ControlSettings(collision_torque_nm=(15.0,) * 7)
FORCE = ControlSettings(collision_force_n=20.0)
TOOL = "left/panda_hand_tcp"
INTO_THE_TABLE = ABOVE_PART + np.array([0.0, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0])


async def tripped(world: SimWorld, *, push_s: float = 0.5) -> ArmPort:
    """An arm at rest that a push of half a second has tripped, and that has told why."""
    arm = world.arm("left")
    arm.configure(FORCE)
    told: list[str] = []
    arm.when_reflex(told.append)
    world.push(TOOL, force_n=(0.0, 0.0, -40.0), duration_s=push_s)
    await until(lambda: bool(told))
    return arm


@both_hosts
async def test_running_into_the_table_fails_with_joint_amount_threshold_and_contact(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        await move(arm, ABOVE_PART, 1.2)
        arm.configure(TORQUE)
        report = await move(arm, INTO_THE_TABLE, 2.0)
        assert report.end is MotionEnd.FAILED
        assert re.match(r"external torque limit exceeded: \S+ N m > 15 N m on panda_joint", report.reason)
        assert "touches fixture table" in report.reason
        sample = arm.sample()
        assert sample.reflex
        assert np.abs(sample.velocity_rad_s).max() < 0.02


@pytest.mark.virtual
async def test_it_presses_less_and_shorter_than_without_a_reflex() -> None:
    """At 0.3 s after the contact the force is a fraction."""

    async def pressed(settings: ControlSettings) -> float:
        async with opened(one_arm()) as world:
            arm = world.arm("left")
            await move(arm, ABOVE_PART, 1.2)
            arm.configure(settings)
            motion = arm.follow(smooth(ABOVE_PART, INTO_THE_TABLE, 2.0), tolerance=Tolerance())
            await until(lambda: float(np.linalg.norm(arm.sample().wrench[:3])) > 20.0)
            await asyncio.sleep(0.1)
            felt = float(np.linalg.norm(arm.sample().wrench[:3]))
            await motion.report()
            return felt

    assert await pressed(FORCE) < 0.35 * await pressed(ControlSettings())


@both_hosts_nightly
async def test_a_push_trips_an_arm_that_does_not_move_and_it_gives_way(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = await tripped(world, push_s=60.0)
        at = arm.sample()
        await until(lambda: arm.sample().time_s > at.time_s + 0.4)
        # Five times as soft as before: 40 N are 50 mm instead of 10.
        assert np.abs(arm.sample().position_rad - HOME).max() > 0.03
        world.push(TOOL, force_n=(0.0, 0.0, 0.0), duration_s=0.01)
        at = arm.sample()
        await until(lambda: arm.sample().time_s > at.time_s + 2.0)
        assert np.abs(arm.sample().position_rad - HOME).max() < 0.01


@both_hosts_nightly
async def test_nothing_starts_before_it_is_commanded_to_recover(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = await tripped(world)
        starts = (
            lambda: arm.follow(smooth(HOME, HOME + 0.1, 0.5), tolerance=Tolerance()),
            lambda: arm.stream("joint_position", watchdog_s=0.1),
            arm.guide,
        )
        for start in starts:
            with pytest.raises(RobotError, match=r"stopped by itself: external force limit exceeded: .*recover it"):
                start()
        await until(lambda: float(np.abs(arm.sample().wrench).max()) < 1.0)
        arm.recover()
        await until(lambda: not arm.sample().reflex)
        assert (await move(arm, HOME + 0.1, 0.6)).end is MotionEnd.REACHED


async def test_an_arm_that_has_stopped_is_refused_with_a_reason_before_it_has_reported_the_very_one() -> None:
    """Its state is seen at once, what it tells when the loop turns; nor is the reason of an earlier stop given."""
    async with opened(one_arm()) as world:
        arm = await tripped(world)
        assert "external force limit exceeded" in arm.reflex_reason
        await until(lambda: float(np.abs(arm.sample().wrench).max()) < 1.0)
        arm.recover()
        await until(lambda: not arm.sample().reflex)
        arm.configure(TORQUE)
        world.push(TOOL, force_n=(0.0, 60.0, 0.0), duration_s=60.0)
        while not arm.sample().reflex:
            os.sched_yield()
        said = arm.reflex_reason
        assert said
        assert "external force limit exceeded" not in said
        with pytest.raises(RobotError, match="the arm has stopped by itself: external force or torque limit exceeded"):
            arm.guide()
        await until(lambda: arm.reflex_reason.startswith("external torque limit exceeded: "))


@pytest.mark.virtual
async def test_recovering_holds_the_arm_where_it_stands_without_a_jump() -> None:
    async with opened(one_arm()) as world:
        arm = await tripped(world)
        await asyncio.sleep(0.2)
        arm.configure(ControlSettings())
        before = arm.sample().position_rad.copy()
        arm.recover()
        await asyncio.sleep(0.01)
        assert np.abs(arm.sample().desired_rad - before).max() < 0.003
        assert np.abs(arm.sample().position_rad - before).max() < 0.003


@pytest.mark.virtual
async def test_it_trips_again_when_what_presses_is_still_there() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        arm.configure(FORCE)
        world.push(TOOL, force_n=(0.0, 0.0, -40.0), duration_s=5.0)
        await until(lambda: arm.sample().reflex)
        await asyncio.sleep(0.5)
        arm.recover()
        await asyncio.sleep(0.05)
        assert arm.sample().reflex


@pytest.mark.virtual
async def test_without_thresholds_an_arm_never_stops_by_itself() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        world.push(TOOL, force_n=(0.0, 0.0, -60.0), duration_s=0.5)
        await asyncio.sleep(0.6)
        assert not arm.sample().reflex
        assert (await move(arm, HOME + 0.1, 0.6)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_its_own_fast_motion_trips_nothing() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        arm.configure(ControlSettings(collision_torque_nm=(4.0, 4.0, 4.0, 4.0, 1.0, 1.0, 1.0), collision_force_n=2.0))
        assert (await move(arm, ABOVE_PART, 0.8)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_the_hand_that_guides_is_no_collision() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        arm.configure(FORCE)
        led = arm.guide(damping=0.3)
        world.push(TOOL, force_n=(0.0, 30.0, 0.0), duration_s=0.3)
        await asyncio.sleep(0.3)
        assert not arm.sample().reflex
        await asyncio.sleep(1.0)
        led.finish()
        assert (await led.report()).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_reflex_survives_a_restore() -> None:
    async with opened(one_arm()) as world:
        await tripped(world)
        await asyncio.sleep(1.0)
        snapshot = world.snapshot()
    async with opened(one_arm()) as world:
        await world.restore(snapshot)
        arm = world.arm("left")
        await asyncio.sleep(0.01)
        assert arm.sample().reflex
        with pytest.raises(RobotError, match="stopped by itself: external force limit exceeded"):
            await move(arm, HOME)
        arm.recover()
        await asyncio.sleep(0.01)
        assert (await move(arm, HOME, 0.5)).end is MotionEnd.REACHED
