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


class PersonReaching(Message, frozen=True, kw_only=True):
    """Whose hand is on its way, where to and how long it takes to get there."""

    person: str
    hand_m: Vector3
    arrives_in_s: float


class Reach(Service[PersonReaching], frozen=True, kw_only=True):
    """Let the hand of a person move to `hand_m` (world) on a straight line, from now on; replaces what it did.

    It starts and ends at rest and is nowhere faster than `speed_m_s`. With `stay_s` it goes back to where the
    person rests after that time, else it stays. A hand that cannot be reached by the arm's length is refused.
    """

    person: str
    hand_m: Vector3
    speed_m_s: HandSpeed = 0.8
    stay_s: Annotated[float, msgspec.Meta(ge=0.0, le=3600.0)] | None = None


class Withdraw(Service[PersonReaching], frozen=True, kw_only=True):
    """Let the hand of a person go back to where it rests."""

    person: str
    speed_m_s: HandSpeed = 0.8


class ContactCount(Message, frozen=True, kw_only=True):
    """How often two groups of bodies began to touch since the world was opened, how long they did, how hard at most.

    `pairs` are the names of those that touched.
    """

    contacts: int
    touching_s: float
    greatest_force_n: float
    pairs: tuple[tuple[str, str], ...]


class CountContacts(Service[ContactCount], frozen=True, kw_only=True):
    """Return the physics' own count of contacts between a person and everything that is no person."""

    person: str
