"""The ports of simulated tools, the same for both hosts: each kind of tool has its own on a shared line."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Protocol, cast

from engine.errors import CellError, RobotError
from robots.control.commanding.exclusive_motion import ExclusiveMotion
from robots.control.commanding.motion_registry import CommandedMotion, MotionRegistry
from robots.sim.commands.world_commands import MoveTool
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.snapshot import ArmSummary
from robots.tool_kinds import load_simulation


class ToolLine:
    """What all ports of simulated tools share: command channel and exclusive motion."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arm: str, tool: ToolSummary) -> None:
        self.host = host
        self.arm = arm
        self.tool = tool
        self.address = f"{arm}/{tool.kind}"
        self._one = ExclusiveMotion(self.address, board)

    def number(self) -> int:
        """Return the number for the next motion."""
        return self._one.number()

    def reading(self) -> ToolReading:
        """Return the latest measurement."""
        return self.host.snapshot().tool(self.arm)

    def start(self, number: int, goal: tuple[float, ...]) -> CommandedMotion:
        """Send the command that starts motion `number` towards a goal."""
        host, arm = self.host, self.arm
        motion = CommandedMotion(number, send=host.send, progress=lambda: host.snapshot().tool_progress(arm, number))
        command = MoveTool(arm=arm, motion=number, goal=goal)
        return self._one.start(motion, partial(host.send, command))

    def lead(self, goal: tuple[float, ...]) -> CommandedMotion:
        """Send the active motion to another goal, under its number, or start one."""
        active = self._one.active
        if active is None:
            return self.start(self.number(), goal)
        self.host.send(MoveTool(arm=self.arm, motion=active.number, goal=goal))
        return active

    def require(self, what: str, value: float, *, above_zero: bool) -> None:
        """Raise RobotError unless `value` is finite and at least 0, or above 0 with `above_zero`."""
        if not math.isfinite(value) or value < 0.0 or (above_zero and value == 0.0):
            raise RobotError(f"{what} cannot be {value}", where=self.address)


class PortMaker(Protocol):
    """How a kind of tool is commanded and read."""

    def port(self, line: ToolLine) -> object:
        """Return the port of a tool, as its server wants it."""
        ...


class ToolPorts:
    """The ports of the tools of all arms, by the arm's name."""

    def __init__(self, host: WorldHost, board: MotionRegistry, arms: Mapping[str, ArmSummary]) -> None:
        tools = {name: arm.tool for name, arm in arms.items() if arm.tool is not None}
        self._kinds = {name: tool.kind for name, tool in tools.items()}
        self._ports = {
            name: cast("PortMaker", load_simulation(tool.kind)).port(ToolLine(host, board, name, tool))
            for name, tool in tools.items()
        }

    def port(self, arm: str, kind: str) -> object:
        """Return the port of the tool of a kind on an arm; raises CellError where there is none."""
        if self._kinds.get(arm) != kind:
            others = ", ".join(name for name, other in self._kinds.items() if other == kind)
            raise CellError(f"the arm carries no {kind}", where=arm, hint=f"arms with one: {others or 'none'}")
        return self._ports[arm]
