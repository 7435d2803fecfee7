"""One run in virtual time from its start to its end, without a terminal: for tests, scripts and notebooks."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import TypeVar

from engine.clock import run_virtual
from engine.document import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.simulated_devices import with_simulated_devices
from engine.errors import DocumentError
from engine.event import Event
from engine.project.cell_runner import CellSetup, execute_within, open_cell_runner
from engine.project.run_request import RunRequest, require_simulation
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.runtime.record.recorder import Watcher
from engine.runtime.run_result import RunResult

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class CompletedRun:
    """An ended run: its result and all its events."""

    result: RunResult
    events: tuple[Event, ...]
    measures: Mapping[str, float] = field(default_factory=dict[str, float])
    """What the devices of the cell have summed up until its end, by name as in `engine.messages.measures`."""

    @property
    def outcome(self) -> str | None:
        """Its outcome; None if it was stopped or ended with an error."""
        return self.result.outcome


def simulated_cell(behavior: Behavior, cell: Cell | None, simulate: Sequence[str]) -> Cell | None:
    """Return the cell, by default the one that the behavior names, with these devices simulated; `cell` without any.

    Raises:
        DocumentError: there is no cell, it cannot be read, or it cannot simulate such a device.
    """
    if not simulate:
        return cell
    found = load_cell(behavior.cell_file) if cell is None and behavior.cell_file is not None else cell
    if found is None:
        raise DocumentError("the behavior names no cell to simulate", where=behavior.name, hint="give a cell")
    return with_simulated_devices(found, simulate)


def plan_in_cell(behavior: Behavior, catalogue: Catalogue, setup: CellSetup) -> tuple[Plan, CellSetup]:
    """Plan a behavior and return what is opened for its run: by default the cell that it names.

    Args:
        behavior: The behavior, checked, with its substitutes.
        catalogue: The states that it may use.
        setup: What is opened; on a bus that is prepared with fakes, no cell is opened.

    Raises:
        DocumentError: a document cannot be read.
        ControlError: it has substitutes, and a robot of the cell is real.
    """
    plan = new_plan(behavior, catalogue)
    if setup.prepare is not None:
        setup = replace(setup, cell=None)
    elif setup.cell is None and behavior.cell_file is not None:
        setup = replace(setup, cell=load_cell(behavior.cell_file))
    require_simulation(plan, setup.cell)
    return plan, setup


def run_headless(
    setup: CellSetup, request: RunRequest, *, watchers: Sequence[Watcher] = (), limit_s: float | None = None
) -> CompletedRun:
    """Open the cell, run to the end in virtual time, and close the cell.

    Args:
        setup: What is opened for the run.
        request: The run.
        watchers: Functions called with every event.
        limit_s: Seconds on its clock after which it is stopped.

    Raises:
        FlexcellError: the run was not started.
        VirtualTimeDeadlock: everything waits, and nothing can wake it.
    """
    events: list[Event] = []

    async def main() -> tuple[RunResult, dict[str, float]]:
        async with open_cell_runner(setup) as runner:
            prepared = await runner.start(request)
            for watcher in (events.append, *watchers):
                prepared.run.watch(watcher)
            result = await execute_within(limit_s, prepared)
            return result, runner.cell.measures()

    result, measures = outside_loop(lambda: run_virtual(main()))
    return CompletedRun(result=result, events=tuple(events), measures=measures)


def outside_loop(work: Callable[[], T]) -> T:
    """Return what `work` returns, which starts an event loop; on a thread in a notebook, where another one runs."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return work()
    with ThreadPoolExecutor(max_workers=1, thread_name_prefix="flexcell run") as thread:
        return thread.submit(work).result()
