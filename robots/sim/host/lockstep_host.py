"""A world in this process, stepped in virtual time on demand."""

from __future__ import annotations

import math

import numpy as np

from engine.errors import RobotError
from robots.port import Array
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import AnyCommand, ModulePlaced, PlaceModule, RestoreWorld
from robots.sim.host.world_host import StepHook, WorldListener
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import CellSummary, SimSnapshot
from robots.sim.physics.cell_model import build_cell


class LockstepHost:
    """Steps the simulation on the calling thread; deterministic, faster than real time if possible."""

    def __init__(self, scene: SimScene) -> None:
        self._scene = scene
        self._simulation: Simulation | None = None
        self._listener: WorldListener | None = None
        self._start_s = 0.0
        self._start_steps = 0

    @property
    def simulation(self) -> Simulation:
        """The simulation itself, for tests and measurements.

        Raises:
            RobotError: the world is not open.
        """
        if self._simulation is None:
            raise RobotError("the simulated world is not open", hint="enter it with `async with` first")
        return self._simulation

    @property
    def summary(self) -> CellSummary:
        """Summary of the world."""
        return self.simulation.summary

    @property
    def busy(self) -> bool:
        """True while a motion is active."""
        return self.simulation.busy

    def snapshot(self) -> SimSnapshot:
        """Return the state after the last step."""
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        return SimSnapshot(self.simulation.layout, values)

    def image(self) -> Array:
        """Return the complete state after the last step."""
        image = np.zeros(self.summary.image_size)
        self.simulation.write_image(image)
        return image

    def measures(self) -> dict[str, float]:
        """Return what the world has summed up, the last step included."""
        measures = self.simulation.measures
        return measures.layout.read(measures.values())

    async def restore(self, image: Array) -> None:
        """Restore an image of this world, at rest."""
        before = self.simulation.steps
        self.simulation.apply(RestoreWorld(image=image))
        # The world's clock jumps; the loop's does not.
        self._start_steps += self.simulation.steps - before

    async def place_module(self, command: PlaceModule) -> ModulePlaced:
        """Plug or unplug a module between two steps."""
        return self.simulation.place_module(command)

    def send(self, command: AnyCommand) -> None:
        """Send a command, which acts from the next step on."""
        self.simulation.apply(command)

    async def open(self, listener: WorldListener) -> None:
        """Build the world; raises CellError when it cannot be built."""
        self._simulation = Simulation(build_cell(self._scene))
        self._listener = listener

    def begin(self, now_s: float) -> None:
        """Align the world's present with `now_s` of the time base of `advance`."""
        self._start_s = now_s
        self._start_steps = self.simulation.steps

    def advance(self, until_s: float, *, after_step: StepHook) -> float:
        """Step towards `until_s`; return early, with the time reached, after any callback into the event loop."""
        simulation, listener = self.simulation, self._listener
        assert listener is not None
        step_s = simulation.step_s
        # A step that ends within a billionth of a step after `until_s` still belongs to it.
        due = math.inf if math.isinf(until_s) else self._steps_until(until_s)
        while simulation.steps < due:
            try:
                events = simulation.step()
            except Exception as error:
                # For any error: no motion of this world ends any more, and who waits for one would wait for ever.
                listener.lost(f"the world cannot be stepped: {type(error).__name__}: {error}")
                raise
            for event in events:
                listener.happened(event)
            if after_step() or events:
                reached = self._start_s + (simulation.steps - self._start_steps) * step_s
                return min(reached, until_s)
        return until_s

    def _steps_until(self, until_s: float) -> int:
        return self._start_steps + math.floor((until_s - self._start_s) / self.simulation.step_s + 1e-9)

    async def close(self) -> None:
        """Drop the world."""
        self._listener = None
