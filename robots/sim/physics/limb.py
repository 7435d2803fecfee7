"""The geometry of a person's arm: two bones, a fixed shoulder, and an elbow that hangs down."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from robots.model.transform import cross
from robots.port import Array
from robots.scene.sim_scene import PersonBody

BODIES = ("upper_arm", "forearm", "hand")
"""The bodies of an arm, from the shoulder on: a person's are `<person>/upper_arm` and so on."""

_DOWN = np.array([0.0, 0.0, -1.0])
_SMALL = 1e-9
# Rate at which an elbow returns to its hanging position: nearly as fast as it would fall, and smoothly.
_SINKING_RAD_S = 3.0
_SINKING_S = 0.15
_SETTLED_RAD = 1e-6


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
        self._shoulder = np.array(person.shoulder)
        self._upper_m, self._fore_m = person.upper_arm_m, person.forearm_m
        self._least_m, self._greatest_m = person.reach_m

    def away_m(self, hand: Array) -> float:
        """Return the distance of a hand position (3,) from the shoulder."""
        return math.dist(hand.tolist(), self._shoulder.tolist())

    def hanging(self, hand: Array) -> Array:
        """Return the side, (3,), on which the elbow hangs."""
        axis, _ = self._axis(hand)
        down = _across(_DOWN, axis)
        return down if down is not None else _any_across(axis)

    def carried_on(self, side: Array, hand: Array, *, step_s: float) -> Array:
        """Return the side after a step in which the hand moved to `hand`, from the previous side."""
        axis, _ = self._axis(hand)
        turned = _across(side, axis)
        if turned is None:
            return self.hanging(hand)
        down = _across(_DOWN, axis)
        if down is None:
            return turned
        normal = cross(axis, turned)
        angle = math.atan2(float(normal @ down), float(turned @ down))
        if abs(angle) < _SETTLED_RAD:
            return down
        # Near the vertical the lower side is ill-defined, and nothing pulls the elbow to it.
        fastest = _SINKING_RAD_S * math.hypot(float(axis[0]), float(axis[1])) * step_s
        turn = math.copysign(min(abs(angle) * min(1.0, step_s / _SINKING_S), fastest), angle)
        return turned * math.cos(turn) + normal * math.sin(turn)

    def pose(self, hand: Array, side: Array) -> LimbPose:
        """Return the poses of the bodies with the hand at, or nearest to, `hand` and the elbow towards `side`."""
        axis, length = self._axis(hand)
        along = (self._upper_m**2 - self._fore_m**2 + length**2) / (2.0 * length)
        out = math.sqrt(max(self._upper_m**2 - along**2, 0.0))
        to_elbow = axis * along + side * out
        elbow, reached = self._shoulder + to_elbow, self._shoulder + axis * length
        hinge = cross(axis, side)
        upper = _wxyz(hinge, to_elbow / self._upper_m)
        fore = _wxyz(hinge, (reached - elbow) / self._fore_m)
        xyz = np.array([self._shoulder + to_elbow / 2.0, (elbow + reached) / 2.0, reached])
        return LimbPose(xyz=xyz, wxyz=np.array([upper, fore, fore]))

    def _axis(self, hand: Array) -> tuple[Array, float]:
        """Return the direction from the shoulder to the hand, and the hand's distance."""
        offset = hand - self._shoulder
        length = self.away_m(hand)
        if length < _SMALL:
            return np.array([1.0, 0.0, 0.0]), self._least_m
        return offset / length, min(max(length, self._least_m), self._greatest_m)


def _across(vector: Array, axis: Array) -> Array | None:
    """Return the unit vector along the component of `vector` perpendicular to `axis`; None if there is none."""
    part = vector - axis * float(vector @ axis)
    length = math.hypot(*part.tolist())
    return part / length if length > 1e-6 else None


def _any_across(axis: Array) -> Array:
    across = _across(np.array([1.0, 0.0, 0.0]) if abs(axis[0]) < 0.9 else np.array([0.0, 1.0, 0.0]), axis)
    assert across is not None
    return across


def _wxyz(y: Array, z: Array) -> tuple[float, float, float, float]:
    """Return the quaternion, w first, of the frame with these orthonormal y and z axes."""
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = cross(y, z).tolist(), y.tolist(), z.tolist()
    squares = (1.0 + m00 + m11 + m22, 1.0 + m00 - m11 - m22, 1.0 - m00 + m11 - m22, 1.0 - m00 - m11 + m22)
    # From the largest component, to avoid division by a small number.
    largest = max(range(4), key=lambda i: squares[i])
    double = 2.0 * math.sqrt(squares[largest])
    match largest:
        case 0:
            raw = (double / 4.0, (m21 - m12) / double, (m02 - m20) / double, (m10 - m01) / double)
        case 1:
            raw = ((m21 - m12) / double, double / 4.0, (m01 + m10) / double, (m02 + m20) / double)
        case 2:
            raw = ((m02 - m20) / double, (m01 + m10) / double, double / 4.0, (m12 + m21) / double)
        case _:
            raw = ((m10 - m01) / double, (m02 + m20) / double, (m12 + m21) / double, double / 4.0)
    length = math.hypot(*raw)
    w, x, y_, z_ = (value / length for value in raw)
    return w, x, y_, z_
