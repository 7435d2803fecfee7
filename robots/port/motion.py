"""An active motion, and how it ended."""

from __future__ import annotations

from enum import Enum
from typing import Protocol

import msgspec


class MotionEnd(Enum):
    """How a motion ended; after each of them the device is at rest and ready for the next."""

    REACHED = "reached"
    CANCELED = "canceled"
    FAILED = "failed"


class MotionReport(msgspec.Struct, frozen=True, kw_only=True):
    """The end of a motion; `reason` states why it failed (joint, amount, contact).

    `contact` is true when the expected contact ended the motion. `data` is the record of the kind of
    motion, see `ForceRecord`; for a stream of joint angles the clipping warning (UTF-8), empty
    without clipping; empty for the others. `at_rest` is false if the device could not be brought to rest.
    """

    end: MotionEnd
    reason: str = ""
    contact: bool = False
    data: bytes = b""
    at_rest: bool = True


class Motion(Protocol):
    """An active motion."""

    @property
    def progress(self) -> float:
        """Elapsed share of the trajectory's time, 0 to 1."""
        ...

    async def report(self) -> MotionReport:
        """Wait for the end; several tasks may await it, also after the end."""
        ...

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest, or when the motion has ended or been resumed meanwhile."""
        ...

    async def resume(self) -> None:
        """Resume along the path and return when moving, or when the motion has ended or been held meanwhile."""
        ...

    def cancel(self) -> None:
        """Request deceleration on the path; `report` then returns CANCELED once at rest."""
        ...


class MotionStream(Motion, Protocol):
    """A motion that follows streamed values; it ends only by `finish` or `cancel`.

    Without values for longer than its watchdog time it comes to rest and stays there
    until the next values.
    """

    def send(self, values: tuple[float, ...], *, age_s: float = 0.0) -> None:
        """Send target positions or velocities; the kind of stream defines their meaning.

        `age_s` is the age of the values when they are forwarded: the watchdog counts from their origin.

        Raises:
            RobotError: wrong number of values, a value that is not finite, or the device is lost.
        """
        ...

    def finish(self) -> None:
        """Request to come to rest and end as REACHED; a held stream ends where it stands."""
        ...
