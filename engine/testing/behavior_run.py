"""Runs a behavior headless in virtual time for a test; implements the pytest fixture `flexcell_run`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from engine.bus import SkillBus
from engine.check import check_behavior, require_no_errors
from engine.document import load_behavior
from engine.document.cell import load_cell
from engine.document.faults import load_faults
from engine.project.cell_runner import CellSetup
from engine.project.headless_run import CompletedRun, plan_in_cell, run_headless, simulated_cell
from engine.project.run_request import RunRequest
from engine.runtime.plan import Catalogue
from engine.runtime.record.recorder import Watcher
from engine.testing.substitution import StandInFor, with_substitutes


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
        simulate: Sequence[str] = (),
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
    simulate: Sequence[str] = (),
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
        simulate: Devices of the cell that its world simulates instead of their drivers, or `all`.
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
    given = simulated_cell(behavior, load_cell(Path(cell)) if cell is not None else None, simulate)
    require_no_errors(check_behavior(behavior, catalogue, cell=given))
    if substitutes is not None:
        behavior = with_substitutes(behavior, substitutes)
    setup = CellSetup(cell=given, seed=seed, store=str(store), prepare=prepare)
    plan, setup = plan_in_cell(behavior, catalogue, setup)
    request = RunRequest(
        plan=plan,
        parameters=parameters or {},
        inputs=inputs or {},
        seed=seed or 0,
        faults=load_faults(Path(faults)) if faults is not None else None,
        run_id=behavior.name,
    )
    return run_headless(setup, request, watchers=watchers)
