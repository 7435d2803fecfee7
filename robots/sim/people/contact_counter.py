"""Counts the contacts of people's bodies in the physics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.skills.people import ContactCount
from robots.port import Array
from robots.sim.physics.person_spec import PersonIndices
from robots.sim.physics.physics import Physics

_CONTACTS, _TOUCHING_S, _GREATEST_N, _PAIRS = 0, 1, 2, 3
_BEFORE, _NOW = 1.0, 2.0


def count_size(body_count: int, own: int) -> int:
    """Return the length of the statistics of a person with `own` bodies in a world of `body_count`."""
    return _PAIRS + own * body_count


def read_contact_count(numbers: Array, *, own: tuple[str, ...], bodies: tuple[str, ...]) -> ContactCount:
    """Decode the numbers of a count; `own` are the names of the person's bodies, `bodies` those of the world."""
    rows, columns = np.nonzero(numbers[_PAIRS:].reshape(-1, len(bodies)))
    return ContactCount(
        contacts=int(numbers[_CONTACTS]),
        touching_s=float(numbers[_TOUCHING_S]),
        greatest_force_n=float(numbers[_GREATEST_N]),
        pairs=tuple((own[row], bodies[column]) for row, column in zip(rows.tolist(), columns.tolist(), strict=True)),
    )


class ContactCounter:
    """The contact statistics of all people; `numbers` has one row per person, (people, `count_size`).

    A contact begins when two bodies touch that did not in the step before. The force of a pair is the sum of
    the normal forces of its contact points. Contacts with the bodies in `fixed` do not count.
    """

    def __init__(
        self, people: tuple[PersonIndices, ...], physics: Physics, *, body_count: int, fixed: frozenset[int]
    ) -> None:
        self._physics = physics
        own = len(people[0].bodies)
        self.numbers = np.zeros((len(people), count_size(body_count, own)))
        self._pairs = self.numbers[:, _PAIRS:].reshape(len(people), own, body_count)
        rows = {body: (i, j) for i, person in enumerate(people) for j, body in enumerate(person.bodies)}
        self._geom_body = physics.geom_body
        self._rows = rows
        self._touching = False
        is_person: NDArray[np.bool_] = np.array([body in rows for body in physics.geom_body], dtype=np.bool_)
        is_fixed: NDArray[np.bool_] = np.array([body in fixed for body in physics.geom_body], dtype=np.bool_)
        self._counted = (is_person[:, None] | is_person[None, :]) & ~(is_fixed[:, None] | is_fixed[None, :])
        """Whether a contact of these two geometries counts, (n, n)."""

    def step(self, step_s: float) -> None:
        """Count the contacts of the step just done."""
        now: dict[tuple[int, int, int], float] = {}
        geoms = self._physics.contact_geoms()
        for index in self._counted[geoms[:, 0], geoms[:, 1]].nonzero()[0].tolist():
            if self._physics.contact_depth_m(index) < 0.0:
                continue
            pair = self._pair(geoms[index].tolist())
            now[pair] = now.get(pair, 0.0) + self._physics.normal_force_n(index)
        if now:
            self._count(now, step_s)
        elif self._touching:
            self._pairs[self._pairs == _NOW] = _BEFORE
            self._touching = False

    def take_over(self, numbers: Array) -> None:
        """Continue from stored `numbers`."""
        self.numbers[:] = numbers
        self._touching = bool((self._pairs == _NOW).any())

    def _pair(self, geoms: list[int]) -> tuple[int, int, int]:
        first, second = (self._geom_body[geom] for geom in geoms)
        own, other = (first, second) if first in self._rows else (second, first)
        return (*self._rows[own], other)

    def _count(self, now: dict[tuple[int, int, int], float], step_s: float) -> None:
        was_touching = self._pairs == _NOW
        self._pairs[was_touching] = _BEFORE
        for (person, own, other), force_n in now.items():
            numbers = self.numbers[person]
            numbers[_CONTACTS] += not was_touching[person, own, other]
            numbers[_GREATEST_N] = max(float(numbers[_GREATEST_N]), force_n)
            self._pairs[person, own, other] = _NOW
        self.numbers[sorted({person for person, _, _ in now}), _TOUCHING_S] += step_s
        self._touching = True
