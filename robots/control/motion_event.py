"""Events of the motions in a control loop, as plain messages."""

from __future__ import annotations

import msgspec

from robots.port import MotionReport


class MotionEvent(msgspec.Struct, frozen=True, kw_only=True):
    """An event of the motion with this number."""

    motion: int


class MotionFinished(MotionEvent, frozen=True, kw_only=True, tag="finished"):
    """The motion ended; `progress` is its completed share."""

    progress: float
    report: MotionReport


class MotionHeld(MotionEvent, frozen=True, kw_only=True, tag="held"):
    """The motion stands still on its path; `request` is the number of the latest hold or resume behind it."""

    request: int = 0


class MotionResumed(MotionEvent, frozen=True, kw_only=True, tag="resumed"):
    """The motion moves along its path again; `request` is the number of the latest hold or resume behind it."""

    request: int = 0


class ReflexTripped(MotionEvent, frozen=True, kw_only=True, tag="reflex"):
    """The collision reflex stopped the arm, with the reason; the active motion, 0 for none, will fail."""

    arm: str
    reason: str


class SetPointJumped(MotionEvent, frozen=True, kw_only=True, tag="jumped"):
    """A set point exceeded a limit of the arm; `motion` is the active motion, 0 for none.

    It changed from the generator `before` to `generator` within the last periods, or both are the same. `quantity` is
    position, velocity, acceleration or jerk, and `ratio` its share of the limit.
    """

    arm: str
    before: str
    generator: str
    quantity: str
    ratio: float
    reason: str


AnyMotionEvent = MotionFinished | MotionHeld | MotionResumed | ReflexTripped | SetPointJumped
