"""A person at the table of the test cells, and what an opened world says of her."""

from __future__ import annotations

import msgspec
import numpy as np

from engine.messages import Vector3
from engine.skills.people import Reach
from robots.port import Array
from robots.scene.sim_scene import PersonBody, SimScene
from robots.sim.commands.world_commands import MovePersonHand
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.people.person_report import PersonSample
from robots.sim.physics.cell_model import CellModel

ANNA = PersonBody(name="anna", shoulder=(0.0, -0.65, 0.45), hand_rests=(0.0, -0.6, 0.15))
REST = np.array(ANNA.hand_rests)
# Hands off the arms at home: over the middle of the table.
OVER_TABLE: Vector3 = (0.0, -0.2, 0.25)
# Between the fingers' mount and the wrist of the left arm at home, whose hand is at (-0.24, 0, 0.59).
AT_LEFT_HAND: Vector3 = (-0.22, -0.07, 0.6)


def with_anna(scene: SimScene, anna: PersonBody = ANNA) -> SimScene:
    """Return the scene with the person in it."""
    return msgspec.structs.replace(scene, people=(anna,))


class SteppedPerson:
    """The person of a world of its own, stepped by hand."""

    def __init__(self, cell: CellModel) -> None:
        self.simulation = Simulation(cell)

    def reach(self, hand_m: Vector3, *, speed_m_s: float = 1.0, stay_s: float | None = None) -> None:
        """Send the hand to a place."""
        self.simulation.apply(
            MovePersonHand(reach=Reach(person="anna", hand_m=hand_m, speed_m_s=speed_m_s, stay_s=stay_s))
        )

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / self.simulation.step_s)):
            self.simulation.step()

    def places(self, seconds: float) -> Array:
        """Let time pass and return where the bodies were before each step, shape (steps, 3, 3)."""
        row = self.simulation.summary.frames.index("anna/upper_arm")
        seen: list[Array] = []
        for _ in range(round(seconds / self.simulation.step_s)):
            self.simulation.step()
            seen.append(np.array(self.snapshot().frames()[0][row : row + 3]))
        return np.array(seen)

    def snapshot(self) -> SimSnapshot:
        """What is measured now."""
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        return SimSnapshot(self.simulation.layout, values)

    @property
    def sample(self) -> PersonSample:
        """What she does and has touched."""
        return self.snapshot().person("anna")
