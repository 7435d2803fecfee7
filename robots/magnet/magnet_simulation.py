"""What simulates switchable magnets."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, cast

from robots.gripper import ToolServer
from robots.magnet.magnet_body import MagnetIndices, finish_magnet, magnet_indices
from robots.magnet.magnet_grasp_check import magnet_state
from robots.magnet.magnet_mechanics import MagnetMechanics
from robots.magnet.magnet_model import MagnetModel
from robots.magnet.magnet_port import MagnetPort
from robots.magnet.magnet_server import MagnetServer
from robots.magnet.magnet_skills import MagnetState
from robots.magnet.simulated_magnet_port import SimMagnetPort, magnet_sample
from robots.model.tool_model import ToolModel
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.sim.ports.tool_ports import ToolLine
from robots.sim.world.sim_world import SimWorld
from robots.standard_tools.tool_simulation import ToolSimulation


class MagnetSimulation:
    """Implements `ToolSimulation` for switchable magnets."""

    def finish(self, spec: Any, tool: ToolModel) -> None:
        """Add the pole face."""
        finish_magnet(spec, tool.mechanism_as(MagnetModel))

    def indices(self, model: Any, arm: str, tool: ToolModel, *, ferrous: Iterable[str]) -> MagnetIndices:
        """Return the addresses of its parts in the world."""
        return magnet_indices(model, arm, tool.mechanism_as(MagnetModel), ferrous=ferrous)

    def mechanics(self, arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics:
        """Return its mechanics in the loop."""
        if not isinstance(arm.tool, MagnetIndices):
            raise TypeError(f"{arm.name} carries no magnet")
        return MagnetMechanics(arm.tool, physics, contacts, own=arm.bodies)

    def summary(self, tool: ToolModel) -> ToolSummary:
        """Return its force; the contact is its face."""
        magnet = tool.mechanism_as(MagnetModel)
        return ToolSummary(kind="magnet", contacts=1, max_force_n=magnet.max_force_n)

    def port(self, line: ToolLine) -> SimMagnetPort:
        """Return its port."""
        return SimMagnetPort(line)

    def state(self, reading: ToolReading, tool: ToolSummary, *, parts: Collection[str]) -> MagnetState:
        """Return its measured state."""
        return magnet_state(magnet_sample(reading), max_force_n=tool.max_force_n)

    def server(self, name: str, world: SimWorld, arm: str) -> ToolServer:
        """Return its server."""
        return MagnetServer(name=name, port=cast("MagnetPort", world.tool(arm, "magnet")))


MAGNET_SIMULATION: ToolSimulation = MagnetSimulation()
