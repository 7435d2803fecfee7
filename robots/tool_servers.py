"""Creates the server of the tool on a simulated arm: gripper, hand or magnet."""

from __future__ import annotations

from robots.gripper.gripper_server import GripperServer
from robots.gripper.hand_server import HandServer
from robots.gripper.magnet_server import MagnetServer
from robots.gripper.tool_server import ToolServer
from robots.model.tool_model import ToolModel
from robots.sim.grip.tool_summary import tool_summary
from robots.sim.world.sim_world import SimWorld


def tool_server(world: SimWorld, arm: str, tool: ToolModel | None) -> ToolServer | None:
    """Return the server of an arm's tool under `<arm>/<device>`, None for a bare flange."""
    summary = tool_summary(tool)
    if summary is None:
        return None
    name = f"{arm}/{summary.device}"
    match summary.device:
        case "gripper":
            return GripperServer(name=name, port=world.gripper(arm))
        case "hand":
            return HandServer(name=name, port=world.hand(arm))
        case "magnet":
            return MagnetServer(name=name, port=world.magnet(arm))
