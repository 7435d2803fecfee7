"""A rig of joined parts in physics, with names for what is looked at."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine.document.cell import load_cell
from engine.skills.simulated_world import PushBody
from robots.port import Array
from robots.scene.scene_builder import build_scene
from robots.sim.commands.world_commands import AnyCommand, PushSimBody
from robots.sim.loop.bond_reading import BondReading
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell


class BondRig:
    """A simulation with names for what is looked at."""

    def __init__(self, folder: Path, text: str, *, seed: int | None = None) -> None:
        file = folder / "cell.yaml"
        file.write_text(text, encoding="utf-8")
        self.scene = build_scene(load_cell(file).document, seed=seed)
        self.simulation = Simulation(build_cell(self.scene))

    def apply(self, command: AnyCommand) -> None:
        """Apply a command."""
        self.simulation.apply(command)

    def push(self, body: str, *force_n: float, duration_s: float = 1.0) -> None:
        """Push at the centre of a body."""
        x, y, z = force_n
        self.apply(PushSimBody(push=PushBody(body=body, force_n=(x, y, z), duration_s=duration_s)))

    def pass_time(self, time_s: float) -> None:
        """Simulate."""
        for _ in range(round(time_s / self.simulation.step_s)):
            self.simulation.step()

    @property
    def _snapshot(self) -> SimSnapshot:
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        return SimSnapshot(self.simulation.layout, values)

    def bonds(self) -> dict[str, BondReading]:
        """Return what is told of the bonds."""
        return self._snapshot.bonds()

    def place(self, part: str) -> Array:
        """Return where a part is."""
        return self._snapshot.frame(part)[0].copy()

    def image(self) -> Array:
        """Return the complete state."""
        values = np.zeros(self.simulation.image_layout.size)
        self.simulation.write_image(values)
        return values
