"""The things of a world whose contacts are told apart: an arm, its tool, a person, each part and each fixture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from robots.sim.physics.cell_model import CellModel


class Things:
    """Numbers the things of a world.

    Args:
        cell: The world.
        tools: The bodies of the tool of each arm; an arm without a tool may be missing.
    """

    def __init__(self, cell: CellModel, tools: Mapping[str, frozenset[int]]) -> None:
        self.of_body = list(range(len(cell.body_names)))
        """The thing that each body belongs to: bodies of one thing have the number of one of them."""
        self._arms: set[int] = set()
        self._tools: dict[int, str] = {}
        self._parts = {number for number, name in enumerate(cell.body_names) if name in frozenset(cell.parts)}
        for arm in cell.arms:
            tool = tools.get(arm.name, frozenset()) & arm.bodies
            self._arms.add(self._join(arm.bodies - tool))
            if tool:
                self._tools[self._join(tool)] = arm.name
        for person in cell.people:
            self._join(frozenset(person.bodies))

    def pairs(self) -> NDArray[np.intp]:
        """Return a number for each pair of things of which one is an arm or a tool, else 0, (bodies, bodies).

        It is the same in both orders; `handler` knows what it stands for.
        """
        count = len(self.of_body)
        robots = np.zeros(count, dtype=np.bool_)
        robots[[*self._arms, *self._tools]] = True
        numbers = np.arange(count)
        codes = np.minimum(numbers[:, None], numbers) * count + np.maximum(numbers[:, None], numbers)
        return np.where((robots[:, None] | robots) & (numbers[:, None] != numbers), codes, 0)

    def handler(self, pair: int) -> tuple[str, int] | None:
        """Return the arm whose tool touches a part, and the body of the part, if that is what a pair of things is."""
        first, second = divmod(pair, len(self.of_body))
        tool, part = (first, second) if second in self._parts else (second, first)
        return (self._tools[tool], part) if part in self._parts and tool in self._tools else None

    def _join(self, bodies: frozenset[int]) -> int:
        thing = min(bodies)
        for body in bodies:
            self.of_body[body] = thing
        return thing
