"""Admittance: force errors deviate the tool, M ẍ + D ẋ + K x = F − F_wanted (RCL 4.3.7).

Towards a surface that is not felt, the damping is that with which the wanted force moves the tool at `touch_m_s`; from
half of the wanted force on it is D. Variable damping is that of Ikeura and Inooka (ICRA 1995) and of Duchaine and
Gosselin (World Haptics 2007); the peak of an impact grows with the speed alone (see `robots/motion/touch_speed.py`).
"""

from __future__ import annotations

import math

import numpy as np

from engine.skills.dmp import Compliance
from robots.port import Array

# While the loop only yields, forces up to this much above the target ones are tolerated.
_BORNE = (1.0, 1.0, 1.0, 0.1, 0.1, 0.1)
_AXES = 6
# From this share of the wanted force on, the tool presses on something.
_PRESSING_SHARE = 0.5
# The offset approaches its reach with this time constant, so that the tool stops there without passing it.
_APPROACH_S = 0.02


class AdmittanceLoop:
    """The offset caused by forces, per axis of the task frame (m, then rad), updated once per period.

    The total offset, feed-forward plus admittance, stays within the reach and the speed of the
    parameters. Clipped offset is discarded, so there is no windup.
    """

    def __init__(self, admittance: Compliance) -> None:
        self._law = admittance
        self._axes = tuple(axis for axis in range(_AXES) if admittance.active[axis] > 0.0)
        self._reach = (admittance.reach_m,) * 3 + (admittance.turn_rad,) * 3
        self._speed = (admittance.speed_m_s,) * 3 + (admittance.turn_rad_s,) * 3
        self._touch = (admittance.touch_m_s,) * 3 + (math.inf,) * 3
        self._offset = [0.0] * _AXES
        self._rate = [0.0] * _AXES
        self.total = np.zeros(_AXES)

    @property
    def axes(self) -> tuple[int, ...]:
        """The active axes."""
        return self._axes

    def press(self, step_s: float, *, measured: Array, target: Array, feed_forward: Array) -> None:
        """Advance so that the measured wrench converges to the target one, (6,); `total` is the whole offset."""
        for axis in self._axes:
            force, desired = float(measured[axis]), float(target[axis])
            damping = self._damping(axis, force, desired)
            self._move(axis, step_s, force - desired, damping, float(feed_forward[axis]))
        self._add_up(feed_forward)

    def relieve(self, step_s: float, *, measured: Array, target: Array, feed_forward: Array) -> None:
        """Come to rest; move only away from forces clearly above the target ones, never towards them."""
        for axis in self._axes:
            excess = float(measured[axis] - target[axis])
            towards = excess * float(target[axis]) < 0.0
            excess = 0.0 if towards else np.copysign(max(0.0, abs(excess) - _BORNE[axis]), excess)
            self._move(axis, step_s, float(excess), self._law.damping[axis], float(feed_forward[axis]))
        self._add_up(feed_forward)

    def _damping(self, axis: int, force: float, desired: float) -> float:
        """Return the damping: that of the law where the tool presses, more where it does not touch yet."""
        damping = self._law.damping[axis]
        if desired == 0.0:
            return damping
        free = max(damping, self._law.active[axis] * abs(desired) / self._touch[axis])
        share = min(1.0, max(0.0, force / (_PRESSING_SHARE * desired)))
        return free + share * (damping - free)

    def _move(self, axis: int, step_s: float, error: float, damping: float, feed_forward: float) -> None:
        law, offset = self._law, self._offset[axis]
        mass, stiffness = law.mass[axis], law.stiffness[axis]
        push = step_s * (law.active[axis] * error - stiffness * offset)
        rate = (mass * self._rate[axis] + push) / (mass + step_s * (damping + step_s * stiffness))
        whole = self.total[axis]
        reach, speed = self._reach[axis], self._speed[axis]
        farthest = min(speed, max(0.0, reach - whole) / _APPROACH_S) * step_s
        nearest = -min(speed, max(0.0, reach + whole) / _APPROACH_S) * step_s
        step = min(max(offset + rate * step_s + feed_forward - whole, nearest), farthest)
        moved = min(max(whole + step, -reach), reach) - feed_forward
        self._offset[axis], self._rate[axis] = moved, (moved - offset) / step_s

    def _add_up(self, feed_forward: Array) -> None:
        self.total[:] = self._offset
        self.total += feed_forward
