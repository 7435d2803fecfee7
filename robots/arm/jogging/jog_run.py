"""One active jog: streams its own velocity for a duration, or published commands until they stop."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from typing import Any

import numpy as np

from engine.bus import ActiveGoal
from engine.clock import Clock
from engine.errors import GoalRejected, RobotError
from engine.skills.axes import Axes
from engine.skills.jogging import JogCommand, JogJoints, JogTool
from robots.arm.execution.begun_motion import canceled_by_errors
from robots.arm.execution.stream_deadline import StreamDeadline
from robots.arm.execution.validate_numbers import are_numbers
from robots.arm.jogging.jog_guard import JogGuard
from robots.arm.jogging.press_queue import PressQueue, Row
from robots.port import MotionStream
from robots.supervise_goal import FEEDBACK_S

# Rounding must not let a timer of virtual time wait for nothing forever.
_SOONEST_S = 0.001
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
        to_command: Converts a velocity, in the given axes or those of the goal, to the command that is sent now.
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
        to_command: Callable[[Row, Axes | None], Row],
        guard: JogGuard | None,
    ) -> None:
        self._velocity = velocity
        self._duration_s = goal.duration_s if velocity else goal.idle_s
        self._handle = handle
        self._clock = clock
        self._width = width
        self._to_command = to_command
        self._guard = guard
        self._replaceable = goal.replaceable
        self._stream: MotionStream | None = None
        self._deadline: StreamDeadline | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._heard_s = clock.now_s()
        # Its own velocity is resent only with the feedback, so the watchdog must be longer than that period.
        self.watchdog_s = max(goal.watchdog_s, _REPEATED_S) if velocity else goal.watchdog_s
        self._presses = PressQueue(self.watchdog_s)
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
        with canceled_by_errors(stream):
            self.look()
            if self._presses.current is not None:
                self._send()
            self._handle.replaceable = self._replaceable and self._presses.current is None
            if self._guard is not None:
                self._guard.watch_ahead(self._send_again)
        return stream

    @property
    def frame(self) -> Axes | None:
        """The axes of the velocity that is commanded now; None for those of the goal."""
        return self._presses.current.frame if self._presses.current is not None else None

    @property
    def dropped(self) -> int:
        """How many presses have ended before the arm could move along them."""
        return self._presses.dropped

    def look(self) -> None:
        """Resend the velocity before the watchdog expires, and end the stream at its deadline."""
        if self._velocity:
            self._hear(JogCommand(velocity=self._velocity))
        press = self._presses.current
        if press is not None and (self._velocity or press.released_s is not None):
            self._send()
        if self._deadline is not None:
            self._deadline.look()

    def take(self, command: JogCommand) -> None:
        """Move as commanded, after the presses before; an invalid command is ignored and logged."""
        if self._velocity:
            return
        if problem := self._velocity_error(command.velocity):
            _log.warning("%s: %s; command ignored", self._handle.address, problem)
            return
        if self._deadline is not None:
            self._deadline.restart()
        self._hear(command)
        self._send_again()

    def close(self) -> None:
        """Release the ended stream."""
        self._stream = None
        if self._deadline is not None:
            self._deadline.close()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _hear(self, command: JogCommand) -> None:
        self._heard_s = self._clock.now_s()
        self._presses.take(command, self._heard_s)

    def _send_again(self) -> None:
        """Send what is commanded now, as after a command, a changed speed limit, or the end of a press."""
        try:
            self._send()
        except RobotError as error:
            # The goal itself ends with the reason; a topic has no reply to the publisher.
            _log.warning("%s: %s", self._handle.address, error)

    def _send(self) -> None:
        """Send the velocity of the press under way; zero without one.

        A held press keeps the age of its last command, so the watchdog of the stream expires on time. A released one
        is repeated here until it has been executed.
        """
        if self._stream is None:
            return
        now_s = self._clock.now_s()
        while True:
            press = self._presses.advance(now_s)
            velocity = press.velocity if press is not None else (0.0,) * self._width
            command = self._to_command(velocity, press.frame if press is not None else None)
            sent = command if self._guard is None else self._guard.bounded(command)
            if press is not None and press.is_silent(now_s, self.watchdog_s):
                sent = (0.0,) * len(sent)
            if press is None:
                self._stream.send(sent, age_s=now_s - self._heard_s)
                break
            if press.moving_since_s is None and any(sent):
                press.moving_since_s = now_s
            press.blocked = self._guard is not None and self._guard.is_blocked
            if press.over_s(self.watchdog_s) > now_s:
                age_s = 0.0 if press.released_s is not None else now_s - press.heard_s
                self._stream.send(sent, age_s=max(age_s, self._unchecked_age_s()))
                break
        self._handle.replaceable = self._replaceable and press is None
        self._wait_for_end(now_s)

    def _unchecked_age_s(self) -> float:
        """Return the age with which the stream's watchdog stops the arm when the check of its path is out of date."""
        return max(0.0, self.watchdog_s - self._guard.valid_s) if self._guard is not None else 0.0

    def _wait_for_end(self, now_s: float) -> None:
        if self._timer is not None:
            self._timer.cancel()
        due_s = self._presses.due_s()
        self._timer = (
            asyncio.get_running_loop().call_later(max(_SOONEST_S, due_s - now_s), self._send_again)
            if due_s is not None and not self._velocity
            else None
        )

    def _velocity_error(self, velocity: Row) -> str:
        if not are_numbers(velocity):
            return f"{velocity!r} is not a velocity"
        if len(velocity) != self._width:
            return f"the velocity has {len(velocity)} components, expected {self._width}"
        if not np.isfinite(velocity).all():
            return f"the velocity {velocity} is not finite"
        fastest = float(np.abs(velocity).max())
        return f"the velocity {fastest:.3g} exceeds {_MAX_PLAUSIBLE:g}" if fastest > _MAX_PLAUSIBLE else ""
