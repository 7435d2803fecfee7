"""The carriages of linear units in a simulation: how firmly each is held, and where the arms on them stand."""

from __future__ import annotations

import numpy as np

from robots.control.arm_control_loop import ArmControlLoop
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.sim.commands.world_commands import BrakeCarriage
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.device_axis import CARRIAGE_N_M, damping_ns_m
from robots.sim.physics.physics import Physics

# A base that has moved by less is where it was known to be.
_MOVED_M = 1e-6


def has_carriages(cell: CellModel) -> bool:
    """Return whether an arm of a world stands on a carriage."""
    return any(fixture.carriage is not None for fixture in cell.scene.fixtures)


class Carriages:
    """Owned by the simulation; call `step` in each step, before the motors.

    Where the spring of a carriage is without force is part of an image, as are the controls of motors. How much it
    holds is set anew by who switches the brakes.
    """

    def __init__(self, cell: CellModel, physics: Physics, arms: dict[str, ArmControlLoop]) -> None:
        self._physics = physics
        self._bodies = {one.name: one.carriage for one in cell.scene.fixtures if one.carriage is not None}
        self._row = {name: row for row, name in enumerate(self._bodies)}
        self._motors = np.array([physics.motor_number(name) for name in self._bodies], dtype=np.intp)
        self._places = np.array([physics.joint_address(name) for name in self._bodies], dtype=np.intp)
        self._stretch_m = np.zeros(len(self._bodies))
        for name, one in self._bodies.items():
            self.brake(BrakeCarriage(carriage=name, force_n=one.holding_n, released=False))
        self._riders = [
            _Rider(arms[arm.name], self._row[arm.on], _rail(cell, arm.on))
            for arm in cell.scene.arms
            if arm.on and not arm.driven
        ]

    def brake(self, command: BrakeCarriage) -> None:
        """Set the force at which a carriage slips; unknown carriages are ignored."""
        if command.carriage not in self._row:
            return
        self._stretch_m[self._row[command.carriage]] = command.force_n / CARRIAGE_N_M
        damping = damping_ns_m(self._bodies[command.carriage], released=command.released)
        self._physics.set_damping(command.carriage, damping)

    def step(self) -> None:
        """Let the carriages slip that are pushed too much, and tell the arms on them where they stand."""
        if not self._motors.size:
            return
        motors, places_m = self._physics.motors, self._physics.positions[self._places]
        motors[self._motors] = np.clip(motors[self._motors], places_m - self._stretch_m, places_m + self._stretch_m)
        for rider in self._riders:
            rider.stand_at(float(places_m[rider.row]))


class _Rider:
    """An arm on a carriage; its control loop knows where its base is."""

    def __init__(self, control: ArmControlLoop, row: int, rail: Array) -> None:
        self.row = row
        self._rail = rail
        self._stand = control.stand
        self._home = control.stand.pose
        self._known_m = 0.0

    def stand_at(self, place_m: float) -> None:
        """Stand at a place of the carriage."""
        if abs(place_m - self._known_m) > _MOVED_M:
            self._known_m = place_m
            self._stand.stand_at(RigidTransform(xyz=self._home.xyz + place_m * self._rail, xyzw=self._home.xyzw))


def _rail(cell: CellModel, carriage: str) -> Array:
    """Return the direction of a rail in the world."""
    fixture = next(one for one in cell.scene.fixtures if one.name == carriage)
    assert fixture.carriage is not None
    return RigidTransform.from_pose(fixture.pose).rotation @ np.array(fixture.carriage.along)
