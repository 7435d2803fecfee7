"""One active jog: streams its own velocity for a duration, or published commands until they stop."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

import numpy as np

from engine.bus import ActiveGoal
from engine.clock import Clock
from engine.errors import GoalRejected, RobotError
from engine.skills.jogging import JogCommand, JogJoints, JogTool
from robots.arm.execution.stream_deadline import StreamDeadline
from robots.arm.execution.validate_numbers import are_numbers
from robots.arm.jogging.jog_guard import JogGuard
from robots.port import MotionStream
from robots.supervise_goal import FEEDBACK_S

Row = tuple[float, ...]
_REPEATED_S = 4.0 * FEEDBACK_S
# Largest plausible velocity, in m/s or rad/s: beyond all arms, and products of larger ones may overflow.
_MAX_PLAUSIBLE = 1e6
_log = logging.getLogger("flexcell.arm")


class JogRun:
    """Drives one velocity stream.

    Args:
        goal: Gives the durations.
        velocity: The goal's own velocity; empty to follow published commands.
        handle: The goal's handle.
        width: Number of components of a velocity.
        to_command: Converts a velocity as given to the command that is sent now.
        guard: Collision guard, if any; opened and closed by the owner.

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
        to_command: Callable[[Row], Row],
        guard: JogGuard | None,
    ) -> None:
        self._velocity = velocity
        self._duration_s = goal.duration_s if velocity else goal.idle_s
        self._handle = handle
        self._clock = clock
        self._width = width
        self._to_command = to_command
        self._guard = guard
        self._command: Row = (0.0,) * width
        self._command_s = clock.now_s()
        self._stream: MotionStream | None = None
        self._deadline: StreamDeadline | None = None
        # Its own velocity is resent only with the feedback, so the watchdog must be longer than that period.
        self.watchdog_s = max(goal.watchdog_s, _REPEATED_S) if velocity else goal.watchdog_s
        if bool(velocity) != (goal.duration_s is not None):
            raise GoalRejected(
                "a velocity and `duration_s` are only valid together",
                where=handle.address,
                hint="give both, or neither and publish velocities on `<arm>/jog`",
            )
        if velocity and (problem := self._velocity_error(velocity)):
            raise GoalRejected(problem, where=handle.address)

    def start(self, stream: MotionStream) -> MotionStream:
        """Drive `stream` from now on."""
        self._stream = stream
        self._deadline = StreamDeadline(stream, self._handle, clock=self._clock, duration_s=self._duration_s)
        self.look()
        if self._guard is not None:
            self._guard.watch_ahead(self._on_limit_change)
        return stream

    def look(self) -> None:
        """Resend the velocity before the watchdog expires, and end the stream at its deadline."""
        if self._velocity:
            self._send(self._velocity)
        if self._deadline is not None:
            self._deadline.look()

    def take(self, command: JogCommand) -> None:
        """Move at this velocity until the next command; an invalid one is ignored and logged."""
        if self._velocity:
            return
        velocity = command.velocity
        if problem := self._velocity_error(velocity):
            _log.warning("%s: %s; command ignored", self._handle.address, problem)
            return
        if self._deadline is not None:
            self._deadline.restart()
        try:
            self._send(velocity)
        except RobotError as error:
            # The goal itself ends with the reason; a topic has no reply to the publisher.
            _log.warning("%s: %s", self._handle.address, error)

    def close(self) -> None:
        """Release the ended stream."""
        self._stream = None
        if self._deadline is not None:
            self._deadline.close()

    def _send(self, velocity: Row) -> None:
        """Send a new command."""
        self._command, self._command_s = velocity, self._clock.now_s()
        self._resend()

    def _resend(self) -> None:
        if self._stream is not None:
            command = self._to_command(self._command)
            age_s = self._clock.now_s() - self._command_s
            self._stream.send(command if self._guard is None else self._guard.bounded(command), age_s=age_s)

    def _on_limit_change(self) -> None:
        """Apply a changed speed limit to the last command; without recent commands the arm comes to rest.

        A resent command keeps its age, so the watchdog of the stream expires on time; once it has expired, the
        guard has nothing left to check.
        """
        if self._clock.now_s() - self._command_s >= self.watchdog_s:
            self._command = (0.0,) * self._width
        try:
            self._resend()
        except RobotError as error:
            # The goal itself ends with the reason.
            _log.warning("%s: %s", self._handle.address, error)

    def _velocity_error(self, velocity: Row) -> str:
        if not are_numbers(velocity):
            return f"{velocity!r} is not a velocity"
        if len(velocity) != self._width:
            return f"the velocity has {len(velocity)} components, expected {self._width}"
        if not np.isfinite(velocity).all():
            return f"the velocity {velocity} is not finite"
        fastest = float(np.abs(velocity).max())
        return f"the velocity {fastest:.3g} exceeds {_MAX_PLAUSIBLE:g}" if fastest > _MAX_PLAUSIBLE else ""
