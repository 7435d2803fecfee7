"""The trajectory of a hand: straight with minimum jerk from rest, smooth from any initial velocity."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from robots.port import Array

# Minimum-jerk motion: peak speed times duration over distance, peak acceleration times duration² over distance.
_PEAK_SPEED = 1.875
_PEAK_ACCELERATION = 10.0 / math.sqrt(3.0)
GREATEST_ACCELERATION_M_S2 = 20.0
"""Acceleration of an arm in a hurry; the limit of a hand's acceleration and deceleration."""

_SHARES = np.linspace(0.0, 1.0, 65)[:, None]
_SMALL_S = 1e-9
_SLOWER = 1.15
_TRIES = 40
_SLACK = 1.001


@dataclass(frozen=True, kw_only=True)
class HandMotion:
    """Position and velocity of a hand, both (3,), world."""

    xyz: Array
    velocity: Array


@dataclass(frozen=True, kw_only=True)
class HandTrajectory:
    """A quintic polynomial from `start`, without acceleration, to rest at `goal` (3,) in `duration_s`."""

    start: HandMotion
    goal: Array
    duration_s: float

    def at(self, time_s: float) -> HandMotion:
        """Return the state after a time; at and after the end it rests at the goal."""
        if time_s >= self.duration_s or self.duration_s < _SMALL_S:
            return HandMotion(xyz=self.goal, velocity=np.zeros(3))
        share = max(time_s, 0.0) / self.duration_s
        return HandMotion(xyz=self._place(share), velocity=self._velocity(share))

    def place(self, time_s: float) -> Array:
        """Return the position after a time, as `at` does."""
        if time_s >= self.duration_s or self.duration_s < _SMALL_S:
            return self.goal
        return self._place(max(time_s, 0.0) / self.duration_s)

    def places(self) -> Array:
        """Return points along the path, (m, 3), both ends included."""
        return self._place(_SHARES)

    def peaks(self) -> tuple[float, float]:
        """Return peak speed and peak acceleration."""
        if self.duration_s < _SMALL_S:
            return 0.0, 0.0
        velocities = self._velocity(_SHARES)
        accelerations = np.diff(velocities, axis=0) / (self.duration_s * _SHARES[1])
        return (
            float(np.linalg.norm(velocities, axis=1).max()),
            float(np.linalg.norm(accelerations, axis=1).max()),
        )

    def _place(self, s: float | Array) -> Array:
        """Return the position after a share of the time, or after each of several in a column."""
        progress = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        run_on = s * (1.0 - s**2 * (6.0 - 8.0 * s + 3.0 * s**2)) * self.duration_s
        return self.start.xyz + progress * (self.goal - self.start.xyz) + run_on * self.start.velocity

    def _velocity(self, s: float | Array) -> Array:
        """Return the velocity, like `_place`."""
        rate = 30.0 * s**2 * (1.0 - s) ** 2 / self.duration_s
        left = 1.0 - s**2 * (18.0 - 32.0 * s + 15.0 * s**2)
        return rate * (self.goal - self.start.xyz) + left * self.start.velocity


def plan_hand_trajectory(start: HandMotion, goal: Array, *, speed_m_s: float) -> HandTrajectory:
    """Return the fastest trajectory below `speed_m_s`, or below the hand's present speed if that is higher."""
    distance_m = math.dist(start.xyz.tolist(), goal.tolist())
    moving_m_s = math.hypot(*start.velocity.tolist())
    duration_s = max(
        _PEAK_SPEED * distance_m / speed_m_s, math.sqrt(_PEAK_ACCELERATION * distance_m / GREATEST_ACCELERATION_M_S2)
    )
    if moving_m_s == 0.0:
        return HandTrajectory(start=start, goal=goal, duration_s=duration_s)
    # It must also shed its initial speed; the required time has no short formula.
    duration_s = max(duration_s, moving_m_s / GREATEST_ACCELERATION_M_S2)
    limit_m_s = max(speed_m_s, moving_m_s) * _SLACK
    trajectory = HandTrajectory(start=start, goal=goal, duration_s=duration_s)
    for _ in range(_TRIES):
        speed, acceleration = trajectory.peaks()
        if speed <= limit_m_s and acceleration <= GREATEST_ACCELERATION_M_S2 * _SLACK:
            break
        duration_s *= _SLOWER
        trajectory = HandTrajectory(start=start, goal=goal, duration_s=duration_s)
    return trajectory
