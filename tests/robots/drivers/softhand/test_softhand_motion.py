"""What the motion of a SoftHand says of its end."""

from __future__ import annotations

import asyncio

import pytest

from robots.drivers.fresh_link import FreshReading
from robots.drivers.softhand.hand_reading import HandReading, HandReference
from robots.drivers.softhand.softhand_motion import HandGoal, SoftHandMotion
from robots.port import MotionReport

PERIOD_S = 0.05


def given_up(ticks_a_reading: int) -> MotionReport:
    """Return the report of a motion whose fingers are nowhere near their goal when its time is over."""

    async def play() -> MotionReport:
        def reading(number: int) -> FreshReading[HandReading]:
            position = 5000 - ticks_a_reading * (number % 2)
            value = HandReading(active=True, reference_ticks=0, before_ticks=0, position_ticks=position, current_ma=0)
            return FreshReading(value=value, asked_s=PERIOD_S * number, took_s=0.001)

        def submit(_: HandReference) -> asyncio.Future[float]:
            acknowledged: asyncio.Future[float] = asyncio.get_running_loop().create_future()
            acknowledged.set_result(0.0)
            return acknowledged

        motion = SoftHandMotion(
            HandGoal(ticks=0, speed_ticks_s=50_000.0, current_limit_ma=900.0),
            submit,
            presses=lambda _: False,
            start=reading(0),
            reference_ticks=5000,
        )
        for number in range(1, 200):
            motion.take(reading(number))
            await asyncio.sleep(0)
            if motion.ended:
                break
        return await motion.report()

    return asyncio.run(play())


@pytest.mark.parametrize(("ticks_a_reading", "at_rest"), [(0, True), (200, False)])
def test_fingers_that_still_move_when_their_time_is_over_are_not_reported_at_rest(
    ticks_a_reading: int, at_rest: bool
) -> None:
    report = given_up(ticks_a_reading)
    assert report.reason.startswith("the fingers stopped at ")
    assert report.at_rest is at_rest
