"""The report on people in a snapshot of a world."""

from __future__ import annotations

from dataclasses import dataclass

from engine.skills.people import ContactCount
from robots.port import Array
from robots.sim.people.contact_counter import count_size, read_contact_count
from robots.sim.people.hand_trajectory import HandMotion
from robots.sim.physics.limb import BODIES

# Position and velocity of the hand, and its remaining motion time.
_HAND_FIELDS = 7


@dataclass(frozen=True, kw_only=True)
class PersonSample:
    """One person at an instant."""

    hand: HandMotion
    arrives_in_s: float
    count: ContactCount


def report_size(people: int, *, body_count: int) -> int:
    """Return the length of the report on the people of a world."""
    return people * (_HAND_FIELDS + count_size(body_count, len(BODIES)))


def person_sample(values: Array, people: tuple[str, ...], person: str, *, bodies: tuple[str, ...]) -> PersonSample:
    """Return the sample of one person from the report on `people`; `bodies` are all names of the world."""
    row = values.reshape(len(people), -1)[people.index(person)]
    own = tuple(f"{person}/{body}" for body in BODIES)
    return PersonSample(
        hand=HandMotion(xyz=row[0:3].copy(), velocity=row[3:6].copy()),
        arrives_in_s=float(row[6]),
        count=read_contact_count(row[_HAND_FIELDS:], own=own, bodies=bodies),
    )
