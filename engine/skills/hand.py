"""Skills of a hand that closes with one motor, answered under `<arm>/hand` (RCY 7.3)."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import HandState, Message
from engine.skill import Action, Service

Percent = Annotated[float, msgspec.Meta(ge=0.0, le=100.0, description="How far to close: 0 open, 100 closed")]
ClosingTime = Annotated[float, msgspec.Meta(gt=0.0, description="Time for the way in seconds")]


class HandFeedback(Message, frozen=True, kw_only=True):
    """How far the motor has closed the hand on the way."""

    closed_percent: float


class HandResult(Message, frozen=True, kw_only=True):
    """What the hand holds, judged from what thumb, fingers and palm touch.

    `part` is what is held, `?` where the hand cannot tell; `reason` says in words why nothing is, and
    is empty when `held`.
    """

    held: bool
    closed_percent: float
    force_n: float
    part: str = ""
    reason: str = ""


class HandClose(Action[HandResult, HandFeedback], frozen=True, kw_only=True):
    """Close to `percent` in `time_s`, or as fast as the motor can.

    Fingers that meet something stop and the others go on. Succeeds as an action whether or not
    something is held; `HandResult.held` tells.
    """

    percent: Percent
    time_s: ClosingTime = 1.0


class HandOpen(Action[HandResult, HandFeedback], frozen=True, kw_only=True):
    """Open fully in `time_s`, or as fast as the motor can."""

    time_s: ClosingTime = 1.0


class ReadHand(Service[HandState], frozen=True, kw_only=True):
    """Return the measured state of the hand now."""
