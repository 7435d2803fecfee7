"""People of a simulated cell, answered under `cell`: an arm that reaches into the way of the robots.

A real cell does not have these; there, people come by themselves.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Vector3
from engine.skill import Service

HandSpeed = Annotated[
    float, msgspec.Meta(gt=0.0, le=3.0, description="Speed of the hand", extra_json_schema={"unit": "m/s"})
]

StayTime = Annotated[float, msgspec.Meta(ge=0.0, le=3600.0, extra_json_schema={"unit": "s"})]


class ReachResult(Message, frozen=True, kw_only=True):
    """Whose hand is on its way, where to and how long it takes to get there."""

    person: str
    hand_m: Vector3
    arrives_in_s: float


class Reach(Service[ReachResult], frozen=True, kw_only=True):
    """Let the hand of a person move to `hand_m` (world) on a straight line, from now on; replaces what it did.

    It ends at rest and is nowhere faster than `speed_m_s`; a hand that is on its way turns off it smoothly, and may
    be faster only until it has slowed down. With `stay_s` it goes back to where the person rests after that time,
    else it stays. A place that the arm does not reach is refused, and a way that leads through the own shoulder.
    """

    person: str
    hand_m: Vector3
    speed_m_s: HandSpeed = 0.8
    stay_s: StayTime | None = None


class Withdraw(Service[ReachResult], frozen=True, kw_only=True):
    """Let the hand of a person go back to where it rests."""

    person: str
    speed_m_s: HandSpeed = 0.8


class ContactCount(Message, frozen=True, kw_only=True):
    """How often bodies of two groups began to touch since the world was opened, how long any did, how hard at most.

    Each pair of bodies counts for itself; a contact begins when two touch that did not one step of the physics
    before. The force is that of a pair, over all its points. `pairs` are the names of those that touched. A run
    that is resumed goes on counting.
    """

    contacts: int
    touching_s: float
    greatest_force_n: float
    pairs: tuple[tuple[str, str], ...]


class CountContacts(Service[ContactCount], frozen=True, kw_only=True):
    """Return the physics' own count of contacts between a person and everything that is no person."""

    person: str
