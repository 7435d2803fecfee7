"""The geometry of a person's arm: two bones, a fixed shoulder, and an elbow that hangs down."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from robots.port import Array
from robots.scene.sim_scene import PersonBody

BODIES = ("upper_arm", "forearm", "hand")
"""The bodies of an arm, from the shoulder on: a person's are `<person>/upper_arm` and so on."""


@dataclass(frozen=True, kw_only=True)
class LimbPose:
    """Poses of the bodies of an arm, world: `xyz` (3, 3) and `wxyz` (3, 4), rows as in `BODIES`.

    A body's origin is its centre; the z axis of a bone points from the shoulder towards the hand.
    """

    xyz: Array
    wxyz: Array


class Limb:
    """The lengths of one arm, and the poses of its bodies for a hand position.

    `side` is the unit vector, perpendicular to the line from shoulder to hand, towards the elbow: it
    turns with the arm and returns, at the rate of a sinking elbow, to the hanging position. So nothing jumps
    where the hand passes over the shoulder and both sides are equally low.
    """

    def __init__(self, person: PersonBody) -> None:
        # Imported here: it loads numba, and most cells have no people.
        from robots.sim.physics import limb_kernels

        self._hang, self._carry_on, self._place = limb_kernels.hang, limb_kernels.carry_on, limb_kernels.place
        self._shoulder = np.array(person.shoulder, dtype=np.float64)
        self._lengths = np.array((person.upper_arm_m, person.forearm_m, *person.reach_m), dtype=np.float64)

    def away_m(self, hand: Array) -> float:
        """Return the distance of a hand position (3,) from the shoulder."""
        return math.dist(hand.tolist(), self._shoulder.tolist())

    def hanging(self, hand: Array) -> Array:
        """Return the side, (3,), on which the elbow hangs."""
        side = np.empty(3)
        self._hang(self._shoulder, self._lengths, hand, side)
        return side

    def carried_on(self, side: Array, hand: Array, *, step_s: float) -> Array:
        """Return the side after a step in which the hand moved to `hand`, from the previous side."""
        turned = np.array(side)
        self._carry_on(self._shoulder, self._lengths, hand, step_s, turned)
        return turned

    def pose(self, hand: Array, side: Array) -> LimbPose:
        """Return the poses of the bodies with the hand at, or nearest to, `hand` and the elbow towards `side`."""
        pose = LimbPose(xyz=np.empty((3, 3)), wxyz=np.empty((3, 4)))
        self._place(self._shoulder, self._lengths, hand, side, pose.xyz, pose.wxyz)
        return pose
