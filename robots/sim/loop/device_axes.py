"""The axes of devices in a simulation: the force of each, and those that something keeps where they are."""

from __future__ import annotations

from robots.sim.commands.world_commands import DriveAxis
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics

# More than any cylinder or tool presses with, in N or N m.
_LOCK = 1e5


def has_axes(cell: CellModel) -> bool:
    """Return whether a device moves a fixture of a world."""
    return any(fixture.axis is not None for fixture in cell.scene.fixtures)


class DeviceAxes:
    """Owned by the simulation; the forces are part of an image, the locks are set anew by who drives the axes."""

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        self._force = {one.name: one.axis.force for one in cell.scene.fixtures if one.axis is not None}
        self._motor = {name: physics.motor_number(name) for name in self._force}

    def drive(self, command: DriveAxis) -> None:
        """Set the force of an axis from the next step on; unknown fixtures are ignored."""
        if command.fixture not in self._force:
            return
        self._physics.motors[self._motor[command.fixture]] = command.direction * self._force[command.fixture]
        self._physics.set_dry_friction(command.fixture, _LOCK if command.locked else 0.0)
