"""What an arm measures during an exciting motion."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.bus import ActiveGoal, GoalStatus
from robots.arm.execution.motion_runner import MotionRunner
from robots.port import ArmSample, Array

_SAMPLE_S = 0.01


class MotionSamples:
    """Records while its goal is not held: call `run`, cancel it, then read the arrays.

    Args:
        runner: The arm's motion runner.
        handle: The goal.
    """

    def __init__(self, runner: MotionRunner, handle: ActiveGoal[Any]) -> None:
        self._runner = runner
        self._handle = handle
        self._samples: list[ArmSample] = []

    async def run(self) -> None:
        """Take samples until cancelled."""
        clock = self._runner.clock
        due_s = clock.now_s()
        while True:
            self._take()
            due_s = max(due_s + _SAMPLE_S, clock.now_s())
            await clock.sleep(due_s - clock.now_s())

    def _take(self) -> None:
        sample = self._runner.port.sample()
        fresh = not self._samples or sample.time_s > self._samples[-1].time_s
        if fresh and self._handle.status is not GoalStatus.HELD:
            self._samples.append(sample)

    @property
    def count(self) -> int:
        """Number of samples so far."""
        return len(self._samples)

    @property
    def position_rad(self) -> Array:
        """Measured joints, (samples, n)."""
        return np.array([sample.position_rad for sample in self._samples])

    @property
    def effort_nm(self) -> Array:
        """Measured torques of the motors, (samples, n)."""
        return np.array([sample.effort_nm for sample in self._samples])

    @property
    def wrench(self) -> Array:
        """Measured force and torque at the tool centre point, world axes, without the load set, (samples, 6)."""
        return np.array([sample.wrench for sample in self._samples])

    def rate_of(self, values: Array) -> Array:
        """Return the time derivative of a value of each sample, by central differences."""
        return np.gradient(values, np.array([sample.time_s for sample in self._samples]), axis=0)

    @property
    def set_point_rad(self) -> Array:
        """The set points, (samples, n): their derivatives are those of the motion, without noise."""
        return np.array([sample.desired_rad for sample in self._samples])
