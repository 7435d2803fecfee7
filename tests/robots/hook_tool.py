"""A kind of tool that only tests know: a hook that turns by a switch, from its mechanism to its states, in one file."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, cast

import numpy as np
from msgspec import Meta
from msgspec.structs import replace

from engine.bus import ActiveGoal, SkillBus
from engine.cell import ToolKind
from engine.messages import Message
from engine.skill import Action
from engine.state import Context, Outcome, State
from robots.control.commanding.motion_registry import CommandedMotion
from robots.control.motion_event import AnyMotionEvent
from robots.control.tool_drives.grip_task import TaskDrive
from robots.gripper import ToolServer
from robots.gripper.tool_motion import ToolMotion
from robots.model.mechanism import Mechanism, Positive, Text
from robots.model.tool_model import ToolModel
from robots.port import Array, GraspCommand
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.sim.physics.tool_body import Indices, as_indices
from robots.sim.ports.tool_ports import ToolLine
from robots.sim.world.sim_world import SimWorld
from robots.standard_tools.tool_simulation import ToolSimulation

HookName = Annotated[
    str, Meta(min_length=1, description="The arm that carries the hook", extra_json_schema={"cell_name": "hook"})
]


class HookModel(Mechanism, frozen=True, kw_only=True, tag="hook"):
    """A hook that needs `turn_s` to turn."""

    tip_link: Text
    turn_s: Positive

    def link_names(self) -> tuple[str, ...]:
        return (self.tip_link,)

    def with_prefix(self, prefix: str) -> HookModel:
        return replace(self, tip_link=prefix + self.tip_link)


class HookState(Message, frozen=True, kw_only=True):
    """Whether the hook is turned; what it then holds it does not see."""

    time_s: float
    held: bool


class HookTurn(Action[HookState, HookState], frozen=True, kw_only=True):
    """Turn the hook in or out."""

    hooked: bool


class _HookStep(State, frozen=True, kw_only=True):
    hook: HookName
    part: Annotated[str, Meta(description="Name of the part in messages")] = ""

    def resources(self) -> tuple[str, ...]:
        return (f"{self.hook}/hook",)

    async def turn(self, ctx: Context, *, hooked: bool) -> bool:
        end = await ctx.perform(HookTurn(hooked=hooked), to=f"{self.hook}/hook")
        return end.result is not None and end.result.held is hooked


class Catch(_HookStep, frozen=True, kw_only=True):
    """Turn the hook in."""

    state_name: ClassVar[str] = "hook.Catch"
    outcomes: ClassVar[tuple[str, ...]] = ("held", "missed", "failed")
    success: ClassVar[tuple[str, ...]] = ("held",)

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("held" if await self.turn(ctx, hooked=True) else "missed")


class Drop(_HookStep, frozen=True, kw_only=True):
    """Turn the hook out."""

    state_name: ClassVar[str] = "hook.Drop"
    outcomes: ClassVar[tuple[str, ...]] = ("dropped", "failed")
    success: ClassVar[tuple[str, ...]] = ("dropped",)

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("dropped" if await self.turn(ctx, hooked=False) else "failed")


class CheckHeld(_HookStep, frozen=True, kw_only=True):
    """Check whether the hook is turned in."""

    state_name: ClassVar[str] = "hook.CheckHeld"
    outcomes: ClassVar[tuple[str, ...]] = ("held", "lost")
    success: ClassVar[tuple[str, ...]] = ("held",)

    async def run(self, ctx: Context) -> Outcome:
        measured = await ctx.latest(f"{self.hook}/hook/state", HookState)
        return Outcome("held" if measured.held else "lost")


@dataclass(frozen=True, kw_only=True)
class HookIndices:
    """A hook has no joints."""

    model: HookModel
    qpos: Indices
    home: Array


class HookMechanics(TaskDrive):
    """Implements `ToolMechanics` and its drive: the hook turns in its time, and touches nothing."""

    def __init__(self, turn_s: float) -> None:
        super().__init__()
        self._turn_s = turn_s
        self._hooked = False
        self._since_s = 0.0

    @property
    def drive(self) -> TaskDrive:
        return self

    def begin(self, motion: int, goal: tuple[float, ...]) -> None:
        (hooked,) = goal
        self._hooked, self._since_s = hooked > 0.0, 0.0
        self._task.start(motion, patience_s=self._turn_s + 1.0)

    def step(self, step_s: float) -> tuple[AnyMotionEvent, ...]:
        self._since_s += step_s
        done = self._since_s >= self._turn_s
        return self._task.judge(step_s, still=done, reached=done, progress=self._progress, late=lambda _: "it jams")

    def measured(self) -> tuple[float, ...]:
        return self._progress(), float(self._hooked), 0.0, 0.0

    def command(self) -> tuple[float, ...]:
        return (float(self._hooked),)

    def take_over(self, command: tuple[float, ...]) -> None:
        self._hooked = command[0] > 0.0

    def _progress(self) -> float:
        return min(1.0, self._since_s / self._turn_s)


class HookPort:
    """The port of a simulated hook."""

    def __init__(self, line: ToolLine) -> None:
        self.line = line

    def turn(self, *, hooked: bool) -> CommandedMotion:
        return self.line.start(self.line.number(), (float(hooked),))


class HookServer:
    """Implements `ToolServer` for a hook."""

    def __init__(self, name: str, port: HookPort) -> None:
        self.name = name
        self.grip: GraspCommand | None = None
        self._port = port
        self._motion = ToolMotion(device=name, words="the hook")

    @property
    def moving(self) -> bool:
        return self._motion.moving

    def register(self, bus: SkillBus) -> None:
        bus.advertise_action(HookTurn, self._turn, namespace=self.name, exclusive=self.name)

    async def stop(self) -> None:
        await self._motion.stop()

    async def _turn(self, goal: HookTurn, handle: ActiveGoal[HookState]) -> HookState:
        handle.accept()
        await self._motion.carry_out(lambda: self._port.turn(hooked=goal.hooked), handle, lambda: None)
        return hook_state(self._port.line.reading())


def hook_state(reading: ToolReading) -> HookState:
    return HookState(time_s=reading.time_s, held=reading.values[0] > 0.0)


class HookSimulation:
    """Implements `ToolSimulation` for hooks; their bodies are those of the URDF."""

    def finish(self, spec: Any, tool: ToolModel) -> None:
        return

    def indices(self, model: Any, arm: str, tool: ToolModel, *, ferrous: Iterable[str]) -> HookIndices:
        return HookIndices(model=tool.mechanism_as(HookModel), qpos=as_indices(()), home=np.zeros(0))

    def mechanics(self, arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics:
        assert isinstance(arm.tool, HookIndices)
        return HookMechanics(arm.tool.model.turn_s)

    def summary(self, tool: ToolModel) -> ToolSummary:
        return ToolSummary(kind="hook", contacts=0)

    def port(self, line: ToolLine) -> HookPort:
        return HookPort(line)

    def state(self, reading: ToolReading, tool: ToolSummary, *, parts: Collection[str]) -> HookState:
        return hook_state(reading)

    def server(self, name: str, world: SimWorld, arm: str) -> ToolServer:
        return HookServer(name, cast("HookPort", world.tool(arm, "hook")))


HOOK_SIMULATION: ToolSimulation = HookSimulation()
HOOK = ToolKind(
    name="hook",
    measured=HookState,
    hold=Catch.state_name,
    release=Drop.state_name,
    check=CheckHeld.state_name,
    mechanisms={"hook": "tests.robots.hook_tool:HookModel"},
    simulation="tests.robots.hook_tool:HOOK_SIMULATION",
    states=(Catch, Drop, CheckHeld),
)
