"""One motion of a Franka Hand, which executes it by itself and says when it has ended."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from robots.drivers.device_motion import DeviceMotion
from robots.drivers.franka_hand.franka_hand_reading import (
    CloseFingers,
    FrankaHandCommand,
    FrankaHandReading,
    MoveFingers,
    StopFingers,
)
from robots.drivers.franka_hand.hand_protocol import HandReply
from robots.drivers.fresh_link import FreshReading
from robots.port import MotionEnd, MotionReport

_STILL_M = 3e-5
_STILL_S = 0.1
_AT_GOAL_M = 0.002

Submit = Callable[[FrankaHandCommand], "asyncio.Future[float]"]
Repeat = Callable[[], MoveFingers | CloseFingers]


class FrankaHandMotion(DeviceMotion):
    """A motion to an opening: it has ended when the hand says so, and the fingers are measured at rest.

    Args:
        new_command: Returns the command, with a number of its own each time.
        submit: Sends commands.
        start_m: Opening at its start.
        goal_m: Opening at its end.
        limit_s: Seconds until it counts as failed.
    """

    def __init__(self, new_command: Repeat, submit: Submit, *, start_m: float, goal_m: float, limit_s: float) -> None:
        super().__init__()
        self._new_command = new_command
        self._submit = submit
        self._start_m = self._width_m = self._still_m = start_m
        self._goal_m = goal_m
        self._limit_s = limit_s
        self._still_since_s = self._last_s = 0.0
        self._sent_s = float("inf")
        self._moving_s = 0.0
        self._number = 0
        self._send_go()

    def take(self, reading: FreshReading[FrankaHandReading]) -> None:
        """Apply a reading of the hand."""
        if self.ended or reading.asked_s < self._sent_s:
            return
        if not self._stopping:
            self._moving_s += reading.asked_s - self._last_s
        self._last_s = reading.asked_s
        self._width_m = width_m = reading.value.state.width_m
        if abs(width_m - self._still_m) > _STILL_M:
            self._still_m, self._still_since_s = width_m, reading.asked_s
        is_still = reading.asked_s - self._still_since_s >= _STILL_S
        if self._stopping:
            if is_still:
                self._rest()
        elif reading.value.ended == self._number and is_still:
            self._arrive(reading.value)
        elif self._moving_s > self._limit_s:
            self._canceled = True
            self._stop()
            self.fail(f"the fingers did not end their motion within {self._limit_s:.1f} s", at_rest=is_still)

    def _arrive(self, reading: FrankaHandReading) -> None:
        status = reading.end_status
        if status not in (HandReply.SUCCESS, HandReply.UNSUCCESSFUL, HandReply.FAIL):
            self.fail(f"the hand has aborted the motion, status {status}")
            return
        # A hand that was stopped by something before its goal calls that unsuccessful; it is where it is measured.
        is_short = abs(reading.state.width_m - self._goal_m) > _AT_GOAL_M
        self._finish(MotionReport(end=MotionEnd.REACHED, contact=reading.state.is_grasping or is_short))

    def _passed_share(self) -> float:
        total = abs(self._goal_m - self._start_m)
        return min(1.0, abs(self._width_m - self._start_m) / total) if total else 0.0

    def _send_go(self) -> None:
        command = self._new_command()
        self._number = command.number
        self._send(command)

    def _send_stop(self) -> None:
        self._send(StopFingers())

    def _send(self, command: FrankaHandCommand) -> None:
        self._sent_s = float("inf")
        self._watch(self._submit(command))

    def _acknowledged(self, at_s: float) -> None:
        self._sent_s = self._last_s = self._still_since_s = at_s
