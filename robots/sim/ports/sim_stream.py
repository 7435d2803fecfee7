"""A stream in a simulated world: a motion that is told what to do at every instant."""

from __future__ import annotations

import math
from collections.abc import Callable

from engine.errors import RobotError
from robots.sim.commands.arm_commands import FinishStream, Setpoint
from robots.sim.commands.world_commands import AnyCommand
from robots.sim.ports.motion_registry import SimMotion


class SimStream(SimMotion):
    """Implements `robots.port.MotionStream`.

    Args:
        number: Of the motion.
        arm: Who carries it out.
        width: How many numbers it is told at a time.
        send: Gives a command to the world.
        progress: Measures its progress.
    """

    def __init__(
        self,
        number: int,
        *,
        arm: str,
        width: int,
        send: Callable[[AnyCommand], None],
        progress: Callable[[], float | None],
    ) -> None:
        super().__init__(number, send=send, progress=progress)
        self._arm = arm
        self._width = width
        self._tell = send

    def send(self, values: tuple[float, ...], *, age_s: float = 0.0) -> None:
        """Say where to, or how fast, to go from now on, as told `age_s` ago; says nothing once it has ended.

        Raises:
            RobotError: wrong number of values, one that is not finite, or the world is lost.
        """
        if len(values) != self._width or not all(map(math.isfinite, values)):
            raise RobotError(
                f"{values} cannot be sent",
                where=self._arm,
                hint=f"send {self._width} finite numbers" if self._width else "this stream takes none",
            )
        if not self.ended:
            told = tuple(map(float, values))
            self._tell(Setpoint(arm=self._arm, motion=self.number, values=told, age_s=age_s))

    def finish(self) -> None:
        """Ask to come to rest and end as REACHED."""
        if not self.ended:
            self._tell(FinishStream(arm=self._arm, motion=self.number))
