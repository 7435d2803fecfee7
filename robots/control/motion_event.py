"""What a control loop tells about the motions it carries out, as plain messages."""

from __future__ import annotations

import msgspec


class MotionEvent(msgspec.Struct, frozen=True, kw_only=True, tag_field="event"):
    """Something happened to the motion with this number."""

    motion: int


class MotionFinished(MotionEvent, frozen=True, kw_only=True, tag="finished"):
    """It ended (`end` is the value of a `MotionEnd`); `reason` if it failed, not `at_rest` if it could not be stopped.

    `progress` is the share of its way that it made; `contact` and `data` are as in `MotionReport`.
    """

    end: str
    progress: float
    reason: str = ""
    contact: bool = False
    data: bytes = b""
    at_rest: bool = True


class MotionHeld(MotionEvent, frozen=True, kw_only=True, tag="held"):
    """It stands still on its path; `request` is the number of the newest hold or resume that led to it."""

    request: int = 0


class MotionResumed(MotionEvent, frozen=True, kw_only=True, tag="resumed"):
    """It is moving along its path again; `request` is the number of the newest hold or resume that led to it."""

    request: int = 0


class ReflexTripped(MotionEvent, frozen=True, kw_only=True, tag="reflex"):
    """The arm has stopped by itself, and why; the motion, if one was under way, is going to fail. 0 for none."""

    arm: str
    reason: str


AnyMotionEvent = MotionFinished | MotionHeld | MotionResumed | ReflexTripped
