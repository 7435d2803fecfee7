"""Where the base of an arm stands: one fact, which all that compute with this arm share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.model.transform import RigidTransform
from robots.port import Array


@dataclass(frozen=True, eq=False)
class _Stand:
    pose: RigidTransform
    rotation: Array
    turn: Array


class ArmBase:
    """The pose of an arm's base link in the world; it changes where the arm stands on something that moves.

    Readers on other threads see the pose before or after a change, never a mixture.
    """

    def __init__(self, pose: RigidTransform) -> None:
        self._stand = _new_stand(pose)

    @classmethod
    def of(cls, base: RigidTransform | ArmBase) -> ArmBase:
        """Return `base` itself, or a new one for a pose."""
        return base if isinstance(base, ArmBase) else cls(base)

    @property
    def pose(self) -> RigidTransform:
        """The pose in the world now."""
        return self._stand.pose

    @property
    def rotation(self) -> Array:
        """Its rotation, (3, 3)."""
        return self._stand.rotation

    @property
    def turn(self) -> Array:
        """Turns a velocity, m/s then rad/s, from the axes of the base to those of the world, (6, 6)."""
        return self._stand.turn

    def stand_at(self, pose: RigidTransform) -> None:
        """Stand at another pose in the world from now on."""
        self._stand = _new_stand(pose)


def _new_stand(pose: RigidTransform) -> _Stand:
    rotation = pose.rotation
    return _Stand(pose, rotation, np.kron(np.eye(2), rotation).astype(np.float64))
