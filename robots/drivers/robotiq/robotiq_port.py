"""The port of a real Robotiq gripper: metres and newton outside, counts inside; moves only while it is enabled."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable

from robots.drivers.fresh_link import FreshLink, FreshReading
from robots.drivers.robotiq.gripper_registers import GripperCommand, GripperStatus, ObjectStatus
from robots.drivers.robotiq.gripper_units import (
    MAX_FORCE_N,
    WidthTable,
    count_of_width,
    force_count,
    force_of_count,
    speed_count,
    speed_of_count,
    width_of_count,
)
from robots.drivers.robotiq.robotiq_motion import RobotiqMotion, stop_command
from robots.drivers.tool_command import require_free, require_values
from robots.port import GripperSample

PATIENCE_S = 2.0
"""By default, a motion of the fingers may be late by so much."""
_log = logging.getLogger("flexcell.devices")
_UNKNOWN = "?"


class RobotiqPort:
    """Implements `robots.port.GripperPort`.

    Args:
        name: Name of the gripper, for messages.
        link: Its connection.
        widths: Measured counts and openings.
        blocked: Returns why it may not move; empty if it may.
        patience_s: Seconds by which a motion of the fingers may be late.
    """

    def __init__(
        self,
        name: str,
        link: FreshLink[GripperStatus, GripperCommand],
        *,
        widths: WidthTable,
        blocked: Callable[[], str],
        patience_s: float = PATIENCE_S,
    ) -> None:
        self._name = name
        self._link = link
        self._widths = widths
        self._blocked = blocked
        self._patience_s = patience_s
        self._motion: RobotiqMotion | None = None
        self._command: GripperCommand | None = None
        self._velocity_m_s = 0.0
        self.commanded_s = 0.0
        """When the last command was given, on the monotonic clock."""
        self.commanded_go = False
        """Whether it was one to go."""
        self._previous: FreshReading[GripperStatus] | None = None

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        return self._widths[0][1]

    @property
    def max_force_n(self) -> float:
        """Maximum grip force."""
        return MAX_FORCE_N

    @property
    def motion(self) -> RobotiqMotion | None:
        """The active motion."""
        return self._motion if self._motion is not None and not self._motion.ended else None

    @property
    def command(self) -> GripperCommand | None:
        """The last motion command since it was enabled."""
        return self._command

    def sample(self) -> GripperSample:
        """Return the latest measurement.

        The gripper measures no force: the commanded one is reported while it detects an object, else 0. It does not
        name what it touches either.

        Raises:
            RobotError: there is no fresh one.
        """
        status, latest = self._link.fresh(), self._link.latest
        assert latest is not None
        touching = status.contact in (ObjectStatus.CONTACT_OPENING, ObjectStatus.CONTACT_CLOSING)
        force_n = force_of_count(self._command.force) if touching and self._command is not None else 0.0
        return GripperSample(
            time_s=latest.asked_s,
            width_m=width_of_count(status.position, self._widths),
            velocity_m_s=self._velocity_m_s,
            force_n=force_n,
            contacts=(_UNKNOWN, _UNKNOWN) if touching else ("", ""),
        )

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> RobotiqMotion:
        """Move the fingers towards `width_m` (open or close), pressing with at most `force_n`.

        Raises:
            RobotError: it may not move, another motion is active, or a value is invalid.
        """
        positive = {"speed_m_s": speed_m_s, "force_n": force_n}
        require_values(self._name, positive=positive, zero_or_more={"width_m": width_m})
        status = self._link.fresh()
        require_free(self._name, blocked=self._blocked(), motion=self.motion)
        self._command = command = GripperCommand(
            activate=True,
            go=True,
            position=count_of_width(width_m, self._widths),
            speed=speed_count(speed_m_s),
            force=force_count(force_n),
        )
        limit_s = self.max_width_m / speed_of_count(command.speed) + self._patience_s
        self._link.arm(stop_command(command))
        self._motion = RobotiqMotion(command, self._submit, start=status.position, limit_s=limit_s)
        return self._motion

    def take(self, reading: FreshReading[GripperStatus]) -> None:
        """Apply a reading."""
        if self._previous is not None and reading.asked_s > self._previous.asked_s:
            moved_m = width_of_count(reading.value.position, self._widths) - width_of_count(
                self._previous.value.position, self._widths
            )
            self._velocity_m_s = moved_m / (reading.asked_s - self._previous.asked_s)
        self._previous = reading
        if self._motion is not None:
            self._motion.take(reading)
            if self._motion.ended:
                self._motion = None
                self._link.arm(None)

    def fail(self, reason: str, *, at_rest: bool) -> None:
        """End the active motion as failed."""
        if self._motion is not None:
            self._motion.fail(reason, at_rest=at_rest)
            self._motion = None
        self._link.arm(None)

    def withdraw(self) -> None:
        """Withdraw the last command, so that the fingers do not go on by themselves when a fault ends."""
        if self._command is not None and self.commanded_go:
            self._submit(stop_command(self._command)).add_done_callback(_note_failure)

    def note_stop(self) -> None:
        """Note that the connection itself has stopped the fingers."""
        self.commanded_s, self.commanded_go = time.monotonic(), False

    def forget(self) -> None:
        """Forget the last command: the gripper was enabled anew."""
        self._command = None

    def _submit(self, command: GripperCommand) -> asyncio.Future[float]:
        self.commanded_s, self.commanded_go = time.monotonic(), command.go
        return self._link.submit(command)


def _note_failure(written: asyncio.Future[float]) -> None:
    error = written.exception()
    if error is not None:
        _log.error("the command of a gripper with a fault could not be withdrawn: %s", error)
