"""What the dashboard asks of the engine to operate runs: control, operators, hot change, resuming."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Protocol

from engine.cell.cell_connection import CellConnection
from engine.runtime.control import Breakpoint, Control
from engine.runtime.history.hot_change import ChangeReport


class OperatorAttachment(Protocol):
    """One operator of one run."""

    def detach(self) -> None:
        """Leave on purpose; may be called again."""
        ...

    def lose(self) -> None:
        """Tell that this operator cannot be reached any more."""
        ...


class InterruptedRun(Protocol):
    """A run of the journal whose engine died."""

    @property
    def id(self) -> str:
        """The run's id."""
        ...

    @property
    def behavior(self) -> str:
        """The name of its behavior."""
        ...

    @property
    def started_unix_s(self) -> float:
        """Wall time of the start, seconds since 1970."""
        ...

    @property
    def last_seq(self) -> int:
        """The number of its last durable event."""
        ...


class RunOperations(Protocol):
    """The part of the backend that changes what runs do."""

    def control(self, run_id: str) -> Control:
        """Return what an operator can do with a run.

        Raises:
            ControlError: it is over.
            FlexcellError: the id names none.
        """
        ...

    def operate(self, run_id: str) -> OperatorAttachment:
        """Be an operator of a run from now on.

        Raises:
            ControlError: it is over.
            FlexcellError: the id names none.
        """
        ...

    async def change(self, run_id: str, *, preempt: bool = False) -> ChangeReport:
        """Let the behavior as its file is now take the place of the one that a paused run executes.

        With `preempt`, what is active and cannot go on as it is is preempted.

        Raises:
            ControlError: the run cannot go on in the new version; it goes on as it is.
            FlexcellError: the file has errors.
        """
        ...

    async def step_back(self, run_id: str, path: str = "") -> tuple[str, ...]:
        """Take back what a paused run has begun last, in one branch; returns what is undone, in order.

        Raises:
            ControlError: the run is over, is not paused, or something cannot be undone; nothing has moved.
            FlexcellError: the id names none, or its journal cannot be read.
        """
        ...

    def breakpoints(self, behavior_id: str) -> tuple[Breakpoint, ...]:
        """Return the breakpoints beside a behavior's file; raises FlexcellError when the id names none."""
        ...

    def keep_breakpoints(self, behavior_id: str, breakpoints: Iterable[Breakpoint]) -> None:
        """Write the breakpoints beside a behavior's file; raises FlexcellError when the id names none."""
        ...

    async def stop_all(self, *, reason: str) -> None:
        """Ask every run to stop, cancel every goal, and return when every robot is at rest.

        Raises:
            FlexcellError: a robot could not confirm it; the others were stopped all the same.
        """
        ...

    @property
    def cell_connection(self) -> CellConnection:
        """Whether every device of the cell is connected."""
        ...

    async def connect_cell(self) -> None:
        """Connect again what is lost of the cell; does nothing where nothing is.

        Raises:
            ControlError: a run is under way.
            FlexcellError: a device does not come back.
        """
        ...

    def interrupted(self) -> tuple[InterruptedRun, ...]:
        """Return the runs whose engine died, oldest first."""
        ...

    async def resume(self, run_id: str, *, answers: Mapping[str, str] | None = None, changed: bool = False) -> str:
        """Go on with an interrupted run and return its id.

        Raises:
            ControlError: it cannot go on, or states that were in mid-work ask.
            FlexcellError: the id names none.
        """
        ...
