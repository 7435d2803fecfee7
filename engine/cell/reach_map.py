"""Where the tool centre point of an arm gets in its cell, as a cloud of points on a grid."""

from __future__ import annotations

from typing import Literal

import msgspec

from engine.messages import Vector3

ReachDirection = Literal["any", "down"]
"""Which directions of the tool's z axis count: those of a sphere, or downwards only."""


class ReachPoint(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """A point of the world that the tool centre point reaches.

    `share` is that of the directions of the tool in which it does, from 0 to 1, `manipulability` the best product of
    singular values of the Jacobian there (Yoshikawa).
    """

    xyz: Vector3
    share: float
    manipulability: float


class ReachLevel(msgspec.Struct, frozen=True, kw_only=True):
    """The points of one fineness: the first is coarse, and each has the points of those before it.

    `searched` is the number of points of its grid, `left` that of the levels that follow.
    """

    step_m: float
    directions: int
    searched: int
    left: int
    points: tuple[ReachPoint, ...]

    @property
    def volume_m3(self) -> float:
        """The volume of the cells of the grid whose points are reached."""
        return len(self.points) * self.step_m**3
