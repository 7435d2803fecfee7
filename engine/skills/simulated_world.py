"""Skills of a simulated world, served under `cell`; a real cell does not have them."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Vector3
from engine.skill import Service

LONGEST_PUSH_S = 60.0


class ResetPartsResult(Message, frozen=True, kw_only=True):
    """The parts that were reset."""

    parts: tuple[str, ...]


class ResetParts(Service[ResetPartsResult], frozen=True, kw_only=True):
    """Reset all parts to their initial poses, for the next trial.

    Refused while a run holds a robot or anything moves, so that no behavior can move parts by it.
    """


class PushBodyResult(Message, frozen=True, kw_only=True):
    """The pushed body."""

    body: str


class PushBody(Service[PushBodyResult], frozen=True, kw_only=True):
    """Apply a force to a body for a time, as a hand would: along the world's axes, at a point of the body's frame.

    `body` is `<arm>/<link>` or the name of a part. It replaces the last push at that body. Needs no lease:
    a robot reacts to it as to any external force.
    """

    body: str
    force_n: Vector3
    duration_s: Annotated[float, msgspec.Meta(gt=0.0, le=LONGEST_PUSH_S)]
    at_m: Vector3 = (0.0, 0.0, 0.0)
