"""A motion along a given path without an arm: before what it stops, when it goes on, and with which reason it ends."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import numpy as np
import pytest

from engine.clock import new_clock
from engine.errors import RobotError
from engine.skills.collision_options import CollisionOptions
from robots.arm.execution.given_path_motion import GivenPathMotion
from robots.arm.scene_queries.path_guard import PathRules
from robots.port import JointTrajectory, MotionEnd
from tests.robots.arm.execution.fake_guard import FREE, OTHER_ARM, FakeGuard, blocked, line
from tests.robots.fake_port import STOPPING_S, FakeMotion

DURATION_S, LOOK_S, UNMONITORED_S = 4.0, 0.25, 5.0
ACCELERATION_RAD_S2 = 5.0
BRAKING_S = 0.2 + 0.5 / (0.4 * ACCELERATION_RAD_S2)
"""The reaction, and braking from 0.5 rad/s with 0.4 of 5 rad/s²."""
pytestmark = pytest.mark.virtual


class Moved:
    """A motion that takes 4 s, and its guard."""

    def __init__(self, fake: FakeGuard, *, patience_s: float, path: JointTrajectory | None) -> None:
        self.fake = fake
        self.inner = FakeMotion(DURATION_S)
        self.motion = GivenPathMotion(
            self.inner,
            path or line(duration_s=DURATION_S),
            PathRules(may_touch=("tray",)),
            guard=fake.guard,
            options=CollisionOptions(patience_s=patience_s),
            reservation=fake.reservation,
            clock=new_clock(),
            acceleration_rad_s2=np.array([ACCELERATION_RAD_S2]),
        )
        self._start_s = asyncio.get_running_loop().time()

    @property
    def time_s(self) -> float:
        """Time since the start."""
        return asyncio.get_running_loop().time() - self._start_s

    @property
    def moves(self) -> bool:
        """Whether the arm is under way."""
        return self.inner.running and not self.inner.ended


@asynccontextmanager
async def moved(
    fake: FakeGuard | None = None, *, patience_s: float = 0.0, path: JointTrajectory | None = None
) -> AsyncGenerator[Moved]:
    """Return a motion; it is canceled at the end, when nobody is notified or reserves anything any more."""
    one = Moved(fake or FakeGuard(), patience_s=patience_s, path=path)
    try:
        yield one
    finally:
        one.motion.cancel()
        await one.motion.report()
        assert not one.fake.watched
        assert one.fake.reserved[-1] is None


async def test_a_free_path_is_checked_once_at_the_beginning_and_the_motion_reaches_its_end() -> None:
    async with moved() as one:
        assert one.motion.progress == 0.0
        await asyncio.sleep(1.0)
        assert one.fake.asked_s == [0.0]
        assert one.fake.rules == [PathRules(may_touch=("tray",))]
        assert one.motion.progress == pytest.approx(0.25)
        assert (await one.motion.report()).end is MotionEnd.REACHED
        assert one.time_s == pytest.approx(DURATION_S)


async def test_what_changed_since_the_path_was_admitted_stops_it_at_once_with_the_reason() -> None:
    fake = FakeGuard()
    fake.answer = blocked(2.0)
    async with moved(fake) as one:
        report = await one.motion.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "left/hand would touch wall")
        assert one.time_s == pytest.approx(STOPPING_S)


async def test_each_change_beside_the_arm_is_checked_from_where_it_is() -> None:
    async with moved() as one:
        await asyncio.sleep(1.0)
        one.fake.change("left")
        await asyncio.sleep(0.5)
        assert one.fake.asked_s == [0.0]
        one.fake.change("occupancy", "left")
        await asyncio.sleep(0.5)
        one.fake.change()
        await asyncio.sleep(0.001)
        assert one.fake.asked_s == pytest.approx([0.0, 1.5, 2.0])


async def test_the_reserved_path_gets_shorter_while_it_moves() -> None:
    async with moved() as one:
        await asyncio.sleep(1.0)
        one.fake.change("left")
        assert one.fake.reserved == pytest.approx([0.0, 1.0])
        await one.motion.hold()
        one.fake.change("left")
        assert one.fake.reserved[-1] is None


async def test_the_path_that_it_follows_is_the_one_that_is_reserved() -> None:
    path = line(duration_s=DURATION_S)
    async with moved(path=path) as one:
        assert one.fake.renewed == [path]
        assert one.fake.reserved == [0.0]


async def test_with_patience_it_waits_at_rest_and_goes_on_when_the_path_is_free() -> None:
    async with moved(patience_s=2.0) as one:
        await asyncio.sleep(1.0)
        one.fake.change("wall", answer=blocked(2.0))
        await asyncio.sleep(0.01)
        assert not one.moves
        assert one.fake.reserved[-1] is None
        await asyncio.sleep(1.0)
        one.fake.change("wall", answer=FREE)
        await asyncio.sleep(0.01)
        assert one.moves
        assert one.fake.reserved[-1] == pytest.approx(1.0)
        assert (await one.motion.report()).end is MotionEnd.REACHED
        assert one.time_s == pytest.approx(DURATION_S + 1.01, abs=0.02)


async def test_at_rest_the_path_is_looked_at_four_times_a_second_without_a_change() -> None:
    async with moved(patience_s=2.0) as one:
        one.fake.answer = blocked(2.0)
        await asyncio.sleep(0.9)
        assert len(one.fake.asked_s) == 1 + int(0.9 / LOOK_S)
        one.fake.answer = FREE
        await asyncio.sleep(LOOK_S)
        assert one.moves


@pytest.mark.parametrize("patience_s", [0.5, 0.6])
async def test_when_its_patience_is_over_it_fails_with_the_last_reason(patience_s: float) -> None:
    async with moved(patience_s=patience_s) as one:
        one.fake.answer = blocked(2.0)
        await asyncio.sleep(0.3)
        one.fake.change("right", answer=blocked(2.0, OTHER_ARM))
        report = await one.motion.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "left/hand would touch right/hand")
        assert one.time_s == pytest.approx(patience_s + STOPPING_S, abs=0.01)


async def test_each_wait_has_the_whole_patience() -> None:
    async with moved(patience_s=1.0) as one:
        for _ in range(3):
            one.fake.change("wall", answer=blocked(3.9))
            await asyncio.sleep(0.7)
            assert not one.moves
            one.fake.change("wall", answer=FREE)
            await asyncio.sleep(0.1)
            assert one.moves


async def test_before_another_arm_it_goes_on_as_long_as_it_can_stop() -> None:
    async with moved() as one:
        await asyncio.sleep(1.0)
        one.fake.change("right", answer=blocked(2.0, OTHER_ARM))
        await asyncio.sleep(1.0 - BRAKING_S - 0.01)
        assert one.moves
        report = await one.motion.report()
        assert report.reason == "left/hand would touch right/hand"
        assert one.time_s == pytest.approx(2.0 - BRAKING_S + STOPPING_S, abs=0.01)


async def test_the_other_arm_may_be_gone_by_then() -> None:
    async with moved() as one:
        one.fake.answer = blocked(2.0, OTHER_ARM)
        await asyncio.sleep(1.0)
        one.fake.answer = FREE
        assert (await one.motion.report()).end is MotionEnd.REACHED
        assert one.time_s == pytest.approx(DURATION_S)


@pytest.mark.parametrize(("at_s", "is_late"), [(1.001, False), (1.0, True), (0.5, True)])
async def test_a_stop_that_was_too_late_says_so(*, at_s: float, is_late: bool) -> None:
    async with moved() as one:
        await asyncio.sleep(1.0)
        one.fake.change("wall", answer=blocked(at_s))
        report = await one.motion.report()
        late = "; it was detected too late to stop before it" if is_late else ""
        assert report.reason == "left/hand would touch wall" + late


async def test_the_clock_goes_on_where_rounding_leaves_nothing_of_the_patience() -> None:
    """From this time 5 s later is not yet 5 s ago, and what is left is too short to change the clock."""
    async with moved() as one:
        await asyncio.sleep(3.0 + 24 / 1000)
        start_s = one.time_s
        one.fake.change("wall", answer=RobotError("the planner is gone"))
        report = await one.motion.report()
        assert report.reason == "path monitoring is not available: the planner is gone"
        assert one.time_s - start_s == pytest.approx(STOPPING_S + UNMONITORED_S, abs=0.01)


async def test_an_arm_that_is_not_monitored_waits_five_seconds_for_the_next_check() -> None:
    async with moved() as one:
        one.fake.change("wall", answer=RobotError("the planner is gone"))
        await asyncio.sleep(UNMONITORED_S - 0.01)
        assert not one.moves
        assert not one.inner.ended
        report = await one.motion.report()
        assert report.reason == "path monitoring is not available: the planner is gone"
        assert one.time_s == pytest.approx(UNMONITORED_S + STOPPING_S, abs=0.01)


async def test_longer_patience_holds_for_an_arm_that_is_not_monitored_too() -> None:
    async with moved(patience_s=7.0) as one:
        one.fake.change("wall", answer=RobotError("the planner is gone"))
        await one.motion.report()
        assert one.time_s == pytest.approx(7.0 + STOPPING_S, abs=0.01)


async def test_an_error_of_the_monitoring_itself_stops_the_arm() -> None:
    async with moved(patience_s=3.0) as one:
        one.fake.change("wall", answer=ValueError("odd"))
        report = await one.motion.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "path monitoring failed: ValueError: odd")


async def test_a_held_arm_is_not_checked_and_does_not_lose_its_patience() -> None:
    async with moved(patience_s=0.5) as one:
        await one.motion.hold()
        one.fake.change("wall", answer=blocked(2.0))
        await asyncio.sleep(2.0)
        assert one.fake.asked_s == []
        assert not one.inner.ended
        one.fake.answer = FREE
        await one.motion.resume()
        assert one.moves
        assert one.fake.asked_s == [0.0]


async def test_a_short_hold_gives_the_whole_patience_again_too() -> None:
    async with moved(patience_s=0.5) as one:
        one.fake.change("wall", answer=blocked(2.0))
        await asyncio.sleep(0.3)
        await one.motion.hold()
        await asyncio.sleep(0.05)
        await one.motion.resume()
        report = await one.motion.report()
        assert report.reason == "left/hand would touch wall"
        assert one.time_s == pytest.approx(0.35 + 0.5 + STOPPING_S, abs=0.01)


async def test_resume_returns_when_the_path_is_known_to_be_blocked() -> None:
    async with moved(patience_s=9.0) as one:
        await asyncio.sleep(1.0)
        await one.motion.hold()
        one.fake.answer = blocked(2.0)
        one.fake.takes_s = 0.1
        before_s = one.time_s
        await one.motion.resume()
        assert one.time_s == pytest.approx(before_s + 0.1)
        assert not one.moves
        await one.motion.resume()
        assert one.time_s == pytest.approx(before_s + 0.1)


async def test_a_hold_while_the_path_is_checked_keeps_the_arm_at_rest() -> None:
    async with moved(patience_s=9.0) as one:
        one.fake.change("wall", answer=blocked(2.0))
        await asyncio.sleep(0.01)
        one.fake.takes_s = 0.1
        one.fake.change("wall", answer=FREE)
        await asyncio.sleep(0.05)
        await one.motion.hold()
        await asyncio.sleep(1.0)
        assert not one.moves
        await one.motion.resume()
        assert one.moves


async def test_a_cancel_while_the_path_is_checked_ends_it() -> None:
    async with moved(patience_s=9.0) as one:
        one.fake.takes_s = 0.25
        one.fake.change("wall", answer=blocked(2.0))
        await asyncio.sleep(0.05)
        one.motion.cancel()
        assert (await one.motion.report()).end is MotionEnd.CANCELED
        assert one.time_s == pytest.approx(0.05 + STOPPING_S)


async def test_its_own_failure_counts_more_than_the_contact() -> None:
    async with moved() as one:
        one.fake.change("wall", answer=blocked(2.0))
        await asyncio.sleep(0.01)
        one.inner.fail("the drive is off")
        report = await one.motion.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "the drive is off")


async def test_a_path_at_rest_can_be_stopped_within_the_reaction_time() -> None:
    async with moved(path=line(duration_s=DURATION_S, speed_rad_s=0.0)) as one:
        one.fake.answer = blocked(2.0, OTHER_ARM)
        await one.motion.report()
        assert one.time_s == pytest.approx(2.0 - 0.2 + STOPPING_S, abs=0.01)
