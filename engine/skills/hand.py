"""Skills of a hand that closes with one motor, served under `<arm>/hand` (RCY 7.3)."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec
from msgspec import UNSET, UnsetType

from engine.messages import HandState, HoldEvidence, Message
from engine.skill import Action, Capability, Service

Percent = Annotated[float, msgspec.Meta(ge=0.0, le=100.0, description="Closing position: 0 open, 100 closed")]
ClosingTime = Annotated[float, msgspec.Meta(gt=0.0, description="Duration of the motion in seconds")]


class HandFeedback(Message, frozen=True, kw_only=True):
    """The closing position during the motion."""

    closed_percent: float


class HandResult(Message, frozen=True, kw_only=True):
    """Whether the hand holds a part, judged from the contacts of thumb, fingers and palm.

    `part` is the name of the held part, `?` when unknown, and `by` what tells it; `reason` is why nothing is
    held, and is empty when `held`.
    """

    held: bool
    closed_percent: float
    force_n: float
    part: str = ""
    reason: str = ""
    by: HoldEvidence | UnsetType = UNSET


class HandClose(Action[HandResult, HandFeedback], frozen=True, kw_only=True):
    """Close to `percent` in `time_s`, or as fast as the motor can.

    A finger stops at a contact while the others continue. Succeeds as an action whether or not
    a part is held, see `HandResult.held`.
    """

    capability: ClassVar[Capability] = "hand"

    percent: Percent
    time_s: ClosingTime = 1.0


class HandOpen(Action[HandResult, HandFeedback], frozen=True, kw_only=True):
    """Open fully in `time_s`, or as fast as the motor can."""

    capability: ClassVar[Capability] = "hand"

    time_s: ClosingTime = 1.0


class ReadHand(Service[HandState], frozen=True, kw_only=True):
    """Return the measured state of the hand."""

    capability: ClassVar[Capability] = "hand"
