"""The brakes of hexapods in a simulation: each leg slips where its spring would pull more than its friction."""

from __future__ import annotations

import numpy as np

from robots.sim.commands.world_commands import BrakeLegs
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.hexapod_legs import STIFFNESS_N_M, leg_names
from robots.sim.physics.physics import Physics


class HexapodBrakes:
    """Owned by the simulation; call `step` in each step, when the lengths of the legs are known.

    By how much the spring of each leg is without force at another length than at the start is part of an image, as are
    the controls of motors. How much a leg holds is set anew by who switches the brakes.
    """

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        platforms = {one.name: one.hexapod for one in cell.scene.fixtures if one.hexapod is not None}
        self._rows = {name: slice(6 * index, 6 * index + 6) for index, name in enumerate(platforms)}
        legs = [leg for name in platforms for leg in leg_names(name)]
        self._motors = np.array([physics.motor_number(leg) for leg in legs], dtype=np.intp)
        self._tendons = np.array([physics.tendon_number(leg) for leg in legs], dtype=np.intp)
        holding = [one.holding_n / STIFFNESS_N_M for one in platforms.values() for _ in range(6)]
        self._stretch_m = np.array(holding)
        self._start_m = physics.tendon_lengths[self._tendons].copy()

    def brake(self, command: BrakeLegs) -> None:
        """Set the force at which the legs of a platform slip; unknown platforms are ignored."""
        if command.platform in self._rows:
            self._stretch_m[self._rows[command.platform]] = command.force_n / STIFFNESS_N_M

    def step(self) -> None:
        """Let the legs slip that are pulled or pressed too much."""
        if not self._motors.size:
            return
        motors, longer_m = self._physics.motors, self._physics.tendon_lengths[self._tendons] - self._start_m
        motors[self._motors] = np.clip(motors[self._motors], longer_m - self._stretch_m, longer_m + self._stretch_m)
