"""A world's ports, the same over both hosts: follow, hold, resume, cancel, refuse, stop.

On the virtual loop a sleep lets simulated time pass, and nothing else.
"""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.errors import RobotError
from engine.robot import DeviceStatus
from robots.port import MotionEnd, Tolerance
from tests.robots.sim.sim_cell import (
    ABOVE_PART,
    HOME,
    PANDA,
    both_hosts,
    both_hosts_nightly,
    move,
    one_arm,
    opened,
    smooth,
    two_arms,
    unhurried,
    until,
)


@both_hosts
async def test_an_arm_reaches_its_goal(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, ABOVE_PART, 0.8), tolerance=Tolerance())
        report = await motion.report()
        assert (report.end, report.reason, motion.progress) == (MotionEnd.REACHED, "", 1.0)
        assert np.abs(arm.sample().position_rad - ABOVE_PART).max() < 0.005


@pytest.mark.virtual
async def test_two_arms_move_at_the_same_time() -> None:
    async with opened(two_arms()) as world:
        reports = await asyncio.gather(*(move(world.arm(name), HOME + 0.2, 0.5) for name in ("left", "right")))
        assert [report.end for report in reports] == [MotionEnd.REACHED] * 2
        assert world.measured().time_s < 1.5


async def test_two_arms_move_at_the_same_time_in_real_time_as_well() -> None:
    """One measurement finds both on their way."""
    async with opened(two_arms()) as world:
        way = smooth(HOME, HOME + 1.0, 60.0)
        motions = [world.arm(name).follow(way, tolerance=Tolerance()) for name in ("left", "right")]

        def slower_rad_s() -> float:
            measured = world.measured()
            return min(float(np.abs(measured.arm(name).velocity_rad_s).max()) for name in ("left", "right"))

        await until(lambda: slower_rad_s() > 0.002)
        for motion in motions:
            motion.cancel()
        assert [(await motion.report()).end for motion in motions] == [MotionEnd.CANCELED] * 2


@both_hosts_nightly
async def test_a_cancelled_motion_ends_at_rest_on_its_path_and_the_next_is_accepted_at_once(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, HOME + 0.6, unhurried(host, 1.0)), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.45)
        motion.cancel()
        report = await motion.report()
        sample = arm.sample()
        assert report.end is MotionEnd.CANCELED
        assert 0.4 < motion.progress < 0.9
        assert np.abs(sample.velocity_rad_s).max() < 0.02
        # All joints of this path advance alike, so on the path they are equally far.
        assert np.ptp(sample.desired_rad - HOME) < 1e-9
        assert (await move(arm, HOME, 0.6)).end is MotionEnd.REACHED


@both_hosts
async def test_a_held_motion_rests_until_it_is_resumed_and_then_reaches_its_goal(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, HOME + 0.3, unhurried(host, 0.8)), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.45)
        await motion.hold()
        held = motion.progress
        at = arm.sample()
        await until(lambda: world.measured().time_s > at.time_s + 0.2)
        assert np.abs(arm.sample().position_rad - at.position_rad).max() < 0.002
        assert motion.progress == held < 1.0
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED


@both_hosts
async def test_a_second_motion_is_refused_while_one_runs(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        arm.follow(smooth(HOME, HOME + 0.2, 1.0), tolerance=Tolerance())
        with pytest.raises(RobotError, match="another motion is active"):
            arm.follow(smooth(HOME, HOME + 0.2, 1.0), tolerance=Tolerance())


@both_hosts
async def test_stopping_the_world_cancels_what_runs_and_leaves_it_at_rest(host: str) -> None:
    async with opened(one_arm()) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.5, unhurried(host, 1.0)), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.45)
        assert world.status is DeviceStatus.MOVING
        await world.stop()
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert np.abs(world.arm("left").sample().velocity_rad_s).max() < 0.02
        assert world.status is DeviceStatus.READY


@pytest.mark.virtual
async def test_holding_and_resuming_at_once_answers_both() -> None:
    async with opened(one_arm()) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.3, 0.6), tolerance=Tolerance())
        await asyncio.sleep(0.2)
        await asyncio.gather(motion.hold(), motion.resume())
        assert (await motion.report()).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_motion_may_be_awaited_by_several_and_after_its_end() -> None:
    async with opened(one_arm()) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.1, 0.3), tolerance=Tolerance())
        impatient = asyncio.create_task(motion.report())
        await asyncio.sleep(0.1)
        impatient.cancel()
        first = await motion.report()
        assert first == await motion.report()
        assert first.end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_trajectory_that_starts_elsewhere_is_refused_naming_the_joint() -> None:
    async with opened(one_arm()) as world:
        start = HOME.copy()
        start[3] += 0.2
        with pytest.raises(RobotError, match=r"0\.2 rad from the set point of panda_joint4"):
            world.arm("left").follow(smooth(start, HOME, 1.0), tolerance=Tolerance())


@pytest.mark.virtual
async def test_an_arm_that_runs_into_the_table_fails_with_joint_amount_and_contact_and_then_gives_way() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        await move(arm, ABOVE_PART, 1.2)
        report = await move(arm, ABOVE_PART + np.array([0.0, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0]), 2.0)
        assert report.end is MotionEnd.FAILED
        assert "rad behind its set point" in report.reason
        assert report.reason.startswith("panda_joint")
        assert "touches fixture table" in report.reason
        sample = arm.sample()
        assert np.abs(sample.desired_rad - sample.position_rad).max() < 0.02
        assert (await move(arm, HOME, 1.5)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_cancelling_a_fast_motion_keeps_within_the_joints_accelerations() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, HOME + np.array([1.0, 0, 0, 0, 0, 0, 0]), 1.0), tolerance=Tolerance())
        await asyncio.sleep(0.5)
        motion.cancel()
        speeds = [arm.sample().velocity_rad_s]
        for _ in range(300):
            await asyncio.sleep(0.001)
            speeds.append(arm.sample().velocity_rad_s)
        acceleration = np.abs(np.diff(np.array(speeds), axis=0)).max(axis=0) / 0.001
        assert acceleration[0] < PANDA.limits.acceleration_rad_s2[0] * 1.05
        assert motion.progress < 1.0
        assert (await motion.report()).end is MotionEnd.CANCELED


@pytest.mark.virtual
async def test_nothing_passes_in_lockstep_unless_time_does() -> None:
    async with opened(one_arm()) as world:
        before = world.measured().time_s
        await asyncio.sleep(0)
        assert world.measured().time_s == before
        await asyncio.sleep(0.25)
        assert world.measured().time_s == pytest.approx(before + 0.25)
