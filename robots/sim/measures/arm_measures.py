"""What one arm does in a run: its path, speed, and lag behind its set point, and what presses on its tool."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robots.control.arm_control_loop import ArmControlLoop
from robots.port import Array

_PATH_M, _JOINT_PATH_RAD, _SPEED_M_S, _ERROR_RAD, _FORCE_N, _TORQUE_NM = range(6)


class ArmMeasures:
    """Keeps rows of numbers and sums them up once a block: to sum up each step would cost ten times as much.

    The wrench is that of every step; path, speed and lag are those of every sample.

    Args:
        values: Where the measures are kept, in the order of `MeasureLayout`.
        control: The control loop of the arm.
        tool_xyz: Returns the tool centre point in the world in the last step, (3,).
        steps: Steps in a block.
        samples: Samples in a block.
        sample_s: Time between two samples.
    """

    def __init__(
        self,
        values: Array,
        *,
        control: ArmControlLoop,
        tool_xyz: Callable[[], Array],
        steps: int,
        samples: int,
        sample_s: float,
    ) -> None:
        n = len(control.state.position)
        self.wrench = control.state.wrench
        """The wrench of the last step, (6,); always the same array."""
        self.wrenches = np.zeros((steps, 6))
        """One row for each step of the block; the loop fills it."""
        self._values = values
        self._control = control
        self._tool_xyz = tool_xyz
        self._sample_s = sample_s
        # The first row is the last sample of the block before.
        self._points = np.zeros((samples + 1, 3))
        self._joints = np.zeros((samples + 1, n))
        self._set_points = np.zeros((samples + 1, n))
        self._count = 0
        self._tool_xyz_m = control.tool_xyz_m.copy()

    def sample(self) -> None:
        """Keep where the arm is."""
        control, row = self._control, self._count
        if control.tool_xyz_m is not self._tool_xyz_m and not np.array_equal(control.tool_xyz_m, self._tool_xyz_m):
            # Another tool centre point is no movement.
            self._reduce_path()
            self._count = row = 0
        self._tool_xyz_m = control.tool_xyz_m
        self._points[row] = self._tool_xyz()
        self._joints[row] = control.state.position
        self._set_points[row] = control.motion.position
        self._count = row + 1

    def reduce(self, steps: int) -> None:
        """Sum up the block, of which so many rows of wrenches are filled."""
        values = self._values
        if steps:
            squares = np.square(self.wrenches[:steps])
            values[_FORCE_N] = max(values[_FORCE_N], np.sqrt(squares[:, :3].sum(axis=1).max()))
            values[_TORQUE_NM] = max(values[_TORQUE_NM], np.sqrt(squares[:, 3:].sum(axis=1).max()))
        self._reduce_path()

    def restart(self) -> None:
        """Begin again after the world has jumped to another state."""
        self._count = 0

    def _reduce_path(self) -> None:
        count, values = self._count, self._values
        if not count:
            return
        errors = np.abs(self._set_points[:count] - self._joints[:count])
        values[_ERROR_RAD] = max(values[_ERROR_RAD], errors.max())
        if count > 1:
            lengths_m = np.sqrt(np.square(np.diff(self._points[:count], axis=0)).sum(axis=1))
            values[_PATH_M] += lengths_m.sum()
            values[_SPEED_M_S] = max(values[_SPEED_M_S], lengths_m.max() / self._sample_s)
            values[_JOINT_PATH_RAD] += np.abs(np.diff(self._joints[:count], axis=0)).sum()
        for rows in (self._points, self._joints, self._set_points):
            rows[0] = rows[count - 1]
        self._count = 1
