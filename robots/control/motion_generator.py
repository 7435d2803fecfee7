"""What a motion generator is: where the set point of an arm goes, one control period after the other (RCY 4.3)."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from robots.control.arm_state import ArmState
from robots.port import Array


class MotionGenerator(Protocol):
    """The set point of one motion.

    `position`, `velocity` and `acceleration` are the set point now, shape (n,), reused by `step`.
    Whatever it is told, the set point keeps the limits of the arm; at pace 0 it comes to rest on
    its path within them and stays there.
    """

    position: Array
    velocity: Array
    acceleration: Array

    @property
    def stopped(self) -> bool:
        """True when the set point stands still: brought to rest, or at the end."""
        ...

    @property
    def moving(self) -> bool:
        """True once the set point is under way again after a rest, or there is no way left."""
        ...

    @property
    def complete(self) -> bool:
        """True when there is nothing left to do; the motion then settles and ends as reached."""
        ...

    @property
    def contact(self) -> bool:
        """True when it is complete because of the contact that it was to end at."""
        ...

    @property
    def progress(self) -> float:
        """Share of the way that is passed, 0 to 1."""
        ...

    @property
    def goal(self) -> Array | None:
        """Where the measured joints must settle, (n,); None when anywhere is right."""
        ...

    @property
    def leads(self) -> bool:
        """False when the set point follows the arm and not the arm the set point."""
        ...

    @property
    def failure(self) -> str:
        """Why it cannot go on, in words; empty while it can. The motion then comes to rest and ends as failed."""
        ...

    def step(self, step_s: float, *, target_pace: float, state: ArmState) -> None:
        """Move the set point on by `step_s` of real time, changing its pace towards `target_pace` (0 to 1)."""
        ...

    def data(self) -> bytes:
        """What it has recorded, for `MotionReport.data`; empty for most."""
        ...


@runtime_checkable
class StreamGenerator(MotionGenerator, Protocol):
    """A generator that does what it is told at every instant, see `robots.port.MotionStream`."""

    def receive(self, values: Array, *, age_s: float = 0.0) -> None:
        """Take where to, or how fast, to go from now on; the watchdog counts from when it was said, `age_s` ago."""
        ...

    def finish(self) -> None:
        """Come to rest, and be complete then."""
        ...
