"""What simulates soft hands with one motor."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

from engine.messages import HandState
from robots.gripper import HandServer, ToolServer
from robots.model.hand_mechanism import SynergyModel
from robots.model.tool_model import ToolModel
from robots.port.hand_grasp_check import hand_state
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.sim.ports.tool_ports import ToolLine
from robots.sim.world.sim_world import SimWorld
from robots.standard_tools.hand_body import HandIndices, finish_hand, hand_indices
from robots.standard_tools.hand_port import SimHandPort, hand_sample
from robots.standard_tools.soft_hand_mechanics import SoftHandMechanics
from robots.standard_tools.tool_simulation import ToolSimulation


class HandSimulation:
    """Implements `ToolSimulation` for soft hands with one motor."""

    def finish(self, spec: Any, tool: ToolModel) -> None:
        """Add tendon, motor and skin."""
        finish_hand(spec, tool, tool.mechanism_as(SynergyModel))

    def indices(self, model: Any, arm: str, tool: ToolModel, *, ferrous: Iterable[str]) -> HandIndices:
        """Return the addresses of its parts in the world."""
        return hand_indices(model, arm, tool.mechanism_as(SynergyModel))

    def mechanics(self, arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics:
        """Return its mechanics in the loop."""
        if not isinstance(arm.tool, HandIndices):
            raise TypeError(f"{arm.name} carries no hand")
        return SoftHandMechanics(arm.tool, physics, contacts, own=arm.bodies)

    def summary(self, tool: ToolModel) -> ToolSummary:
        """Return its range; the contacts are the fingers, thumb first, then the palm."""
        hand = tool.mechanism_as(SynergyModel)
        return ToolSummary(
            kind="hand",
            contacts=len(hand.fingers) + 1,
            max_force_n=hand.max_force_n,
            shortest_time_s=hand.travel_m / hand.travel_speed_m_s,
        )

    def port(self, line: ToolLine) -> SimHandPort:
        """Return its port."""
        return SimHandPort(line)

    def state(self, reading: ToolReading, tool: ToolSummary, *, parts: Collection[str]) -> HandState:
        """Return its measured state."""
        return hand_state(hand_sample(reading), max_force_n=tool.max_force_n)

    def server(self, name: str, world: SimWorld, arm: str) -> ToolServer:
        """Return its server."""
        return HandServer(name=name, port=world.hand(arm))


HAND_SIMULATION: ToolSimulation = HandSimulation()
