"""One jog under way: sends its own velocity for a time, or what it is told until nobody speaks any more."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

import numpy as np

from engine.bus import ActiveGoal
from engine.clock import Clock
from engine.errors import GoalRejected, RobotError
from engine.skills.jogging import JogCommand, JogJoints, JogTool
from robots.arm.jog_guard import JogGuard
from robots.arm.stream_deadline import StreamDeadline
from robots.arm.validate_numbers import are_numbers
from robots.port import MotionStream
from robots.supervise_goal import FEEDBACK_S

Row = tuple[float, ...]
_REPEATED_S = 4.0 * FEEDBACK_S
# What nobody means: m/s or rad/s beyond all arms, whose products may overflow.
_ABSURD = 1e6
_log = logging.getLogger("flexcell.arm")


class JogRun:
    """Leads one velocity stream.

    Args:
        goal: How long.
        velocity: Its own velocity, empty to go as told.
        handle: The goal's handle.
        width: How many numbers a velocity has.
        mean: What to send for a velocity as given, at this moment.
        guard: What looks ahead of it, if anything does; opened and closed by the owner.

    Raises:
        GoalRejected: the velocity does not fit the arm, or comes without a duration.
    """

    def __init__(
        self,
        goal: JogJoints | JogTool,
        velocity: Row,
        handle: ActiveGoal[Any],
        *,
        clock: Clock,
        width: int,
        mean: Callable[[Row], Row],
        guard: JogGuard | None,
    ) -> None:
        self._velocity = velocity
        self._duration_s = goal.duration_s if velocity else goal.idle_s
        self._handle = handle
        self._clock = clock
        self._width = width
        self._mean = mean
        self._guard = guard
        self._told: Row = (0.0,) * width
        self._told_s = clock.now_s()
        self._stream: MotionStream | None = None
        self._countdown: StreamDeadline | None = None
        # Its own velocity is repeated with the feedback, which is no silence of anybody.
        self.watchdog_s = max(goal.watchdog_s, _REPEATED_S) if velocity else goal.watchdog_s
        if bool(velocity) != (goal.duration_s is not None):
            raise GoalRejected(
                "a velocity and `duration_s` belong together",
                where=handle.address,
                hint="give both, or none and publish velocities on `<arm>/jog`",
            )
        if velocity and (fault := self._fault(velocity)):
            raise GoalRejected(fault, where=handle.address)

    def start(self, stream: MotionStream) -> MotionStream:
        """Lead `stream` from now on."""
        self._stream = stream
        self._countdown = StreamDeadline(stream, self._handle, clock=self._clock, duration_s=self._duration_s)
        self.look()
        if self._guard is not None:
            self._guard.watch_ahead(self._looked)
        return stream

    def look(self) -> None:
        """Repeat the velocity before the watchdog bites, and end when it is time."""
        if self._velocity:
            self._send(self._velocity)
        if self._countdown is not None:
            self._countdown.look()

    def take(self, command: JogCommand) -> None:
        """Go at this velocity until told otherwise; one that does not fit is left out and named in the log."""
        if self._velocity:
            return
        velocity = command.velocity
        if fault := self._fault(velocity):
            _log.warning("%s: %s; it is left out", self._handle.address, fault)
            return
        if self._countdown is not None:
            self._countdown.restart()
        try:
            self._send(velocity)
        except RobotError as error:
            # The goal itself ends with the reason; the publisher cannot be told.
            _log.warning("%s: %s", self._handle.address, error)

    def close(self) -> None:
        """The stream has ended."""
        self._stream = None
        if self._countdown is not None:
            self._countdown.close()

    def _send(self, velocity: Row) -> None:
        """Send what was told just now."""
        self._told, self._told_s = velocity, self._clock.now_s()
        self._pass_on()

    def _pass_on(self) -> None:
        if self._stream is not None:
            told = self._mean(self._told)
            age_s = self._clock.now_s() - self._told_s
            self._stream.send(told if self._guard is None else self._guard.bounded(told), age_s=age_s)

    def _looked(self) -> None:
        """The way ahead is another: the arm may go faster, or must go slower; but for a silence it comes to rest.

        What is passed on anew keeps its age, so the watchdog of the stream bites in its time whatever happens here;
        after a silence nobody need look ahead either.
        """
        if self._clock.now_s() - self._told_s >= self.watchdog_s:
            self._told = (0.0,) * self._width
        try:
            self._pass_on()
        except RobotError as error:
            # The goal itself ends with the reason.
            _log.warning("%s: %s", self._handle.address, error)

    def _fault(self, velocity: Row) -> str:
        if not are_numbers(velocity):
            return f"{velocity!r} is no velocity"
        if len(velocity) != self._width:
            return f"a velocity of {len(velocity)} numbers was given where {self._width} are due"
        if not np.isfinite(velocity).all():
            return f"the velocity {velocity} is not finite"
        fastest = float(np.abs(velocity).max())
        return f"a velocity of {fastest:.3g} is far too fast" if fastest > _ABSURD else ""
