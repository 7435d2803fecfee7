"""Contacts in a run that are neither a grasp nor a resting place: how many, how long, and how hard."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.port import Array
from robots.sim.measures.things import Things
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics

_CONTACTS, _CONTACT_S, _FORCE_N = range(3)
# Two bodies that touch again within this time are still in the same contact: stiff bodies bounce.
_APART_S = 0.05

_NONE = np.zeros(0, dtype=np.intp)


@dataclass(kw_only=True)
class _Contact:
    """Two things that touch."""

    handler: tuple[str, int] | None
    """The arm whose tool touches a part here, and the body of the part."""
    last: int = -1
    """The last step in which they were seen to touch."""
    steps: int = 0
    force_n: float = 0.0
    grasp: bool = False


class ContactMeasures:
    """Looks at the contacts of some steps.

    A contact is between an arm with its tool and anything else: a part, a fixture, a person, another arm. Parts on
    fixtures and on parts rest there. A tool that touches a part while its fingers move, or its field changes, takes or
    releases it: from their first touch until they separate this is a grasp. Another touch of a part is a contact.
    A part that a tool touches when the world jumps to another state is held in it.

    Args:
        values: Where the measures are kept, in the order of `MeasureLayout`.
        cell: The world.
        physics: Its physics.
        beyond_flange: The bodies of each arm's tool.
        moving: Returns whether the tool of an arm, or the lock of its tool changer, moves, by arm; an arm with a bare
            flange is missing.
        step_s: Duration of a step.
    """

    def __init__(
        self,
        values: Array,
        *,
        cell: CellModel,
        physics: Physics,
        beyond_flange: Mapping[str, frozenset[int]],
        moving: Mapping[str, Callable[[], bool]],
        step_s: float,
    ) -> None:
        self._values = values
        self._physics = physics
        self._step_s = step_s
        self._apart = round(_APART_S / step_s)
        self._things = Things(cell, beyond_flange)
        things = [self._things.of_body[body] for body in physics.geom_body]
        self._pairs = self._things.pairs()[np.ix_(things, things)]
        self._moving = moving
        self._open: dict[int, _Contact] = {}
        self._looked = 0
        self._jumped = False
        self.pressing = False
        """Whether something was touched in the last step that was looked at that is no grasp."""
        self.touched = False
        """Whether something began to be touched in that step."""
        self.handled: frozenset[str] = frozenset()
        """The arms whose tools touched a part in the last step that was looked at."""
        self.grasps: frozenset[tuple[str, int]] = frozenset()
        """Each arm and the part that its tool takes, holds or releases, by its body."""

    def look(self, step: int) -> None:
        """Look at the contacts of the step just done, which has this number."""
        geoms = self._physics.contact_geoms()
        pairs = self._pairs[geoms[:, 0], geoms[:, 1]] if len(geoms) else _NONE
        self.pressing = self.touched = False
        handled: list[str] = []
        for pair in sorted(set(pairs.tolist())):
            if pair:
                self._take(step, pair, pairs, handled)
        self.handled = frozenset(handled)
        if self._open:
            self._close(step)
        grasps = [contact.handler for contact in self._open.values() if contact.grasp and contact.handler is not None]
        self.grasps = frozenset(grasps)
        self._looked, self._jumped = step, False

    def totals(self) -> tuple[float, float, float]:
        """Return number, duration and largest force, those of contacts that still last included."""
        lasting = [contact for contact in self._open.values() if not contact.grasp]
        return (
            self._values[_CONTACTS] + len(lasting),
            self._values[_CONTACT_S] + sum(contact.steps for contact in lasting) * self._step_s,
            max(self._values[_FORCE_N], *(contact.force_n for contact in lasting), 0.0),
        )

    def restart(self, step: int) -> None:
        """Begin again after the world has jumped to another state."""
        self._open.clear()
        self._jumped = True
        self._looked, self.pressing, self.touched = step, False, False
        self.handled, self.grasps = frozenset(), frozenset()

    def _take(self, step: int, pair: int, pairs: NDArray[np.intp], handled: list[str]) -> None:
        contact = self._open.get(pair)
        if contact is None:
            contact = self._open[pair] = _Contact(handler=self._things.handler(pair))
        contact.steps += step - self._looked if contact.last == self._looked else 1
        contact.last = step
        if contact.handler is not None:
            arm, _ = contact.handler
            handled.append(arm)
            contact.grasp = contact.grasp or self._jumped or self._moving.get(arm, _is_never_moving)()
        if not contact.grasp:
            self.pressing = True
            self.touched |= contact.steps == 1
            points = (pairs == pair).nonzero()[0].tolist()
            contact.force_n = max(contact.force_n, sum(map(self._physics.normal_force_n, points)))

    def _close(self, step: int) -> None:
        for pair in [pair for pair, contact in self._open.items() if step - contact.last > self._apart]:
            contact = self._open.pop(pair)
            if contact.grasp:
                continue
            self._values[_CONTACTS] += 1
            self._values[_CONTACT_S] += contact.steps * self._step_s
            self._values[_FORCE_N] = max(self._values[_FORCE_N], contact.force_n)


def _is_never_moving() -> bool:
    return False
