"""Checks pairs of shapes that must not touch with Coal's broad phase; keeps Pinocchio's objects alive together."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from robots.planning.scene.coal_shapes import pin
from robots.planning.scene.planning_scene import NamePair
from robots.port import Array

TOUCHING_M = 1e-5
"""Nearer than this counts as touching. Coal's test without contacts ends at its tolerance and then reports cylinders
that overlap by millimeters as free; a margin above that tolerance avoids this."""


class PairChecks:
    """The pairs of a geometry model. It holds the interpreter lock while it works and serves one thread at a time.

    Args:
        solver: Pinocchio's model of the arm.
        geometry: Pinocchio's geometry model, which gets these pairs and must not change afterwards.
        names: The name of each shape.
        pairs: The shapes that must not touch, by index, the lower one first.
        margins_m: Margin of each pair.
    """

    def __init__(
        self,
        solver: Any,
        geometry: Any,
        names: Sequence[str],
        pairs: Sequence[tuple[int, int]],
        margins_m: Sequence[float],
    ) -> None:
        # Pinocchio's managers keep none of these alive: this object does.
        self._solver, self._geometry = solver, geometry
        # Pinocchio searches all pairs for duplicates when one is added: set thousands at once, in this order.
        order = sorted(range(len(pairs)), key=lambda k: pairs[k])
        enabled = np.zeros((geometry.ngeoms, geometry.ngeoms), dtype=np.bool_)
        margins = np.zeros((geometry.ngeoms, geometry.ngeoms))
        for k in order:
            enabled[pairs[k]], margins[pairs[k]] = True, max(margins_m[k], TOUCHING_M)
        geometry.setCollisionPairs(enabled)
        self._data, self._geometry_data = solver.createData(), geometry.createData()
        self._geometry_data.setSecurityMargins(geometry, margins)
        self._margins_m = [max(margins_m[k], TOUCHING_M) for k in order]
        self.pairs: tuple[NamePair, ...] = tuple((names[pairs[k][0]], names[pairs[k][1]]) for k in order)
        self._manager = pin.BroadPhaseManager_DynamicAABBTreeCollisionManager(solver, geometry, self._geometry_data)

    def in_collision(self, joints: Array) -> bool:
        """Return whether any pair touches at `joints` (n,)."""
        return bool(pin.computeCollisions(self._solver, self._data, self._manager, joints, True))

    def colliding_pairs(self, joints: Array) -> tuple[NamePair, ...]:
        """Return the names of all pairs that touch at `joints` (n,), each once."""
        pin.computeCollisions(self._solver, self._data, self._geometry, self._geometry_data, joints, False)
        results = self._geometry_data.collisionResults
        return tuple(
            dict.fromkeys(pair for pair, result in zip(self.pairs, results, strict=True) if result.isCollision())
        )

    def distances(self, joints: Array) -> Array:
        """Return the distance of each pair at `joints` (n,), 0 or less if it touches."""
        pin.computeDistances(self._solver, self._data, self._geometry, self._geometry_data, joints)
        return np.array([result.min_distance for result in self._geometry_data.distanceResults], dtype=np.float64)

    def too_near(self, joints: Array) -> dict[int, float]:
        """Return the pairs, by index, that are within their margin at `joints` (n,), and their distances."""
        distances = self.distances(joints)
        return {int(k): float(distances[k]) for k in np.flatnonzero(distances < np.array(self._margins_m))}

    @contextmanager
    def nearer(self, allowed_m: Mapping[int, float]) -> Generator[None]:
        """Temporarily reduce the margins of some pairs, by index."""
        requests = self._geometry_data.collisionRequests
        for index, margin in allowed_m.items():
            requests[index].security_margin = max(margin, TOUCHING_M)
        try:
            yield
        finally:
            for index in allowed_m:
                requests[index].security_margin = self._margins_m[index]
