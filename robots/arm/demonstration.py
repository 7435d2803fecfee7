"""Records a hand-guided demonstration: joints, tool poses and wrenches over time, as an entry of kind `trajectory`."""

from __future__ import annotations

from typing import Any

from engine.bus import ActiveGoal, GoalStatus
from engine.messages.demonstrations import Trajectory
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.tool_frames import WORLD

MOST_SAMPLES = 30_000
"""Maximum number of samples that fit into one entry of the store."""
# Decimal places kept: microradian, micrometer, micronewton.
_DIGITS = 6


class DemonstrationRecorder:
    """Records while its goal is not held: call `run`, cancel it, then read `trajectory`.

    Args:
        runner: The arm's motion runner.
        handle: The guiding goal.
        sample_s: Sampling period.
    """

    def __init__(self, runner: MotionRunner, handle: ActiveGoal[Any], *, sample_s: float) -> None:
        self._runner = runner
        self._handle = handle
        self._sample_s = sample_s
        self._times: list[float] = []
        self._joints: list[tuple[float, ...]] = []
        self._poses: list[tuple[float, ...]] = []
        self._wrenches: list[tuple[float, ...]] = []
        self._device_s: float | None = None
        self._passed_s = 0.0

    @property
    def count(self) -> int:
        """Number of samples so far."""
        return len(self._times)

    @property
    def full(self) -> bool:
        """True when the recorder takes no more samples."""
        return self.count >= MOST_SAMPLES

    async def run(self) -> None:
        """Take samples until cancelled."""
        clock = self._runner.clock
        due_s = clock.now_s()
        while True:
            self.take()
            due_s = max(due_s + self._sample_s, clock.now_s())
            await clock.sleep(due_s - clock.now_s())

    def take(self) -> None:
        """Take a sample, unless the goal is held or the device has no new measurement since the last one."""
        sample = self._runner.port.sample()
        last_s, self._device_s = self._device_s, sample.time_s
        if self._handle.status is GoalStatus.HELD or self.full:
            return
        if last_s is not None:
            if sample.time_s <= last_s:
                return
            self._passed_s += sample.time_s - last_s
        tool = self._runner.kinematics.tool_pose(sample.position_rad)
        self._times.append(round(self._passed_s, _DIGITS))
        self._joints.append(_rounded(sample.position_rad.tolist()))
        self._poses.append(_rounded((*tool.xyz.tolist(), *tool.xyzw.tolist())))
        self._wrenches.append(_rounded(sample.wrench.tolist()))

    def trajectory(self) -> Trajectory:
        """Return the recorded trajectory; requires at least two samples."""
        return Trajectory(
            times_s=tuple(self._times),
            joints=tuple(self._joints),
            names=self._runner.model.arm_joints,
            poses=tuple(self._poses),
            frame=WORLD,
            wrenches=tuple(self._wrenches),
            wrench_frame=WORLD,
        )


def _rounded(values: list[float] | tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(value, _DIGITS) for value in values)
