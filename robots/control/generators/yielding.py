"""After a failure: the set point comes to rest, then moves to where the arm is, so that it presses on nothing."""

from __future__ import annotations

from collections import deque

import numpy as np

from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.model.robot_model import JointLimits
from robots.port import Array

_NEAR_RAD = 1e-9
_LONGEST_S = 2.0
_MEASURED_S = 0.05


class YieldGenerator:
    """Every joint brakes and then moves independently, as fast as its limits of speed, acceleration and jerk allow.

    The goal is the median of the joints measured in the 50 ms before: one measurement that is wrong moves nothing.
    `position`, `velocity` and `acceleration` are
    the present set point, (n,), reused by `step`.

    Args:
        limits: Joint limits.
        position: The last set point, (n,), rad; with its `velocity` and `acceleration`.
    """

    name = "yielding after a failure"
    """For messages."""

    def __init__(self, *, limits: JointLimits, position: Array, velocity: Array, acceleration: Array) -> None:
        self._shaper = OnlineTrajectoryGenerator(limits=limits, start=position)
        self._shaper.place(position, velocity, acceleration)
        self._goal: Array | None = None
        self._measured: deque[tuple[float, Array]] = deque()
        self._measured_s = 0.0
        self._passed_s = 0.0
        self.position = self._shaper.position
        self.velocity = self._shaper.velocity
        self.acceleration = self._shaper.acceleration

    @property
    def complete(self) -> bool:
        """True at rest at the goal."""
        return self._goal is not None and self._shaper.at_rest and self._is_there(self._goal)

    def step(self, step_s: float, measured: Array) -> None:
        """Advance by `step_s`; `measured` are the present joints, (n,)."""
        shaper = self._shaper
        if self._goal is None:
            self._note(step_s, measured)
            if not shaper.at_rest:
                shaper.brake(step_s)
                return
            if self._measured_s < _MEASURED_S:
                return
            median = np.median([joints for _, joints in self._measured], axis=0)
            self._goal = np.minimum(np.maximum(median, shaper.lower_rad), shaper.upper_rad)
        self._passed_s += step_s
        if not self.complete:
            shaper.go_to(step_s, position=self._goal, pace=1.0)

    def _note(self, step_s: float, measured: Array) -> None:
        """Keep what was measured in the last 50 ms."""
        self._measured.append((step_s, measured.copy()))
        self._measured_s += step_s
        while self._measured_s - self._measured[0][0] >= _MEASURED_S:
            self._measured_s -= self._measured.popleft()[0]

    def _is_there(self, goal: Array) -> bool:
        return self._passed_s > _LONGEST_S or float(np.abs(goal - self.position).max()) < _NEAR_RAD
