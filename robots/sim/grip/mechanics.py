"""The mechanics interface of a tool in a simulated world: its drive, measurements and standing command."""

from __future__ import annotations

from typing import Protocol, cast

from robots.control.motion_event import AnyMotionEvent
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.tool_kinds import kind_of_mechanism, load_simulation


class ToolDrive(Protocol):
    """The motor or switch of a tool: executes one numbered motion at a time."""

    @property
    def number(self) -> int:
        """Number of the active motion, 0 for none."""
        ...

    def hold(self, number: int, *, request: int = 0) -> None:
        """Stop and keep the motion."""
        ...

    def resume(self, number: int, *, request: int = 0) -> None:
        """Resume."""
        ...

    def cancel(self, number: int) -> None:
        """Stop and end as CANCELED."""
        ...

    def stop(self, cause: str = "") -> None:
        """Cancel the active motion; a held object stays held. With a `cause` the motion fails."""
        ...


class ToolMechanics(Protocol):
    """One tool in the loop."""

    @property
    def drive(self) -> ToolDrive:
        """The drive that executes its motions."""
        ...

    def begin(self, motion: int, goal: tuple[float, ...]) -> None:
        """Start a motion towards a goal, as `MoveTool` has it."""
        ...

    def step(self, step_s: float) -> tuple[AnyMotionEvent, ...]:
        """Read the state, set motors and fields, return the events; called between the halves of a step."""
        ...

    def measured(self) -> tuple[float, ...]:
        """Return progress, three measurements and the touched bodies, as in `SnapshotLayout`."""
        ...

    def command(self) -> tuple[float, ...]:
        """Return at most `TOOL_FIELDS` numbers: the command that stays in force if its motion is cancelled now."""
        ...

    def take_over(self, command: tuple[float, ...]) -> None:
        """Adopt the command of an earlier instance of this tool."""
        ...


class MechanicsMaker(Protocol):
    """How a kind of tool moves in the loop."""

    def mechanics(self, arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics:
        """Return the mechanics of the tool on an arm; the tool keeps its state in `physics`."""
        ...


def new_mechanics(arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics | None:
    """Return the mechanics of an arm's tool, None for a bare flange."""
    tool = arm.model.tool
    if tool is None:
        return None
    maker = cast("MechanicsMaker", load_simulation(kind_of_mechanism(tool.kind).name))
    return maker.mechanics(arm, physics, contacts)
