"""One motion of a Robotiq gripper, followed by its readings; implements `robots.port.Motion`."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.errors import RobotError
from robots.drivers.fresh_link import FreshReading
from robots.drivers.robotiq.gripper_registers import GripperCommand, GripperStatus, ObjectStatus
from robots.port import MotionEnd, MotionReport

ECHO_LIMIT_S = 1.0
_REST_READINGS = 2

Submit = Callable[[GripperCommand], "asyncio.Future[float]"]


class RobotiqMotion:
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
        self.command = command
        self._submit = submit
        self._start = start
        self._limit_s = limit_s
        self._loop = asyncio.get_running_loop()
        self._end: asyncio.Future[MotionReport] = self._loop.create_future()
        self._held: asyncio.Future[None] | None = None
        self._position = start
        self._sent_s = float("inf")
        self._moving_s = 0.0
        self._stopping = False
        self._canceled = False
        self._same = 0
        self._previous: GripperStatus | None = None
        self._last_s = 0.0
        self._send(command)

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._end.done()

    @property
    def progress(self) -> float:
        """Share of the counts passed; 1 at the end."""
        if self._end.done() and self._end.result().end is MotionEnd.REACHED:
            return 1.0
        total = abs(self.command.position - self._start)
        return min(1.0, abs(self._position - self._start) / total) if total else 0.0

    async def report(self) -> MotionReport:
        """Wait for the end; cancelling one waiter affects neither the motion nor other waiters."""
        return await asyncio.shield(self._end)

    async def hold(self) -> None:
        """Stop the fingers and return when they are at rest, or when the motion has ended or been resumed."""
        if self.ended:
            return
        if self._held is None:
            self._held = self._loop.create_future()
        held = self._held
        self._stop()
        await asyncio.shield(held)

    async def resume(self) -> None:
        """Move on to the same position."""
        if self.ended or self._canceled:
            return
        held, self._held = self._held, None
        self._stopping = False
        self._send(self.command)
        if held is not None and not held.done():
            held.set_result(None)

    def cancel(self) -> None:
        """Stop the fingers; `report` then returns CANCELED once they are at rest."""
        if not self.ended and not self._canceled:
            self._canceled = True
            self._stop()

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
            self._rest(status)
        elif status.go and status.position_echo == self.command.position:
            self._arrive(status)
        elif reading.asked_s - self._sent_s > ECHO_LIMIT_S:
            self.fail(f"the gripper did not take the request for position {self.command.position}")
        if not self.ended and self._moving_s > self._limit_s:
            self._canceled = self._stopping = True
            self._submit_stop()
            self.fail(f"the fingers did not end their motion within {self._limit_s:.1f} s")

    def fail(self, reason: str, *, at_rest: bool = True) -> None:
        """End as failed."""
        self._finish(MotionReport(end=MotionEnd.FAILED, reason=reason, at_rest=at_rest))

    def _arrive(self, status: GripperStatus) -> None:
        if status.contact is not ObjectStatus.MOVING and self._same >= 1:
            contact = status.contact is not ObjectStatus.AT_POSITION
            self._finish(MotionReport(end=MotionEnd.REACHED, contact=contact))

    def _rest(self, status: GripperStatus) -> None:
        if status.go or self._same < _REST_READINGS:
            return
        if self._canceled:
            self._finish(MotionReport(end=MotionEnd.CANCELED))
        elif self._held is not None and not self._held.done():
            self._held.set_result(None)

    def _stop(self) -> None:
        if not self._stopping:
            self._stopping = True
            self._submit_stop()

    def _submit_stop(self) -> None:
        self._send(stop_command(self.command))

    def _send(self, command: GripperCommand) -> None:
        self._sent_s, self._same, self._previous = float("inf"), 0, None
        written = self._submit(command)
        written.add_done_callback(self._acknowledge)

    def _acknowledge(self, written: asyncio.Future[float]) -> None:
        error = written.exception()
        if error is None:
            self._sent_s = self._last_s = written.result()
        elif isinstance(error, RobotError):
            # Nobody knows whether the request has arrived.
            self.fail(f"a command was not acknowledged: {error.message}", at_rest=False)
        else:
            raise error

    def _finish(self, report: MotionReport) -> None:
        if not self._end.done():
            self._end.set_result(report)
        if self._held is not None and not self._held.done():
            self._held.set_result(None)


def stop_command(command: GripperCommand) -> GripperCommand:
    """Return the command that stops the fingers where they are; what they hold stays held."""
    return GripperCommand(activate=True, go=False, position=command.position, speed=command.speed, force=command.force)
