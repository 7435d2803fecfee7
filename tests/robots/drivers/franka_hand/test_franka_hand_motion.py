"""What the motion of a Franka Hand says of its end."""

from __future__ import annotations

import asyncio

import pytest

from robots.drivers.franka_hand.franka_hand_motion import FrankaHandMotion
from robots.drivers.franka_hand.franka_hand_reading import FrankaHandCommand, FrankaHandReading, MoveFingers
from robots.drivers.franka_hand.hand_protocol import FingerState
from robots.drivers.fresh_link import FreshReading
from robots.port import MotionReport


def late_end(speed_m_s: float) -> MotionReport:
    """Return the report of a motion that the hand never ends, of fingers that move at a speed."""

    async def play() -> MotionReport:
        def submit(_: FrankaHandCommand) -> asyncio.Future[float]:
            acknowledged: asyncio.Future[float] = asyncio.get_running_loop().create_future()
            acknowledged.set_result(0.0)
            return acknowledged

        motion = FrankaHandMotion(
            lambda: MoveFingers(number=1, width_m=0.0, speed_m_s=0.01), submit, start_m=0.08, goal_m=0.0, limit_s=1.0
        )
        await asyncio.sleep(0)
        for period in range(20):
            width_m = 0.08 - speed_m_s * 0.1 * period
            state = FingerState(number=period, width_m=width_m, stroke_m=0.08, is_grasping=False, temperature_c=30)
            motion.take(FreshReading(value=FrankaHandReading(state=state), asked_s=0.1 * period, took_s=0.001))
        return await motion.report()

    return asyncio.run(play())


@pytest.mark.parametrize(("speed_m_s", "at_rest"), [(0.01, False), (0.0, True)])
def test_fingers_that_still_move_when_their_time_is_over_are_not_reported_at_rest(
    speed_m_s: float, at_rest: bool
) -> None:
    report = late_end(speed_m_s)
    assert report.reason == "the fingers did not end their motion within 1.0 s"
    assert report.at_rest is at_rest
