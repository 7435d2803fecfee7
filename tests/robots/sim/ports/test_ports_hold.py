"""Holding, resuming and cancelling motions in a world: always on the path, at rest when it says so, to the same end."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from robots.control.commanding.motion_registry import CommandedMotion
from robots.port import MotionEnd, Tolerance
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import HOME, both_hosts_nightly, one_arm, opened, smooth, unhurried, until
from tests.tiers import nightly

GOAL = HOME + np.array([0.6, 0.3, -0.3, 0.3, 0.2, -0.2, 0.4])
DURATION_S = 1.2
REST_RAD_S = 0.02
# What the arm is off its set point by while it brakes as hard as it may.
OFF_PATH_RAD = 0.004


def start(world: SimWorld, host: str = "lockstep") -> CommandedMotion:
    """Send the arm to the goal."""
    way = smooth(HOME, GOAL, unhurried(host, DURATION_S))
    motion = world.arm("left").follow(way, tolerance=Tolerance())
    assert isinstance(motion, CommandedMotion)
    return motion


def speed_rad_s(world: SimWorld) -> float:
    """Return the speed of the fastest joint."""
    return float(np.abs(world.arm("left").sample().velocity_rad_s).max())


def off_path_rad(world: SimWorld) -> float:
    """Return how far the measured joints are from the straight line between start and goal."""
    off = world.arm("left").sample().position_rad - HOME
    along = (GOAL - HOME) / np.linalg.norm(GOAL - HOME)
    return float(np.abs(off - along * (off @ along)).max())


async def watch_path(world: SimWorld, motion: CommandedMotion) -> float:
    """Return the greatest distance from the path that was measured until the motion ended."""
    worst = 0.0

    def ended() -> bool:
        nonlocal worst
        worst = max(worst, off_path_rad(world))
        return motion.ended

    await until(ended, within_s=30.0)
    return worst


async def check_arrived(world: SimWorld, motion: CommandedMotion) -> None:
    """The motion ends where it would have ended without all that."""
    assert (await motion.report()).end is MotionEnd.REACHED
    assert motion.progress == 1.0
    assert np.abs(world.arm("left").sample().position_rad - GOAL).max() < 0.003
    assert speed_rad_s(world) < REST_RAD_S


@both_hosts_nightly
async def test_an_arm_is_held_on_its_path_and_goes_on_along_it(host: str) -> None:
    """Thrice, at different speeds."""
    async with opened(one_arm()) as world:
        motion = start(world, host)
        watching = asyncio.create_task(watch_path(world, motion))
        for progress in (0.2, 0.5, 0.8):
            await until(lambda progress=progress: motion.progress > progress)
            assert speed_rad_s(world) > 0.1 * DURATION_S / unhurried(host, DURATION_S)
            await motion.hold()
            assert speed_rad_s(world) < REST_RAD_S
            held, at = motion.progress, world.arm("left").sample()
            await until(lambda at=at: world.measured().time_s > at.time_s + 0.1)
            assert motion.progress == held < 1.0
            assert np.abs(world.arm("left").sample().position_rad - at.position_rad).max() < 0.001
            await motion.resume()
        await check_arrived(world, motion)
        assert await watching < OFF_PATH_RAD


@both_hosts_nightly
async def test_a_hold_while_one_is_under_way_or_done_is_confirmed_as_well(host: str) -> None:
    async with opened(one_arm()) as world:
        motion = start(world, host)
        await until(lambda: motion.progress > 0.5)
        first = asyncio.create_task(motion.hold())
        await until(lambda: motion.progress > 0.51)
        second = asyncio.create_task(motion.hold())
        await asyncio.gather(first, second)
        assert speed_rad_s(world) < REST_RAD_S
        await motion.hold()
        assert speed_rad_s(world) < REST_RAD_S
        await motion.resume()
        await check_arrived(world, motion)


@both_hosts_nightly
async def test_a_resume_while_the_arm_brakes_lets_it_go_on_at_once_and_answers_the_hold(host: str) -> None:
    async with opened(one_arm()) as world:
        motion = start(world, host)
        watching = asyncio.create_task(watch_path(world, motion))
        await until(lambda: motion.progress > 0.5)
        full = speed_rad_s(world)
        holding = asyncio.create_task(motion.hold())
        await until(lambda: speed_rad_s(world) < 0.8 * full)
        await motion.resume()
        await holding
        await until(lambda: speed_rad_s(world) > 0.3 * full, within_s=1.0 if host == "lockstep" else 10.0)
        await check_arrived(world, motion)
        assert await watching < OFF_PATH_RAD


@both_hosts_nightly
async def test_a_hold_right_after_a_resume_is_confirmed_at_rest_only(host: str) -> None:
    """The answer to the resume, still on its way, is none to the hold."""
    async with opened(one_arm()) as world:
        motion = start(world, host)
        await until(lambda: motion.progress > 0.4)
        await motion.hold()
        for _ in range(5):
            resuming = asyncio.create_task(motion.resume())
            await asyncio.sleep(0)
            await motion.hold()
            assert speed_rad_s(world) < REST_RAD_S
            await resuming
        await motion.resume()
        await check_arrived(world, motion)


@both_hosts_nightly
@pytest.mark.parametrize("when", ["while it brakes", "when it is held"])
async def test_a_cancel_during_a_hold_ends_the_motion_at_rest(host: str, when: str) -> None:
    async with opened(one_arm()) as world:
        motion = start(world, host)
        await until(lambda: motion.progress > 0.5)
        holding = asyncio.create_task(motion.hold())
        if when == "while it brakes":
            await until(lambda: motion.progress > 0.51)
        else:
            await holding
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        await holding
        assert speed_rad_s(world) < REST_RAD_S
        assert off_path_rad(world) < OFF_PATH_RAD
        assert motion.progress < 0.9
        # The set point stands still too: the next motion starts from where this one stopped.
        sample = world.arm("left").sample()
        back = world.arm("left").follow(smooth(sample.desired_rad, HOME, DURATION_S), tolerance=Tolerance())
        assert (await back.report()).end is MotionEnd.REACHED


@pytest.mark.virtual
@pytest.mark.parametrize("early_ms", [60, 5, 0, -10, -20, -30, *map(nightly, (150, 20, 2, 1, -1, -5, -19, -21))])
async def test_a_hold_just_before_the_natural_end_is_safe(early_ms: int) -> None:
    """While it brakes by itself, settles, or is about to report; both answers come, and the end."""
    async with opened(one_arm()) as world:
        motion = start(world)
        await asyncio.sleep(DURATION_S - early_ms / 1000.0)
        await motion.hold()
        assert speed_rad_s(world) < REST_RAD_S
        await asyncio.sleep(0.5)
        await motion.resume()
        await check_arrived(world, motion)


@pytest.mark.virtual
async def test_holding_and_resuming_an_ended_motion_does_nothing() -> None:
    async with opened(one_arm()) as world:
        motion = start(world)
        await motion.report()
        await motion.hold()
        await motion.resume()
        motion.cancel()
        await check_arrived(world, motion)


@both_hosts_nightly
async def test_fingers_are_held_on_their_way_and_go_on(host: str) -> None:
    async with opened(one_arm()) as world:
        gripper = world.gripper("left")
        motion = gripper.close_to(width_m=0.01, speed_m_s=0.05 / unhurried(host, 1.0), force_n=30.0)
        await until(lambda: gripper.sample().width_m < 0.05)
        asked_m = gripper.sample().width_m
        await motion.hold()
        held = gripper.sample()
        assert abs(held.velocity_m_s) < 0.002
        assert 0.02 < held.width_m == pytest.approx(asked_m, abs=0.003)
        await until(lambda: world.measured().time_s > held.time_s + 0.2)
        assert gripper.sample().width_m == pytest.approx(held.width_m, abs=0.0005)
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED
        assert gripper.sample().width_m == pytest.approx(0.01, abs=0.001)


@pytest.mark.virtual
async def test_fingers_cancelled_while_they_are_held_stay_there() -> None:
    async with opened(one_arm()) as world:
        gripper = world.gripper("left")
        motion = gripper.close_to(width_m=0.0, speed_m_s=0.05, force_n=30.0)
        await until(lambda: gripper.sample().width_m < 0.05)
        await motion.hold()
        width_m = gripper.sample().width_m
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        await asyncio.sleep(0.5)
        assert gripper.sample().width_m == pytest.approx(width_m, abs=0.0005)


@pytest.mark.virtual
@pytest.mark.parametrize("early_ms", [10, 0, -50, -61, *map(nightly, (50, 1, -10, -30, -60, -70))])
async def test_fingers_held_just_before_their_end_arrive_when_they_are_resumed(early_ms: int) -> None:
    async with opened(one_arm()) as world:
        gripper = world.gripper("left")
        motion = gripper.close_to(width_m=0.03, speed_m_s=0.1, force_n=30.0)
        await asyncio.sleep(0.5 - early_ms / 1000.0)
        await motion.hold()
        assert abs(gripper.sample().velocity_m_s) < 0.002
        await asyncio.sleep(5.0)
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED
        assert gripper.sample().width_m == pytest.approx(0.03, abs=0.001)
