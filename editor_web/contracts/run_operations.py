"""Protocols for operating runs: control, operators, hot change and resume."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Protocol

from engine.cell.cell_connection import CellConnection
from engine.runtime.control import Breakpoint, Control
from engine.runtime.history.hot_change import ChangeReport


class OperatorAttachment(Protocol):
    """One operator of one run."""

    def detach(self) -> None:
        """Detach deliberately; may be called again."""
        ...

    def lose(self) -> None:
        """Report that this operator is no longer reachable."""
        ...


class InterruptedRun(Protocol):
    """A run of the journal whose engine ended without ending the run."""

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
    """The part of the backend that operates runs."""

    def control(self, run_id: str) -> Control:
        """Return the control of a run.

        Raises:
            ControlError: the run has ended.
            FlexcellError: there is no run with this id.
        """
        ...

    def operate(self, run_id: str) -> OperatorAttachment:
        """Attach an operator to a run.

        Raises:
            ControlError: the run has ended.
            FlexcellError: there is no run with this id.
        """
        ...

    async def change(self, run_id: str, *, preempt: bool = False) -> ChangeReport:
        """Replace the behavior of a paused run by the current version of its file.

        With `preempt`, active nodes that cannot continue in the new version are preempted.

        Raises:
            ControlError: the run cannot continue in the new version; it keeps the old one.
            FlexcellError: the file has errors.
        """
        ...

    async def step_back(self, run_id: str, path: str = "") -> tuple[str, ...]:
        """Undo the last activation of a paused run, in one branch; returns the paths that are undone, in order.

        Raises:
            ControlError: the run has ended, is not paused, or something cannot be undone; nothing has moved.
            FlexcellError: there is no run with this id, or its journal cannot be read.
        """
        ...

    def breakpoints(self, behavior_id: str) -> tuple[Breakpoint, ...]:
        """Return the breakpoints stored with a behavior; raises FlexcellError if there is no such behavior."""
        ...

    def keep_breakpoints(self, behavior_id: str, breakpoints: Iterable[Breakpoint]) -> None:
        """Store the breakpoints with a behavior; raises FlexcellError if there is no such behavior."""
        ...

    async def stop_all(self, *, reason: str) -> None:
        """Request the stop of every run, cancel every goal, and return when every robot is at rest.

        Raises:
            FlexcellError: a robot did not confirm the stop; the others were stopped.
        """
        ...

    @property
    def cell_connection(self) -> CellConnection:
        """Whether every device of the cell is connected."""
        ...

    async def connect_cell(self) -> None:
        """Reconnect the lost devices of the cell; no effect if none is lost.

        Raises:
            ControlError: a run is active.
            FlexcellError: a device does not reconnect.
        """
        ...

    def interrupted(self) -> tuple[InterruptedRun, ...]:
        """Return the interrupted runs, oldest first."""
        ...

    async def resume(self, run_id: str, *, answers: Mapping[str, str] | None = None, changed: bool = False) -> str:
        """Resume an interrupted run and return its id.

        Raises:
            ControlError: the run cannot resume, or states that were active need an answer.
            FlexcellError: there is no run with this id.
        """
        ...
