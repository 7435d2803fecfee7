"""Runs a behavior headless in virtual time for a test; implements the pytest fixture `flexcell_run`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AsyncExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.check import check_behavior, require_no_errors
from engine.clock import new_clock, run_virtual
from engine.document import Behavior, load_behavior
from engine.document.cell import Cell, load_cell
from engine.document.faults import load_faults
from engine.event import Event
from engine.faults import FaultPort
from engine.project.run_factory import require_simulation
from engine.runtime.plan import Catalogue, new_plan
from engine.runtime.record.recorder import Watcher
from engine.runtime.record.skill_port import BusPort
from engine.runtime.run import Run, RunResult
from engine.testing.substitution import StandInFor, with_substitutes


@dataclass(frozen=True, kw_only=True)
class CompletedRun:
    """An ended run: its result and all its events."""

    result: RunResult
    events: tuple[Event, ...]

    @property
    def outcome(self) -> str | None:
        """Its outcome; None if it was stopped or ended with an error."""
        return self.result.outcome


class BehaviorRunner(Protocol):
    """The type of the fixture `flexcell_run`, see `run_behavior`."""

    def __call__(
        self,
        file: Path | str,
        *,
        parameters: Mapping[str, object] | None = None,
        inputs: Mapping[str, object] | None = None,
        seed: int | None = None,
        cell: Path | str | None = None,
        prepare: Callable[[SkillBus], object] | None = None,
        faults: Path | str | None = None,
        substitutes: Path | str | Mapping[str, StandInFor] | None = None,
        watchers: Sequence[Watcher] = (),
    ) -> CompletedRun:
        """Run a behavior to its end."""
        ...


def run_behavior(
    file: Path | str,
    *,
    catalogue: Catalogue,
    store: Path,
    parameters: Mapping[str, object] | None = None,
    inputs: Mapping[str, object] | None = None,
    seed: int | None = None,
    cell: Path | str | None = None,
    prepare: Callable[[SkillBus], object] | None = None,
    faults: Path | str | None = None,
    substitutes: Path | str | Mapping[str, StandInFor] | None = None,
    watchers: Sequence[Watcher] = (),
) -> CompletedRun:
    """Run a behavior file to its end in virtual time.

    Args:
        file: The behavior.
        catalogue: The states that it may use.
        store: The store file of the run, so that tests do not modify the cell's store.
        parameters: Values for its parameters.
        inputs: Initial userdata.
        seed: Seed of random choices and of the placement noise of parts; without a seed, no placement noise.
        cell: The cell in which it runs; by default the cell that the behavior names.
        prepare: Registers fakes of a test on an empty bus; then no cell is opened.
        faults: A fault document.
        substitutes: Substitutes of nodes: a substitutes document, or by path pattern an outcome, an
            `Ending`, a list of these for one activation after the other, or a state class.
        watchers: Functions called with every event, such as a coverage collector.

    Raises:
        DocumentError: the behavior has errors, or an argument is invalid for it.
        ControlError: it has substitutes, and a robot of the cell is real.
    """
    behavior = load_behavior(Path(file))
    given = load_cell(Path(cell)) if cell is not None else None
    require_no_errors(check_behavior(behavior, catalogue, cell=given))
    if substitutes is not None:
        behavior = with_substitutes(behavior, substitutes)
    plan = new_plan(behavior, catalogue)
    place = (given or _own_cell(behavior)) if prepare is None else None
    require_simulation(plan, place)
    document = load_faults(Path(faults)) if faults is not None else None
    events: list[Event] = []

    async def main() -> RunResult:
        async with AsyncExitStack() as stack:
            if prepare is not None:
                bus = await stack.enter_async_context(SkillBus(new_clock()))
                prepare(bus)
            else:
                opened = OpenCell(place, seed=seed, store_path=str(store))
                bus = (await stack.enter_async_context(opened)).bus
            run = Run(
                plan,
                run=behavior.name,
                bus=bus,
                parameters=parameters,
                inputs=inputs,
                seed=seed or 0,
                skills=FaultPort(BusPort(bus), document, clock=bus.clock, seed=seed or 0) if document else None,
            )
            for watcher in (events.append, *watchers):
                run.watch(watcher)
            return await run.execute()

    return CompletedRun(result=run_virtual(main()), events=tuple(events))


def _own_cell(behavior: Behavior) -> Cell | None:
    return load_cell(behavior.cell_file) if behavior.cell_file is not None else None
