"""The part of a goal pose that the tool must match: pose, position only, or position and tool axis."""

from __future__ import annotations

from enum import Enum


class PoseMatch(Enum):
    """The part of a goal pose to match; the values are those of `robots.model.inverse_kinematics.kernels`."""

    POSE = 0
    """Position and orientation: six conditions, so the arm needs six joints."""

    POSITION = 1
    """The position; the orientation is free. For arms of two or three joints.

    With two joints the tool moves on a surface; a position within a millimetre of it is matched by the nearest point.
    """

    AXIS = 2
    """Position and direction of the tool's z axis; the rotation about it is free. For axially symmetric tools."""

    @classmethod
    def of(cls, word: str) -> PoseMatch:
        """Return the match of a name in skills and behaviors: `pose`, `position` or `axis`."""
        return cls[word.upper()]
