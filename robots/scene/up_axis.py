"""The axis of a part that points up as the cell document places it."""

from __future__ import annotations

from engine.messages import Vector3
from engine.messages.pose_algebra import invert_pose, rotate_vector
from robots.scene.sim_scene import PartBody

_ROUND = {"sphere": (), "cylinder": (2,)}
"""Axes that tell up from down, by shape; a box has all three."""


def up_axis(part: PartBody) -> Vector3 | None:
    """Return the axis of the part's frame nearest to the world's z axis; None if turning does not change what is up.

    That is so for a sphere, and for a cylinder that lies.
    """
    up = rotate_vector(invert_pose(part.pose).xyzw, (0.0, 0.0, 1.0))
    nearest = max(range(3), key=lambda axis: abs(up[axis]))
    if nearest not in _ROUND.get(part.shape, (0, 1, 2)):
        return None
    x, y, z = (float(axis == nearest) * (1.0 if up[axis] > 0 else -1.0) for axis in range(3))
    return (x, y, z)
