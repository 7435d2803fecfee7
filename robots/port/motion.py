"""A motion under way, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Protocol


class MotionEnd(Enum):
    """How a motion ended; after each of them the device is at rest and ready for the next."""

    REACHED = "reached"
    CANCELED = "canceled"
    FAILED = "failed"


@dataclass(frozen=True, kw_only=True)
class MotionReport:
    """The end of a motion; `reason` says in words why it failed (joint, amount, contact).

    `contact` is true when a motion that was to end at a contact did. `data` is what the kind of
    motion recorded, see `ForceRecord`; a stream of joint angles has there the words (UTF-8) of
    what it had to clip, empty for nothing; empty for the others. `at_rest` is false where the device
    could not be brought to rest.
    """

    end: MotionEnd
    reason: str = ""
    contact: bool = False
    data: bytes = b""
    at_rest: bool = True


class Motion(Protocol):
    """A motion under way."""

    @property
    def progress(self) -> float:
        """Share of the trajectory's time passed, 0 to 1."""
        ...

    async def report(self) -> MotionReport:
        """Wait for the end; may be awaited by several, and again after the end."""
        ...

    async def hold(self) -> None:
        """Decelerate on the path and return when at rest, or when the motion ended or was resumed meanwhile."""
        ...

    async def resume(self) -> None:
        """Go on along the path and return when moving, or when the motion ended or was held meanwhile."""
        ...

    def cancel(self) -> None:
        """Ask to decelerate on the path; `report` then returns CANCELED once at rest."""
        ...


class MotionStream(Motion, Protocol):
    """A motion that follows what it is told at every instant; it ends by `finish` or `cancel` only.

    When nothing was said for longer than its watchdog allows, it comes to rest and stays there
    until it is told something again.
    """

    def send(self, values: tuple[float, ...], *, age_s: float = 0.0) -> None:
        """Say where to (or how fast to) go from now on; the kind of stream gives the meaning.

        `age_s` is how long ago it was said where that is passed on anew: the silence counts from then.

        Raises:
            RobotError: wrong number of values, one that is not finite, or the device is gone.
        """
        ...

    def finish(self) -> None:
        """Ask to come to rest and end as REACHED; one that is held ends where it stands."""
        ...
