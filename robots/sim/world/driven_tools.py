"""Tells a simulated world what its tools with drivers report: whether they hold something."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.messages import Message
from engine.messages.tool_hold import ToolHold
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import MirrorTool
from robots.sim.host.world_host import WorldHost
from robots.tool_kinds import kind_of_mechanism, tool_kind


def mirror_driven_tools(bus: SkillBus, host: WorldHost, scene: SimScene) -> None:
    """Forward the reports of all tools with drivers to the world."""
    for placement in scene.arms:
        tool = placement.robot().tool
        if placement.driven_tool and tool is not None:
            _mirror(bus, host, placement.name, tool_kind_name=kind_of_mechanism(tool.kind).name)


def _mirror(bus: SkillBus, host: WorldHost, arm: str, *, tool_kind_name: str) -> None:
    def forward(state: Message) -> None:
        host.send(MirrorTool(arm=arm, held=isinstance(state, ToolHold) and state.held))

    bus.topic(f"{arm}/{tool_kind_name}/state", tool_kind(tool_kind_name).measured).subscribe_passively(forward)
