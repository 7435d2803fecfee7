"""How near two things come that may be meant to meet: an approach that ends in a grasp is none that counts."""

from __future__ import annotations

import math

APART_M = 0.01
"""Two things have passed each other when they are so much farther apart than at their nearest."""


class PassingDistance:
    """Follows the distance of a tool and a part, or of a held part and another thing.

    It decreases to nothing before a grasp, and increases from nothing when a part is lifted: only a least distance
    between two larger ones is one at which they passed.
    """

    def __init__(self) -> None:
        self._farthest_m = -math.inf
        self.lasting_m = math.inf
        """The least distance of an approach that has not ended, infinite for none."""

    def restart(self) -> None:
        """Begin where they are now: what was approached has been reached."""
        self._farthest_m, self.lasting_m = -math.inf, math.inf

    def follow(self, distance_m: float) -> float:
        """Return the distance at which they have just passed each other, infinite for not now.

        Args:
            distance_m: Their present distance; of things that are far apart, a lower bound of it.
        """
        if self.lasting_m == math.inf:
            self._farthest_m = max(self._farthest_m, distance_m)
            if distance_m < self._farthest_m - APART_M:
                self.lasting_m = distance_m
            return math.inf
        self.lasting_m = min(self.lasting_m, distance_m)
        if distance_m < self.lasting_m + APART_M:
            return math.inf
        passed_m, self.lasting_m, self._farthest_m = self.lasting_m, math.inf, distance_m
        return passed_m
