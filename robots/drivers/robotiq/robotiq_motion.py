"""One motion of a Robotiq gripper, followed by its readings; implements `robots.port.Motion`."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from robots.drivers.device_motion import DeviceMotion
from robots.drivers.fresh_link import FreshReading
from robots.drivers.robotiq.gripper_registers import GripperCommand, GripperStatus, ObjectStatus
from robots.port import MotionEnd, MotionReport

ECHO_LIMIT_S = 1.0
_REST_READINGS = 2

Submit = Callable[[GripperCommand], "asyncio.Future[float]"]


class RobotiqMotion(DeviceMotion):
    """A motion to a position request.

    It has ended when a reading that was asked for after the acknowledgement echoes the request and says that the
    fingers are there or in contact, twice at the same position: the object status lags behind the request.

    Args:
        command: The command that moves.
        submit: Sends commands.
        start: Position in counts at the start.
        limit_s: Seconds until it counts as failed.
    """

    def __init__(self, command: GripperCommand, submit: Submit, *, start: int, limit_s: float) -> None:
        super().__init__()
        self.command = command
        self._submit = submit
        self._start = start
        self._limit_s = limit_s
        self._position = start
        self._sent_s = float("inf")
        self._moving_s = 0.0
        self._same = 0
        self._previous: GripperStatus | None = None
        self._last_s = 0.0
        self._send(command)

    def take(self, reading: FreshReading[GripperStatus]) -> None:
        """Apply a reading of the gripper."""
        status, previous = reading.value, self._previous
        if self.ended or reading.asked_s < self._sent_s:
            return
        if previous is not None and not self._stopping:
            self._moving_s += reading.asked_s - self._last_s
        unchanged = previous is not None and (previous.position, previous.contact) == (status.position, status.contact)
        self._same = self._same + 1 if unchanged else 0
        self._previous, self._position, self._last_s = status, status.position, reading.asked_s
        if self._stopping:
            if not status.go and self._same >= _REST_READINGS:
                self._rest()
        elif status.go and status.position_echo == self.command.position:
            self._arrive(status)
        elif reading.asked_s - self._sent_s > ECHO_LIMIT_S:
            self.fail(f"the gripper did not take the request for position {self.command.position}")
        if not self.ended and self._moving_s > self._limit_s:
            self._canceled = self._stopping = True
            self._send_stop()
            self.fail(f"the fingers did not end their motion within {self._limit_s:.1f} s")

    def _passed_share(self) -> float:
        total = abs(self.command.position - self._start)
        return min(1.0, abs(self._position - self._start) / total) if total else 0.0

    def _arrive(self, status: GripperStatus) -> None:
        if status.contact is not ObjectStatus.MOVING and self._same >= 1:
            contact = status.contact is not ObjectStatus.AT_POSITION
            self._finish(MotionReport(end=MotionEnd.REACHED, contact=contact))

    def _send_go(self) -> None:
        self._send(self.command)

    def _send_stop(self) -> None:
        self._send(stop_command(self.command))

    def _send(self, command: GripperCommand) -> None:
        self._sent_s, self._same, self._previous = float("inf"), 0, None
        self._watch(self._submit(command))

    def _acknowledged(self, at_s: float) -> None:
        self._sent_s = self._last_s = at_s


def stop_command(command: GripperCommand) -> GripperCommand:
    """Return the command that stops the fingers where they are; what they hold stays held."""
    return GripperCommand(activate=True, go=False, position=command.position, speed=command.speed, force=command.force)
