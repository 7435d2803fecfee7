"""The contract between the simulated world and a kind of tool, and the server of the tool on a simulated arm.

Each room of the simulator asks for its part: physics for a body, grip for mechanics and a summary, ports for a port,
world for a state.
"""

from __future__ import annotations

from typing import Protocol, cast

from robots.gripper.tool_server import ToolServer
from robots.model.tool_model import ToolModel
from robots.sim.grip.mechanics import MechanicsMaker
from robots.sim.grip.tool_reading import StatePublisher
from robots.sim.grip.tool_summary import ToolSummarizer
from robots.sim.physics.tool_body import ToolBody
from robots.sim.ports.tool_ports import PortMaker
from robots.sim.world.sim_world import SimWorld
from robots.tool_kinds import kind_of_mechanism, load_simulation


class ToolSimulation(ToolBody, MechanicsMaker, ToolSummarizer, PortMaker, StatePublisher, Protocol):
    """What simulates a kind of tool."""

    def server(self, name: str, world: SimWorld, arm: str) -> ToolServer:
        """Return the server of the tool on an arm, under `name` on the bus."""
        ...


def tool_server(world: SimWorld, arm: str, tool: ToolModel | None) -> ToolServer | None:
    """Return the server of an arm's tool under `<arm>/<kind of tool>`, None for a bare flange."""
    if tool is None:
        return None
    kind = kind_of_mechanism(tool.kind).name
    return cast("ToolSimulation", load_simulation(kind)).server(f"{arm}/{kind}", world, arm)
