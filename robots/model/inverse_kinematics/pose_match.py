"""What of a goal pose the tool must match: all of it, its position only, or its position and the tool's axis."""

from __future__ import annotations

from enum import Enum


class PoseMatch(Enum):
    """Which part of a goal pose counts; the values are those of `robots.model.inverse_kinematics.kernels`."""

    POSE = 0
    """Position and orientation: three and three conditions, so the arm needs six joints."""

    POSITION = 1
    """The position; the orientation comes as it comes. For arms of two or three joints.

    With two the tool moves on a surface, and a position within a millimetre of it is met by the nearest one on it.
    """

    AXIS = 2
    """Position and direction of the tool's z axis; the turn about it is free. For tools that are round."""

    @classmethod
    def of(cls, word: str) -> PoseMatch:
        """Return the match that skills and behaviors call `word`: `pose`, `position` or `axis`."""
        return cls[word.upper()]
