"""The mechanics interface of a tool in a simulated world: its drive, measurements and standing command."""

from __future__ import annotations

from typing import Protocol

from robots.control.motion_event import AnyMotionEvent
from robots.sim.commands.world_commands import ToolCommand


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

    def begin(self, command: ToolCommand) -> None:
        """Start the motion of a command for this kind of tool; others are ignored."""
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
