"""Simulated people of a cell, served under `cell`: a hand that reaches into the workspace of the robots.

A real cell does not have these skills.
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
    """The person whose hand moves, the goal of the hand, and the time until it arrives."""

    person: str
    hand_m: Vector3
    arrives_in_s: float


class Reach(Service[ReachResult], frozen=True, kw_only=True):
    """Move the hand of a person to `hand_m` (world) on a straight line; replaces its present motion.

    The hand ends at rest and does not exceed `speed_m_s`; a moving hand changes its direction smoothly, and may
    exceed that speed only while it decelerates. With `stay_s` it returns to its rest position after that time,
    else it stays. Refused for a position out of reach and for a path through the person's own shoulder.
    """

    person: str
    hand_m: Vector3
    speed_m_s: HandSpeed = 0.8
    stay_s: StayTime | None = None


class Withdraw(Service[ReachResult], frozen=True, kw_only=True):
    """Move the hand of a person back to its rest position."""

    person: str
    speed_m_s: HandSpeed = 0.8


class ContactCount(Message, frozen=True, kw_only=True):
    """The contacts between two groups of bodies since the world was opened: number, duration, greatest force.

    Each pair of bodies counts separately; a contact begins when two bodies touch that did not touch one physics
    step before. The force is that of a pair, summed over its contact points. `pairs` are the names of the touching
    bodies. A resumed run continues to count.
    """

    contacts: int
    touching_s: float
    greatest_force_n: float
    pairs: tuple[tuple[str, str], ...]


class CountContacts(Service[ContactCount], frozen=True, kw_only=True):
    """Return the contacts, counted by the physics engine, between a person and all bodies that are not persons."""

    person: str
