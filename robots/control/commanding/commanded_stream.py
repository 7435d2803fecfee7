"""A stream to a control loop: a motion that follows streamed values."""

from __future__ import annotations

import math
from collections.abc import Callable

from engine.errors import RobotError
from robots.control.commanding.arm_commands import ArmCommand, FinishStream, MotionCommand, Setpoint
from robots.control.commanding.motion_registry import CommandedMotion


class CommandedStream(CommandedMotion):
    """Implements `robots.port.MotionStream`.

    Args:
        number: Number of the motion.
        arm: Name of the executing arm.
        width: Number of values per message.
        send: Sends a command to the control loop.
        progress: Returns the progress of the motion.
    """

    def __init__(
        self,
        number: int,
        *,
        arm: str,
        width: int,
        send: Callable[[ArmCommand | MotionCommand], None],
        progress: Callable[[], float | None],
    ) -> None:
        super().__init__(number, send=send, progress=progress)
        self._arm = arm
        self._width = width
        self._send_command = send

    def send(self, values: tuple[float, ...], *, age_s: float = 0.0) -> None:
        """Send target positions or velocities that are `age_s` old; does nothing after the end.

        Raises:
            RobotError: wrong number of values, a value that is not finite, or the device is lost.
        """
        if len(values) != self._width or not all(map(math.isfinite, values)):
            raise RobotError(
                f"{values} cannot be sent",
                where=self._arm,
                hint=f"send {self._width} finite numbers" if self._width else "this stream takes none",
            )
        if not self.ended:
            numbers = tuple(map(float, values))
            self._send_command(Setpoint(arm=self._arm, motion=self.number, values=numbers, age_s=age_s))

    def finish(self) -> None:
        """Request to come to rest and end as REACHED."""
        if not self.ended:
            self._send_command(FinishStream(arm=self._arm, motion=self.number))
