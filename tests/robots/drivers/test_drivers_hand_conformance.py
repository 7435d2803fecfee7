"""One set of tests for hands: the simulation, and the SoftHand driver with its emulator over each line."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Awaitable, Callable, Generator
from contextlib import asynccontextmanager
from dataclasses import dataclass

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock, run_virtual
from engine.errors import RobotError
from engine.messages import Pose, Quaternion
from engine.skills.hand import HandClose, HandOpen, ReadHand
from robots.gripper import HandServer
from robots.port import HandPort, MotionEnd
from robots.scene.sim_scene import FixtureBody, PartBody
from tests.robots.drivers.emulated_device import Emulators
from tests.robots.drivers.emulated_hand import HAND, HAND_CONNECTIONS, driven_hand, emulated_hand
from tests.robots.sim.tool_cell import ARM, reaching, scene

SUBJECTS = ("simulation", *HAND_CONNECTIONS)
SIDE: Quaternion = (0.0, 0.70710678, 0.0, 0.70710678)
BESIDE = np.array([0.0, -0.6, -0.2, -2.4, -0.6, 3.4, -2.6])
BALL_XYZ = (0.5, 0.0, 0.66)
OBJECT_SHARE = 0.5


@dataclass
class Hand:
    """The hand under test."""

    bus: SkillBus
    port: HandPort


Scenario = Callable[[Hand], Awaitable[None]]


@asynccontextmanager
async def simulated(*, around_object: bool) -> AsyncGenerator[Hand]:
    """A soft hand on a Panda in a world, around a ball in a cup, or above nothing."""
    x, y, z = BALL_XYZ
    ball = PartBody(name="part", shape="sphere", size_m=(0.07,), mass_kg=0.2, pose=Pose(xyz=BALL_XYZ))
    cup = FixtureBody(
        name="cup", shape="tray", size_m=(0.024, 0.024, 0.01), wall_m=0.004, pose=Pose(xyz=(x, y, z - 0.04407))
    )
    parts, fixtures = ((ball,), (cup,)) if around_object else ((), ())
    cell = scene("panda", "softhand", parts=parts, fixtures=fixtures)
    async with reaching(cell) as reach, SkillBus(new_clock()) as bus:
        for offset_m, like in ((0.113, BESIDE), (0.013, None)):
            motion = await reach.to((x, y - offset_m, z), SIDE, duration_s=1.5, like=like)
            assert motion.end is MotionEnd.REACHED
        port = reach.world.hand(ARM)
        HandServer(name=HAND, port=port).register(bus)
        yield Hand(bus, port)


@pytest.fixture(scope="module")
def emulators() -> Generator[Emulators]:
    """The emulators of this file, each started at its first use."""
    with Emulators(emulated_hand) as started:
        yield started


def run(subject: str, emulators: Emulators, scenario: Scenario, *, around_object: bool = False) -> None:
    """Execute a scenario on a hand, in the time that it lives in."""

    async def in_simulation() -> None:
        async with simulated(around_object=around_object) as hand:
            await scenario(hand)

    async def in_reality() -> None:
        emulator = emulators.of(subject)
        emulator.do("object", share=None)
        # Nothing is lost here, but a loaded machine may be late.
        async with driven_hand(emulator, stale_s=5.0, timeout_s=1.0) as (bus, device):
            await bus.send_goal(HandOpen(), to=HAND).result()
            emulator.do("object", share=OBJECT_SHARE if around_object else None)
            await scenario(Hand(bus, device.port))

    if subject == "simulation":
        run_virtual(in_simulation())
    else:
        asyncio.run(in_reality())


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_part_is_held_until_the_hand_opens(subject: str, emulators: Emulators) -> None:
    async def scenario(hand: Hand) -> None:
        closed = await hand.bus.send_goal(HandClose(percent=70.0, time_s=1.5), to=HAND).result()
        assert closed.result is not None
        assert (closed.status, closed.result.held, closed.result.reason) == (GoalStatus.SUCCEEDED, True, "")
        # A real hand does not know what it holds, and says so.
        expected = ("part", "contact") if subject == "simulation" else ("?", "current")
        assert (closed.result.part, closed.result.by) == expected
        assert 0.0 < closed.result.force_n <= hand.port.max_force_n
        assert (await hand.bus.call(ReadHand(), to=HAND)).held
        opened = await hand.bus.send_goal(HandOpen(), to=HAND).result()
        assert opened.result is not None
        assert (opened.result.held, opened.result.reason) == (False, "the hand is open")
        assert not (await hand.bus.call(ReadHand(), to=HAND)).held

    run(subject, emulators, scenario, around_object=True)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_fingers_that_meet_nothing_hold_nothing_and_reach_their_share(subject: str, emulators: Emulators) -> None:
    async def scenario(hand: Hand) -> None:
        closed = await hand.bus.send_goal(HandClose(percent=60.0, time_s=1.0), to=HAND).result()
        assert closed.result is not None
        assert (closed.status, closed.result.held) == (GoalStatus.SUCCEEDED, False)
        assert closed.result.closed_percent == pytest.approx(60.0, abs=2.0)
        assert closed.result.reason == "the hand closed to 60 % and touches nothing"

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_motion_takes_about_the_time_that_it_was_given(subject: str, emulators: Emulators) -> None:
    async def scenario(hand: Hand) -> None:
        motion = hand.port.close_to(share=0.8, time_s=4.0)
        await hand.bus.clock.sleep(1.0)
        # Loose: a loaded machine gives fewer readings.
        assert 0.0 < hand.port.sample().closed_share < 0.6
        assert 0.0 < motion.progress < 1.0
        assert (await motion.report()).end is MotionEnd.REACHED
        assert motion.progress == 1.0

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_cancelled_motion_ends_at_rest_and_the_next_is_taken(subject: str, emulators: Emulators) -> None:
    async def scenario(hand: Hand) -> None:
        motion = hand.port.close_to(share=0.9, time_s=6.0)
        await hand.bus.clock.sleep(1.0)
        motion.cancel()
        report = await motion.report()
        assert (report.end, report.at_rest) == (MotionEnd.CANCELED, True)
        rest = hand.port.sample().closed_share
        assert 0.0 < rest < 0.9
        await hand.bus.clock.sleep(0.3)
        assert hand.port.sample().closed_share == pytest.approx(rest, abs=0.02)
        again = hand.port.close_to(share=0.0, time_s=1.0)
        assert (await again.report()).end is MotionEnd.REACHED

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_held_motion_rests_and_resumes_to_its_goal(subject: str, emulators: Emulators) -> None:
    async def scenario(hand: Hand) -> None:
        motion = hand.port.close_to(share=0.6, time_s=3.0)
        await hand.bus.clock.sleep(0.5)
        await motion.hold()
        rest = hand.port.sample().closed_share
        assert 0.0 < rest < 0.6
        await hand.bus.clock.sleep(0.3)
        assert hand.port.sample().closed_share == pytest.approx(rest, abs=0.02)
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED
        assert hand.port.sample().closed_share == pytest.approx(0.6, abs=0.02)

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_second_motion_and_senseless_values_are_refused_with_the_reason(subject: str, emulators: Emulators) -> None:
    async def scenario(hand: Hand) -> None:
        for share, time_s in ((float("nan"), 1.0), (-0.1, 1.0), (0.5, 0.0), (0.5, float("inf"))):
            with pytest.raises(RobotError, match="cannot be"):
                hand.port.close_to(share=share, time_s=time_s)
        motion = hand.port.close_to(share=0.5, time_s=4.0)
        with pytest.raises(RobotError):
            hand.port.close_to(share=0.1, time_s=1.0)
        motion.cancel()
        await motion.report()

    run(subject, emulators, scenario)
