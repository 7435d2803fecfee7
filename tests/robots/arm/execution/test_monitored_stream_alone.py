"""A monitored stream without an arm: what makes it stand, fail or go on, whoever holds it meanwhile."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest

from engine.errors import RobotError
from robots.arm.execution.monitored_stream import MonitoredStream
from robots.arm.scene_queries.path_guard import PathRules
from robots.port import MotionEnd
from tests.robots.arm.execution.fake_guard import FREE, FakeGuard, blocked, line
from tests.robots.fake_port import STOPPING_S, FakeStream

PERIOD_S = 0.03
pytestmark = pytest.mark.virtual


class Streamed:
    """A monitored stream, and the hand that pushes its arm; both as a test says."""

    def __init__(self, *, guided: bool, person_at_arm: bool = False) -> None:
        self.fake = FakeGuard()
        self.path = line()
        self.pushes = True
        self.inner = FakeStream(1, take=lambda _: None)
        self.stream = MonitoredStream(
            self.inner,
            PathRules(person_at_arm=person_at_arm),
            guard=self.fake.guard,
            ahead=lambda: self.path,
            may_resume=(lambda: not self.pushes) if guided else None,
        )
        self._running = True
        hold, resume = self.inner.hold, self.inner.resume

        async def held() -> None:
            self._running = False
            await hold()

        async def resumed() -> None:
            self._running = True
            await resume()

        self.inner.hold, self.inner.resume = held, resumed

    @property
    def moves(self) -> bool:
        """Whether the arm follows the stream."""
        return self._running and not self.inner.ended


@asynccontextmanager
async def streamed(*, guided: bool = False, person_at_arm: bool = False) -> AsyncGenerator[Streamed]:
    """Return a stream; it is canceled at the end."""
    one = Streamed(guided=guided, person_at_arm=person_at_arm)
    try:
        yield one
    finally:
        one.stream.cancel()
        await one.stream.report()
        assert one.fake.required == 0


async def test_it_is_checked_every_period_while_it_is_free_and_the_cameras_run() -> None:
    async with streamed() as one:
        await asyncio.sleep(0.3)
        assert one.fake.required == 1
        assert len(one.fake.asked_s) == pytest.approx(0.3 / PERIOD_S, abs=1)
        assert set(one.fake.asked_s) == {0.0}
        assert one.fake.paths[0] is one.path
        assert (one.moves, one.stream.held_by) == (True, "")


async def test_before_a_contact_it_fails_with_both_names_once_at_rest() -> None:
    async with streamed() as one:
        one.fake.answer = blocked(0.1)
        start_s = asyncio.get_running_loop().time()
        report = await one.stream.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "left/hand would touch wall")
        assert asyncio.get_running_loop().time() - start_s == pytest.approx(STOPPING_S, abs=1e-6)


async def test_its_own_failure_counts_more_than_the_contact() -> None:
    async with streamed() as one:
        one.fake.answer = blocked(0.1)
        await asyncio.sleep(0.0)
        await asyncio.sleep(0.01)
        one.inner.fail("the drive is off")
        report = await one.stream.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "the drive is off")


async def test_a_check_that_fails_ends_the_stream_with_the_reason() -> None:
    async with streamed() as one:
        one.fake.answer = RobotError("the planner is gone")
        assert (await one.stream.report()).reason == "path monitoring is not available: the planner is gone"
    async with streamed() as one:
        one.fake.answer = ValueError("odd")
        report = await one.stream.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "stream monitoring failed: ValueError: odd")


async def test_a_check_that_takes_too_long_ends_it_too() -> None:
    async with streamed() as one:
        one.fake.takes_s = 0.31
        assert (await one.stream.report()).reason == "its path was not checked within 0.3 s"


@pytest.mark.parametrize("person_at_arm", [False, True])
async def test_a_blind_camera_ends_a_stream_but_not_the_one_of_a_person_at_the_arm(*, person_at_arm: bool) -> None:
    async with streamed(person_at_arm=person_at_arm) as one:
        one.fake.unobserved_reason = "side is covered"
        await asyncio.sleep(0.2)
        assert one.moves is person_at_arm
        if not person_at_arm:
            assert (await one.stream.report()).reason == "side is covered"


async def test_values_the_end_and_the_progress_are_those_of_the_stream() -> None:
    async with streamed() as one:
        assert one.stream.held_by == ""
        one.stream.send((0.5,), age_s=0.01)
        assert (one.inner.sent, one.inner.ages_s, one.stream.progress) == ([(0.5,)], [0.01], 0.0)
        one.stream.finish()
        assert (await one.stream.report()).end is MotionEnd.REACHED


async def test_while_it_is_held_nothing_is_checked() -> None:
    async with streamed() as one:
        await one.stream.hold()
        await asyncio.sleep(0.01)
        asked = len(one.fake.asked_s)
        await asyncio.sleep(0.3)
        assert (len(one.fake.asked_s), one.moves) == (asked, False)
        await one.stream.resume()
        await asyncio.sleep(0.1)
        assert len(one.fake.asked_s) > asked
        assert one.moves


async def test_a_guided_arm_stands_until_the_hand_leads_away() -> None:
    async with streamed(guided=True) as one:
        one.fake.answer = blocked(0.1)
        await asyncio.sleep(0.1)
        assert (one.moves, one.stream.held_by) == (False, "left/hand would touch wall")
        await asyncio.sleep(0.3)
        assert not one.moves
        one.fake.answer, one.pushes = FREE, False
        await asyncio.sleep(0.1)
        assert (one.moves, one.stream.held_by) == (True, "")
        await one.stream.hold()
        await one.stream.resume()
        assert one.moves


async def test_it_is_held_by_the_wall_until_it_moves_away_from_it() -> None:
    async with streamed(guided=True) as one:
        one.fake.answer = blocked(0.1)
        await asyncio.sleep(0.1)
        one.fake.answer, one.pushes, one.path = FREE, False, line(speed_rad_s=0.001, start_rad=1.0)
        await asyncio.sleep(0.1)
        assert (one.moves, one.stream.held_by) == (True, "left/hand would touch wall")
        one.path = line(speed_rad_s=0.002, start_rad=-1.0)
        await asyncio.sleep(0.1)
        assert one.stream.held_by == ""


@pytest.mark.parametrize("after_s", [0.001, 0.02, 0.1])
async def test_an_operator_who_holds_and_resumes_does_not_free_an_arm_that_stands(after_s: float) -> None:
    """Nobody would check the path before the hand has let go."""
    async with streamed(guided=True) as one:
        one.fake.answer = blocked(0.1)
        await asyncio.sleep(0.1)
        assert not one.moves
        await one.stream.hold()
        await asyncio.sleep(after_s)
        await one.stream.resume()
        await asyncio.sleep(0.2)
        assert not one.moves
        one.fake.answer, one.pushes = FREE, False
        await asyncio.sleep(0.1)
        assert one.moves


async def test_a_hand_that_lets_go_of_a_held_arm_does_not_free_it() -> None:
    async with streamed(guided=True) as one:
        one.fake.answer = blocked(0.1)
        await asyncio.sleep(0.1)
        await one.stream.hold()
        one.fake.answer, one.pushes = FREE, False
        await asyncio.sleep(0.2)
        assert not one.moves
        await one.stream.resume()
        await asyncio.sleep(0.1)
        assert one.moves


async def test_a_canceled_stream_that_stands_ends() -> None:
    async with streamed(guided=True) as one:
        one.fake.answer = blocked(0.1)
        await asyncio.sleep(0.1)
        one.stream.cancel()
        assert (await one.stream.report()).end is MotionEnd.CANCELED
        assert not one.moves
