"""Skills of a simulated world, answered under `cell`; a real cell does not have them."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Vector3
from engine.skill import Service


class ResetPartsResult(Message, frozen=True, kw_only=True):
    """The parts that were put back."""

    parts: tuple[str, ...]


class ResetParts(Service[ResetPartsResult], frozen=True, kw_only=True):
    """Put all parts back where they lay at the start, for the next trial.

    Refused while a run holds a robot or anything moves: no behavior can move parts by it.
    """


class PushBodyResult(Message, frozen=True, kw_only=True):
    """The body that is pushed at from now on."""

    body: str


class PushBody(Service[PushBodyResult], frozen=True, kw_only=True):
    """Push at a body for a while, as a hand would: along the world's axes, at a point of the body's own frame.

    `body` is `<arm>/<link>` or the name of a part. It replaces the last push at that body. Anybody may:
    what a robot does about it is the robot's business.
    """

    body: str
    force_n: Vector3
    duration_s: Annotated[float, msgspec.Meta(gt=0.0, le=60.0)]
    at_m: Vector3 = (0.0, 0.0, 0.0)
