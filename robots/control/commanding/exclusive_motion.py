"""Limits the port of a device to one motion at a time."""

from __future__ import annotations

from collections.abc import Callable

from engine.errors import RobotError
from robots.control.commanding.motion_registry import CommandedMotion, MotionRegistry


class ExclusiveMotion:
    """At most one motion of one device at a time."""

    def __init__(self, device: str, board: MotionRegistry) -> None:
        self._device = device
        self._board = board
        self._motion: CommandedMotion | None = None

    @property
    def active(self) -> CommandedMotion | None:
        """The motion that has not ended; None without one."""
        return self._motion if self._motion is not None and not self._motion.ended else None

    def number(self) -> int:
        """Return the number for the next motion; raises RobotError while one is active."""
        if self.active is not None:
            raise RobotError(
                "another motion is active", where=self._device, hint="wait for its report, or cancel it first"
            )
        return self._board.next_number()

    def start(self, motion: CommandedMotion, send: Callable[[], None]) -> CommandedMotion:
        """Send its command and keep the motion; a motion that could not be sent is not active."""
        send()
        self._board.add(motion)
        self._motion = motion
        return motion
