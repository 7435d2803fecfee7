"""One motion of a SoftHand: a reference that moves at constant speed, while the motor current permits it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

from robots.drivers.device_motion import DeviceMotion
from robots.drivers.fresh_link import FreshReading
from robots.drivers.softhand.hand_reading import HandReading, HandReference
from robots.port import MotionEnd, MotionReport

_STEP_S = 0.015
_LONGEST_STEP_S = 0.1
_STILL_S = 0.1
_STILL_TICKS = 20
_AT_GOAL_TICKS = 300
_PATIENCE_S = 2.0

Submit = Callable[[HandReference], "asyncio.Future[float]"]


@dataclass(frozen=True, kw_only=True)
class HandGoal:
    """Where the reference goes, in ticks, how fast, and the motor current at which it goes no further."""

    ticks: int
    speed_ticks_s: float
    current_limit_ma: float


class SoftHandMotion(DeviceMotion):
    """A motion of the reference, one step a reading: without readings, or without an engine, the hand stops.

    Args:
        goal: Where to and how fast.
        submit: Sends references.
        presses: Whether the motor pulls more in a reading than for closing on nothing.
        start: The reading at its start.
        reference_ticks: The reference at its start, which may be newer than that reading.
    """

    def __init__(
        self,
        goal: HandGoal,
        submit: Submit,
        *,
        presses: Callable[[HandReading], bool],
        start: FreshReading[HandReading],
        reference_ticks: int,
    ) -> None:
        super().__init__()
        self.reference_ticks = float(reference_ticks)
        self._goal = goal
        self._submit = submit
        self._presses = presses
        self._closes = goal.ticks >= self.reference_ticks
        self._start_ticks = start.value.position_ticks
        self._latest = self._moved = start
        self._advanced_s = start.asked_s
        self._sent = True
        self._limit_s = abs(goal.ticks - self.reference_ticks) / goal.speed_ticks_s + _PATIENCE_S
        self._moving_s = 0.0

    def take(self, reading: FreshReading[HandReading]) -> None:
        """Apply a reading of the hand, and send the next reference."""
        now, elapsed_s = reading.value, reading.asked_s - self._latest.asked_s
        if self.ended or elapsed_s <= 0.0:
            return
        self._latest = reading
        if abs(now.position_ticks - self._moved.value.position_ticks) > _STILL_TICKS:
            self._moved = reading
        still = reading.asked_s - self._moved.asked_s >= _STILL_S
        if not self._sent:
            return
        if self._stopping:
            if still:
                self._rest()
            return
        # Of a longer gap the reference makes up no more either.
        self._moving_s += min(_LONGEST_STEP_S, elapsed_s)
        stalled = (
            self._closes and self.reference_ticks != self._goal.ticks and now.current_ma >= self._goal.current_limit_ma
        )
        if self.reference_ticks != self._goal.ticks and not stalled:
            self._advance(reading.asked_s)
        elif still:
            self._arrive(now, stalled=stalled)
        if not self.ended and self._moving_s > self._limit_s:
            self._give_up(now, at_rest=still)

    def _advance(self, now_s: float) -> None:
        # Each command wakes the connection, whose next reading follows at once: they would go round without a pause.
        if now_s - self._advanced_s < _STEP_S:
            return
        step = self._goal.speed_ticks_s * min(_LONGEST_STEP_S, now_s - self._advanced_s)
        self._advanced_s, self._moved = now_s, self._latest
        remaining = self._goal.ticks - self.reference_ticks
        self._follow(self.reference_ticks + min(step, max(-step, remaining)))

    def _arrive(self, now: HandReading, *, stalled: bool) -> None:
        short_of_goal = abs(now.position_ticks - self._goal.ticks) > _AT_GOAL_TICKS
        if stalled or not short_of_goal or (self._closes and self._presses(now)):
            self._finish(MotionReport(end=MotionEnd.REACHED, contact=stalled or short_of_goal))

    def _give_up(self, now: HandReading, *, at_rest: bool) -> None:
        self._canceled = True
        self._stop()
        self.fail(f"the fingers stopped at {now.position_ticks} ticks instead of {self._goal.ticks}", at_rest=at_rest)

    def _passed_share(self) -> float:
        total = abs(self._goal.ticks - self._start_ticks)
        return min(1.0, abs(self._latest.value.position_ticks - self._start_ticks) / total) if total else 0.0

    def _send_go(self) -> None:
        self._advanced_s = self._latest.asked_s

    def _send_stop(self) -> None:
        """Hold the present position; where the hand presses, hold the reference, so that it stays pressing."""
        now, self._moved = self._latest.value, self._latest
        if not self._presses(now):
            self._follow(float(now.position_ticks))

    def _follow(self, ticks: float) -> None:
        self.reference_ticks, self._sent = ticks, False
        self._watch(self._submit(HandReference(ticks=round(ticks))))

    def _acknowledged(self, at_s: float) -> None:
        self._sent = True
