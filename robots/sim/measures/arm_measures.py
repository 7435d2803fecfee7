"""What one arm does in a run: its path, speed, and lag behind its set point, and what presses on its tool."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from engine.measures import ArmSums
from robots.control.arm_control_loop import ArmControlLoop
from robots.port import Array


class ArmMeasures:
    """Sums up path, speed and lag of every sample, and, in blocks at little cost, the wrench of every step.

    Args:
        values: Where the measures are kept, in the order of `ARM_MEASURES`.
        control: The control loop of the arm.
        tool_xyz: Returns the tool centre point in the world in the last step, (3,).
        steps: Steps in a block.
        sample_s: Time between two samples.
    """

    def __init__(
        self,
        values: Array,
        *,
        control: ArmControlLoop,
        tool_xyz: Callable[[], Array],
        steps: int,
        sample_s: float,
    ) -> None:
        self.wrench = control.state.wrench
        """The wrench of the last step, (6,); always the same array."""
        self.wrenches = np.zeros((steps, 6))
        """One row for each step of the block; the loop fills it."""
        self._values = values
        self._control = control
        self._tool_xyz = tool_xyz
        self._sample_s = sample_s
        self._sums = ArmSums()
        self._tool_xyz_m = control.tool_xyz_m.copy()

    def sample(self) -> None:
        """Take note of where the arm is."""
        control, sums = self._control, self._sums
        if control.tool_xyz_m is not self._tool_xyz_m and not np.array_equal(control.tool_xyz_m, self._tool_xyz_m):
            sums.leave_tool()
        self._tool_xyz_m = control.tool_xyz_m
        position_rad = control.state.position.tolist()
        sums.move_tool(self._tool_xyz().tolist(), self._sample_s)
        sums.move_joints(position_rad)
        sums.lag(control.motion.position.tolist(), position_rad)

    def reduce(self, steps: int) -> None:
        """Sum up the block, of which so many rows of wrenches are filled."""
        if steps:
            squares = np.square(self.wrenches[:steps])
            force, torque = squares[:, :3].sum(axis=1).max(), squares[:, 3:].sum(axis=1).max()
            self._sums.press(math.sqrt(force), math.sqrt(torque))
        # What there is no sample of yet stays as it is in a new world.
        self._values[:] = np.where(np.isnan(found := np.array(self._sums.values)), self._values, found)

    def restart(self) -> None:
        """Begin again after the world has jumped to another state."""
        self._sums = ArmSums()
