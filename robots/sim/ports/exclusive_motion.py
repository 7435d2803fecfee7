"""Limits the port of a simulated device to one motion at a time."""

from __future__ import annotations

from engine.errors import RobotError
from robots.sim.commands.world_commands import AnyCommand
from robots.sim.host.world_host import WorldHost
from robots.sim.ports.motion_registry import MotionRegistry, SimMotion


class ExclusiveMotion:
    """At most one motion of one device at a time."""

    def __init__(self, device: str, board: MotionRegistry) -> None:
        self._device = device
        self._board = board
        self._motion: SimMotion | None = None

    def number(self) -> int:
        """Return the number for the next motion; raises RobotError while one is active."""
        if self._motion is not None and not self._motion.ended:
            raise RobotError(
                "another motion is active", where=self._device, hint="wait for its report, or cancel it first"
            )
        return self._board.next_number()

    def start(self, motion: SimMotion, host: WorldHost, command: AnyCommand) -> SimMotion:
        """Send the command and keep the motion; a motion that could not be sent is not active."""
        host.send(command)
        self._board.add(motion)
        self._motion = motion
        return motion
