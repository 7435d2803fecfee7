"""One downloaded motion, followed by the state messages of the controller; implements `robots.port.Motion`.

The controller does not say when a motion has ended: it has when it is not in motion and its axes are at the target.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from engine.errors import RobotError
from robots.drivers.abb.abb_faults import AbbFault
from robots.drivers.abb.motion_link import Done
from robots.drivers.abb.path_tracker import PathTracker
from robots.port import Array, JointTrajectory, MotionEnd, MotionReport, Tolerance

MAY_MOVE = "the robot may still be moving"
_STILL_RAD = 1e-3
_IDLE_S, _START_S = 2.0, 0.5
_REST_LIMIT_S = 5.0
_MOST_STRETCH = 1.2
PATIENCE_S = 5.0


@dataclass(frozen=True, kw_only=True)
class AbbMeasurement:
    """Joints of the model; `asked_s` is when the reading was asked for, on the monotonic clock."""

    asked_s: float
    position_rad: Array
    in_motion: bool


class MotionCommands:
    """What a motion asks of the controller: `download` plans and sends, and returns with the expected time."""

    def __init__(self, download: Callable[[JointTrajectory], tuple[Done, float]], stop: Callable[[], Done]) -> None:
        self.download = download
        self.stop = stop


class _Phase(Enum):
    SENDING = "sending"
    MOVING = "moving"
    STOPPING = "stopping"
    HELD = "held"


class AbbMotion:
    """A motion along a trajectory that is downloaded again from where the arm stands after a hold.

    Args:
        trajectory: In joints of the model, from where the arm stands.
        commands: The controller.
        joint_names: For messages.
        tolerance: Of the path and at the goal.
        speed: Returns the share of the trajectory's speed for the next download.
        panel_speed: Returns the share of it that the controller permits at present, 0 to 1.
        patience_s: How much longer than a fifth beyond its time it may take.
    """

    def __init__(
        self,
        trajectory: JointTrajectory,
        commands: MotionCommands,
        *,
        joint_names: tuple[str, ...],
        tolerance: Tolerance,
        speed: Callable[[], float],
        panel_speed: Callable[[], float] = lambda: 1.0,
        patience_s: float = PATIENCE_S,
    ) -> None:
        self._commands = commands
        self._names = joint_names
        self._tolerance = tolerance
        self._speed = speed
        self._panel_speed = panel_speed
        self._patience_s = patience_s
        self._goal = trajectory.position_rad[-1]
        self._tracker = PathTracker(trajectory)
        loop = asyncio.get_running_loop()
        self._end: asyncio.Future[MotionReport] = loop.create_future()
        self._changed: asyncio.Future[None] = loop.create_future()
        self._phase = _Phase.SENDING
        self._number = 0
        self._should_move = True
        self._ending: MotionReport | None = None
        # When the download, or the stop, was confirmed; and the former alone, from which on the arm moves.
        self._since_s = self._started_s = float("inf")
        self._base_s, self._expected_s, self._used_speed = 0.0, 0.0, 1.0
        # At the speed of the panel: a slow controller takes longer, and one at 0 % waits.
        self._executed_s = 0.0
        self._extent_rad = 0.0
        self._last: AbbMeasurement | None = None
        self._still = 0
        self._has_moved = False
        self._idle_since_s: float | None = None
        self._download(trajectory)

    @property
    def ended(self) -> bool:
        """True once it has a report."""
        return self._end.done()

    @property
    def result(self) -> MotionReport | None:
        """How it ended; None while it has not."""
        return self._end.result() if self._end.done() else None

    @property
    def progress(self) -> float:
        """Passed share of the trajectory's time, by the last measurement; 1 at the end."""
        reached = self._end.done() and self._end.result().end is MotionEnd.REACHED
        return 1.0 if reached else self._tracker.progress

    async def report(self) -> MotionReport:
        """Wait for the end; cancelling one waiter affects neither the motion nor other waiters."""
        return await asyncio.shield(self._end)

    async def hold(self) -> None:
        """Request a stop and return when at rest, or when the motion has ended or been resumed."""
        if self.ended or self._ending is not None:
            return
        self._should_move = False
        self._stop()
        while not self.ended and not self._should_move and self._phase is not _Phase.HELD:
            await asyncio.shield(self._changed)

    async def resume(self) -> None:
        """Download the rest of the path and return when moving, or when the motion has ended or been held."""
        if self.ended or self._ending is not None or self._should_move:
            return
        self._should_move = True
        if self._phase is _Phase.HELD:
            self._go_on()
        self._notify()
        while not self.ended and self._should_move and not (self._phase is _Phase.MOVING and self._has_moved):
            await asyncio.shield(self._changed)

    def cancel(self) -> None:
        """Request a stop; `report` then returns CANCELED once at rest."""
        self._end_at_rest(MotionReport(end=MotionEnd.CANCELED))

    def abort(self, reason: str) -> None:
        """Request a stop and end as failed once at rest."""
        self._end_at_rest(MotionReport(end=MotionEnd.FAILED, reason=reason))

    def explain(self, reason: str) -> None:
        """Replace the reason of a motion that is being stopped, as its cause is known better now."""
        if self._ending is not None and self._ending.end is MotionEnd.FAILED:
            self._ending = MotionReport(end=MotionEnd.FAILED, reason=reason)

    def fail(self, reason: str, *, at_rest: bool) -> None:
        """End as failed now."""
        self._finish(MotionReport(end=MotionEnd.FAILED, reason=reason, at_rest=at_rest))

    def change_speed(self) -> None:
        """Stop, and download the rest at the present speed."""
        if not self.ended and self._ending is None and self._should_move:
            self._stop()

    def note_stop(self, reason: str) -> None:
        """Note that the link itself has requested a stop.

        It is requested again: a callback that waited while the event loop was blocked may have downloaded since.
        """
        self.abort(reason)

    def take(self, measured: AbbMeasurement) -> None:
        """Apply a measurement."""
        if self.ended:
            return
        last, self._last = self._last, measured
        moved = last is not None and float(np.abs(measured.position_rad - last.position_rad).max()) > _STILL_RAD
        self._still = 0 if last is None or moved or measured.in_motion else self._still + 1
        if self._phase is _Phase.HELD:
            return
        passed_s = max(0.0, measured.asked_s - self._started_s) * self._used_speed
        distance_rad = self._tracker.advance(measured.position_rad, passed_s=self._base_s + passed_s)
        if measured.asked_s <= self._since_s:
            return
        if last is not None:
            self._executed_s += (measured.asked_s - max(last.asked_s, self._since_s)) * self._panel_speed()
        if self._phase is _Phase.STOPPING:
            self._rest(measured)
        elif self._phase is _Phase.MOVING:
            if (measured.in_motion or moved) and not self._has_moved:
                self._has_moved = True
                self._notify()
            self._judge(measured, distance_rad)

    def _judge(self, measured: AbbMeasurement, distance_rad: float) -> None:
        """Find out whether the motion has arrived, or will not."""
        if distance_rad > self._tolerance.path_rad:
            self.abort(f"{AbbFault.OFF_THE_PATH.value}: a joint is {distance_rad:.3f} rad from it")
            return
        error = np.abs(measured.position_rad - self._goal)
        worst = int(np.argmax(error))
        at_goal = not measured.in_motion and self._still and error[worst] <= self._tolerance.goal_rad
        if at_goal and self._has_been_executed():
            self._finish(MotionReport(end=MotionEnd.REACHED))
            return
        moving = measured.in_motion or not self._still or self._panel_speed() == 0.0
        self._idle_since_s = None if moving else self._idle_since_s or measured.asked_s
        where = f"{self._names[worst]} is {error[worst]:.3f} rad from it"
        if self._idle_since_s is not None and measured.asked_s - self._idle_since_s > _IDLE_S:
            how = "the arm rests" if self._has_moved else "the controller did not start the motion"
            self.abort(f"{AbbFault.NOT_AT_TARGET.value}: {how}, {where}")
        elif self._executed_s > self._expected_s * _MOST_STRETCH + self._patience_s:
            self.abort(f"{AbbFault.NOT_AT_TARGET.value}: the motion takes too long, {where}")

    def _has_been_executed(self) -> bool:
        """Return whether the arm can have moved already: a path may end where it begins, and a motion begins late."""
        if self._has_moved:
            return True
        return self._extent_rad <= self._tolerance.goal_rad and self._executed_s > self._expected_s + _START_S

    def _rest(self, measured: AbbMeasurement) -> None:
        """Go on as wanted once a requested stop has ended in rest."""
        if measured.in_motion or self._still < 1:
            if measured.asked_s - self._since_s > _REST_LIMIT_S:
                reason = self._ending.reason if self._ending is not None else ""
                self.fail(
                    f"{reason or 'the motion was to stop'}; it still moves {_REST_LIMIT_S:g} s after the stop request",
                    at_rest=False,
                )
        elif self._ending is not None:
            self._finish(self._ending)
        elif self._should_move:
            self._go_on()
        else:
            self._phase = _Phase.HELD
            self._notify()

    def _go_on(self) -> None:
        assert self._last is not None, "it rests by a measurement"
        self._download(self._tracker.rest(self._last.position_rad))

    def _download(self, trajectory: JointTrajectory) -> None:
        self._phase, self._since_s, self._started_s = _Phase.SENDING, float("inf"), float("inf")
        self._base_s, self._used_speed = self._tracker.passed_s, self._speed()
        self._has_moved, self._idle_since_s, self._executed_s = False, None, 0.0
        self._extent_rad = float(np.abs(trajectory.position_rad - trajectory.position_rad[0]).max())
        self._number += 1
        number = self._number
        try:
            sent, self._expected_s = self._commands.download(trajectory)
        except RobotError as error:
            if number == 1:
                raise  # it is refused before it begins
            self.fail(error.message, at_rest=True)
            return
        sent.add_done_callback(lambda done: self._sent(number, done))

    def _sent(self, number: int, sent: Done) -> None:
        error = sent.exception()
        if number != self._number or self._phase is not _Phase.SENDING:
            return  # a stop was requested meanwhile, and reports itself
        if error is not None:
            self.fail(f"the download failed: {_message(error)}; {MAY_MOVE}", at_rest=False)
            return
        self._phase, self._since_s, self._started_s = _Phase.MOVING, sent.result(), sent.result()

    def _end_at_rest(self, report: MotionReport) -> None:
        if self.ended or self._ending is not None:
            return
        self._ending = report
        if self._phase is _Phase.HELD:
            self._finish(report)
        else:
            self._stop()

    def _stop(self) -> None:
        if self._phase in (_Phase.STOPPING, _Phase.HELD):
            return
        self._phase, self._since_s = _Phase.STOPPING, float("inf")
        self._commands.stop().add_done_callback(self._stop_sent)

    def _stop_sent(self, sent: Done) -> None:
        error = sent.exception()
        if error is not None:
            reason = f"{self._ending.reason}; " if self._ending is not None and self._ending.reason else ""
            self.fail(f"{reason}the stop request failed: {_message(error)}; {MAY_MOVE}", at_rest=False)
        elif self._phase is _Phase.STOPPING:
            self._since_s, self._still = sent.result(), 0

    def _finish(self, report: MotionReport) -> None:
        if not self._end.done():
            self._end.set_result(report)
        self._notify()

    def _notify(self) -> None:
        changed, self._changed = self._changed, asyncio.get_running_loop().create_future()
        changed.set_result(None)


def _message(error: BaseException) -> str:
    return error.message if isinstance(error, RobotError) else str(error)
