"""The tool of an arm of a simulated world, as an emulated device moves it."""

from __future__ import annotations

import asyncio
from typing import Protocol, cast

from engine.errors import CellError
from engine.messages.tool_hold import ToolHold
from robots.control.commanding.motion_registry import CommandedMotion
from robots.drivers.emulation.plant import ToolMeasurement, ToolPlant
from robots.port import GripperPort, Motion
from robots.sim.grip.tool_reading import state_publisher
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.world.sim_world import SimWorld
from robots.standard_tools.hand_port import SimHandPort

# Closer to its target the tool is there.
_THERE_SHARE = 0.03
# From here on a tool that is only on or off is on.
_ON_SHARE = 0.5


class WorldToolDrive(Protocol):
    """A tool of the world in shares of its travel, speed and force."""

    def start(self, closed_share: float, *, speed_share: float, force_share: float) -> Motion:
        """Start a motion to a share."""
        ...

    def closed_share(self) -> float:
        """Return the measured share."""
        ...


class _Fingers:
    """Fingers in shares of their travel, speed and force."""

    def __init__(self, port: GripperPort, tool: ToolSummary) -> None:
        self._port = port
        self._tool = tool

    def start(self, closed_share: float, *, speed_share: float, force_share: float) -> Motion:
        return self._port.close_to(
            width_m=(1.0 - closed_share) * self._tool.max_width_m,
            speed_m_s=speed_share * self._tool.max_speed_m_s,
            force_n=force_share * self._tool.max_force_n,
        )

    def closed_share(self) -> float:
        return 1.0 - self._port.sample().width_m / self._tool.max_width_m


class _SwitchedPort(Protocol):
    """The port of a tool that is on or off, and its measurement."""

    def switch(self, *, on: bool) -> Motion: ...

    def sample(self) -> _SwitchedSample: ...


class _SwitchedSample(Protocol):
    @property
    def on(self) -> bool: ...


class _Switch:
    """Implements `WorldToolDrive` for a tool that is on or off: closed is on."""

    def __init__(self, port: _SwitchedPort) -> None:
        self._port = port

    def start(self, closed_share: float, *, speed_share: float, force_share: float) -> Motion:
        return self._port.switch(on=closed_share >= _ON_SHARE)

    def closed_share(self) -> float:
        return float(self._port.sample().on)


class WorldTool:
    """Implements `ToolPlant`: what the tool holds, it holds by the contacts of the world."""

    def __init__(self, drive: WorldToolDrive) -> None:
        self._drive = drive
        self._motion: Motion | None = None
        self._moving: asyncio.Task[None] | None = None
        self._goal_share = -1.0

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        """Move, after the end of the present motion, which is cancelled."""
        self._begin((closed_share,), speed_share=speed_share, force_share=force_share)

    def stop(self) -> None:
        """Cancel the motion; the drive keeps its force."""
        self._begin((), speed_share=1.0, force_share=1.0)

    def home(self) -> None:
        """Close and open with the least force that the world's tool offers."""
        self._begin((1.0, 0.0), speed_share=1.0, force_share=0.1)

    def measured(self) -> ToolMeasurement:
        """Return the measured share; blocked is where it rests elsewhere than commanded."""
        share, moving = self._drive.closed_share(), self._moving is not None and not self._moving.done()
        off_target = self._goal_share >= 0.0 and abs(share - self._goal_share) > _THERE_SHARE
        return ToolMeasurement(closed_share=share, moving=moving, blocked=off_target and not moving)

    def _begin(self, goals: tuple[float, ...], *, speed_share: float, force_share: float) -> None:
        if self._moving is not None:
            self._moving.cancel()
        self._goal_share = goals[-1] if goals else self._goal_share
        execution = self._execute(goals, speed_share=speed_share, force_share=force_share)
        self._moving = asyncio.get_running_loop().create_task(execution)

    async def _execute(self, goals: tuple[float, ...], *, speed_share: float, force_share: float) -> None:
        if self._motion is not None:
            self._motion.cancel()
            await self._motion.report()
        for goal in goals:
            self._motion = self._drive.start(goal, speed_share=speed_share, force_share=force_share)
            await self._motion.report()


class WorldHand:
    """Implements `ToolPlant` for a hand with one motor, which follows a reference while that moves."""

    def __init__(self, port: SimHandPort) -> None:
        self._port = port
        self._motion: CommandedMotion | None = None
        self._goal_share = 0.0

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        """Move there from now on, as fast as the motor can, also in mid-motion."""
        self._goal_share = closed_share
        self._motion = self._port.follow(share=closed_share)

    def stop(self) -> None:
        """Wind no further; the tendon keeps its pull."""
        if self._motion is not None:
            self._motion.cancel()
        self._goal_share = self._port.sample().closed_share

    def home(self) -> None:
        """Open."""
        self.close_to(0.0)

    def measured(self) -> ToolMeasurement:
        """Return the wound-up share, and the pull on what is in the hand."""
        sample, motion = self._port.sample(), self._motion
        moving = motion is not None and not motion.ended
        return ToolMeasurement(
            closed_share=sample.closed_share,
            moving=moving,
            blocked=not moving and abs(sample.closed_share - self._goal_share) > _THERE_SHARE,
            force_share=sample.force_n / self._port.max_force_n,
        )


def tool_holds(world: SimWorld, arm: str, tool: ToolSummary) -> bool:
    """Return whether the tool on an arm holds a part in the world, by its contacts there."""
    summary, snapshot = world.host.summary, world.measured()
    state = state_publisher(tool.kind).state(snapshot.tool(arm), tool, parts=summary.parts)
    return isinstance(state, ToolHold) and state.held and state.part in summary.parts


def world_tool(world: SimWorld, arm: str, tool: ToolSummary) -> ToolPlant:
    """Return the tool on an arm of a world; raises CellError for one that cannot be moved from outside yet."""
    port = world.tool(arm, tool.kind)
    if tool.kind == "gripper":
        return WorldTool(_Fingers(cast("GripperPort", port), tool))
    if isinstance(port, SimHandPort):
        return WorldHand(port)
    if hasattr(port, "switch"):
        return WorldTool(_Switch(cast("_SwitchedPort", port)))
    hint = "emulate it alone: `flexcell emulate`, without the world"
    raise CellError(f"a tool of the kind {tool.kind} has no emulated device in a world yet", where=arm, hint=hint)
