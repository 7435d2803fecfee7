"""The belts of devices in a simulation: their surfaces run, and stop, with the acceleration of their drives."""

from __future__ import annotations

from dataclasses import dataclass

from robots.scene.sim_scene import BeltBody
from robots.sim.commands.world_commands import DriveAxis
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics


@dataclass(kw_only=True)
class _RunningBelt:
    spec: BeltBody
    due_m_s: float = 0.0
    speed_m_s: float = 0.0


class Belts:
    """Owned by the simulation; call `run` before the physics of a step.

    Who drives the belts drives them anew after a restore, in which they stand.
    """

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        self._belts = {one.name: _RunningBelt(spec=one.belt) for one in cell.scene.fixtures if one.belt is not None}

    def drive(self, command: DriveAxis) -> None:
        """Let a belt run forwards, 1, back, -1, or stop, 0, from the next step on; a locked one stands at once."""
        belt = self._belts.get(command.fixture)
        if belt is None:
            return
        belt.due_m_s = 0.0 if command.locked else command.direction * belt.spec.speed_m_s
        if command.locked:
            belt.speed_m_s = 0.0

    def run(self, step_s: float) -> None:
        """Let all surfaces run for a step."""
        for name, belt in self._belts.items():
            change = belt.spec.acceleration_m_s2 * step_s
            belt.speed_m_s += min(max(belt.due_m_s - belt.speed_m_s, -change), change)
            self._physics.run_joint(name, belt.speed_m_s)

    def stand(self) -> None:
        """Stand still, after a restore, until driven anew."""
        for belt in self._belts.values():
            belt.due_m_s = belt.speed_m_s = 0.0
