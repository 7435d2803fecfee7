"""Which geometries of a world must not touch, by pairs of things: arms with their tools, parts, fixtures, people."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.sim.measures.things import Things
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics


@dataclass(frozen=True, kw_only=True)
class ThingPair:
    """Two things that could touch, of which one is an arm or a part."""

    arms: tuple[str, ...]
    """Those of them that are arms."""
    parts: tuple[int, ...]
    """Those of them that are parts, by their bodies."""
    start: int
    """The first of the rows of their geometries in the table."""
    end: int
    """The row after the last one."""


class ClearancePairs:
    """The pairs of geometries that the physics lets touch, those of two things one after the other.

    Links of one arm, links that may overlap (the shoulder and what the arm stands on), and bodies that cannot move
    relative to each other are none.
    """

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        things = Things(cell, {})
        arms = {things.of_body[min(arm.bodies)]: arm.name for arm in cell.arms}
        parts = {body for body, name in enumerate(cell.body_names) if name in frozenset(cell.parts)}
        of_geom = np.array([things.of_body[body] for body in physics.geom_body], dtype=np.intp)
        pairs = physics.collidable_pairs()
        pairs = pairs[of_geom[pairs[:, 0]] != of_geom[pairs[:, 1]]]
        sides = np.sort(of_geom[pairs], axis=1)
        counted = np.array([*arms, *parts], dtype=np.intp)
        chosen = np.isin(sides, counted).any(axis=1)
        pairs, sides = pairs[chosen], sides[chosen]
        order = np.lexsort((sides[:, 1], sides[:, 0]))
        pairs, sides = pairs[order], sides[order]
        starts = (np.diff(sides, axis=0, prepend=-1) != 0).any(axis=1).nonzero()[0]
        ends = [*starts[1:].tolist(), len(pairs)][: len(starts)]
        self.first: NDArray[np.intp] = pairs[:, 0].copy()
        """The first geometry of each pair."""
        self.second: NDArray[np.intp] = pairs[:, 1].copy()
        self.starts: NDArray[np.intp] = starts
        """The first row of each pair of things."""
        self.things = tuple(
            ThingPair(
                arms=tuple(arms[side] for side in sides[start].tolist() if side in arms),
                parts=tuple(side for side in sides[start].tolist() if side in parts),
                start=start,
                end=end,
            )
            for start, end in zip(starts.tolist(), ends, strict=True)
        )
