"""What moves a tool in a simulated world, one for each kind: its drive, what it measures, what it goes on doing."""

from __future__ import annotations

from typing import Protocol

from robots.control.motion_event import AnyMotionEvent
from robots.sim.commands.world_commands import ToolCommand


class ToolDrive(Protocol):
    """The motor or switch of a tool: carries out one numbered motion at a time."""

    @property
    def number(self) -> int:
        """The motion under way, 0 when there is none."""
        ...

    def hold(self, number: int, *, request: int = 0) -> None:
        """Stop on the way."""
        ...

    def resume(self, number: int, *, request: int = 0) -> None:
        """Go on."""
        ...

    def cancel(self, number: int) -> None:
        """Stop and end as canceled."""
        ...

    def stop(self, cause: str = "") -> None:
        """Cancel whatever runs, what is held stays held; with a `cause` it ends as failed."""
        ...


class ToolMechanics(Protocol):
    """One tool in the loop."""

    @property
    def drive(self) -> ToolDrive:
        """What carries out its motions."""
        ...

    def begin(self, command: ToolCommand) -> None:
        """Start the motion of a command for this kind of tool; others are ignored."""
        ...

    def step(self, step_s: float) -> tuple[AnyMotionEvent, ...]:
        """Read the present state, set motors and fields, return what happened; called between the halves of a step."""
        ...

    def measured(self) -> tuple[float, ...]:
        """Return progress, three measures and the bodies touched, as `SnapshotLayout` has them."""
        ...

    def command(self) -> tuple[float, ...]:
        """Return at most `TOOL_FIELDS` numbers that say what it does when its motion is cancelled now."""
        ...

    def take_over(self, command: tuple[float, ...]) -> None:
        """Do from now on what another life of this tool did."""
        ...
