"""The motion generator interface: the set point of an arm, computed every control period (RCY 4.3)."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from robots.control.arm_state import ArmState
from robots.port import Array


class MotionGenerator(Protocol):
    """The set point of one motion.

    `position`, `velocity` and `acceleration` are the present set point, shape (n,), reused by `step`.
    For any input the set point keeps the limits of the arm; at pace 0 it comes to rest on
    its path within them and stays there.
    """

    position: Array
    velocity: Array
    acceleration: Array

    @property
    def name(self) -> str:
        """What it is, for messages."""
        ...

    @property
    def stopped(self) -> bool:
        """True when the set point stands still: held, or at the end."""
        ...

    @property
    def moving(self) -> bool:
        """True once the set point moves again after a rest, or nothing is left to do."""
        ...

    @property
    def complete(self) -> bool:
        """True when nothing is left to do; the motion then settles and ends as REACHED."""
        ...

    @property
    def contact(self) -> bool:
        """True when the expected contact completed the motion."""
        ...

    @property
    def progress(self) -> float:
        """Completed share of the motion, 0 to 1."""
        ...

    @property
    def goal(self) -> Array | None:
        """Where the measured joints must settle, (n,); None for anywhere."""
        ...

    @property
    def leads(self) -> bool:
        """False when the set point follows the arm, as in guiding."""
        ...

    @property
    def failure(self) -> str:
        """Why the motion cannot continue; empty while it can. The motion then comes to rest and ends as FAILED."""
        ...

    def step(self, step_s: float, *, target_pace: float, state: ArmState) -> None:
        """Advance the set point by `step_s` of real time, changing its pace towards `target_pace` (0 to 1)."""
        ...

    def data(self) -> bytes:
        """Return recorded data for `MotionReport.data`; empty for most."""
        ...


@runtime_checkable
class StreamGenerator(MotionGenerator, Protocol):
    """A generator that follows streamed values, see `robots.port.MotionStream`."""

    def receive(self, values: Array, *, age_s: float = 0.0) -> None:
        """Set the target positions or velocities; the watchdog counts from when they were sent, `age_s` ago."""
        ...

    def finish(self) -> None:
        """Come to rest, then be complete."""
        ...
