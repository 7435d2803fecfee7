"""A project folder for scripts and notebooks: its behaviors are loaded, checked, executed and replayed here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Self

from engine.authoring.python_file import load_python_behavior
from engine.bus import SkillBus
from engine.check import Finding, check_behavior, require_no_errors
from engine.document import Behavior, load_behavior
from engine.document.cell import Cell, load_cell
from engine.document.faults import load_faults
from engine.document.python_name import is_python_name
from engine.document.state_catalogue import StateCatalogue
from engine.project.cell_runner import CellSetup
from engine.project.headless_run import CompletedRun, outside_loop, plan_in_cell, run_headless, simulated_cell
from engine.project.run_request import RunRequest
from engine.recording import RecordingOptions, collect_documents, load_recording
from engine.registry import load_states
from engine.replay import ReplayReport, replay
from engine.runtime.record.recorder import Watcher


class Project:
    """The behaviors of a folder and the states that they may use; open it with `Project.open`.

    Args:
        folder: The folder; files are given relative to it.
        catalogue: The states.
    """

    def __init__(self, folder: Path, catalogue: StateCatalogue) -> None:
        self.folder = folder
        self.catalogue = catalogue

    @classmethod
    def open(cls, folder: Path | str = ".") -> Self:
        """Open a project folder: load the installed states and those of its `flexcell.yaml`.

        Raises:
            DocumentError: its project file is invalid.
        """
        return cls(Path(folder).resolve(), load_states(Path(folder)))

    def behavior(self, file: Path | str) -> Behavior:
        """Load a behavior: a document, or `FILE.py:NAME`, which executes that file.

        Raises:
            DocumentError: it cannot be read.
        """
        path = str(self.folder / file)
        return load_python_behavior(path) if is_python_name(path) else load_behavior(Path(path))

    def cell(self, file: Path | str) -> Cell:
        """Load a cell; raises DocumentError if it cannot be read."""
        return load_cell(self.folder / file)

    def check(
        self,
        behavior: Behavior | Path | str,
        *,
        cell: Cell | None = None,
        parameters: Mapping[str, object] | None = None,
    ) -> tuple[Finding, ...]:
        """Return the findings of a behavior; without any of severity `error` it can be executed.

        Args:
            behavior: The behavior or its file.
            cell: The cell in which it runs; by default the cell that it names.
            parameters: Parameters of its run.

        Raises:
            DocumentError: it cannot be read.
        """
        loaded = self._loaded(behavior)
        return check_behavior(loaded, self.catalogue, cell=cell, parameters=parameters or {})

    def run(
        self,
        behavior: Behavior | Path | str,
        *,
        parameters: Mapping[str, object] | None = None,
        inputs: Mapping[str, object] | None = None,
        seed: int | None = None,
        cell: Cell | None = None,
        simulate: Sequence[str] = (),
        store: Path | str | None = None,
        faults: Path | str | None = None,
        record: Path | str | None = None,
        journal: Path | str | None = None,
        prepare: Callable[[SkillBus], object] | None = None,
        watchers: Sequence[Watcher] = (),
    ) -> CompletedRun:
        """Execute a behavior to its end in virtual time, in the simulated cell; also in a notebook.

        Args:
            behavior: The behavior or its file.
            parameters: Values for its parameters.
            inputs: Initial userdata.
            seed: Seed of random choices and of the placement noise of parts; without a seed, no placement noise.
            cell: The cell in which it runs; by default the cell that it names.
            simulate: Devices of the cell that its world simulates instead of their drivers, or `all`.
            store: Replaces the store of the cell.
            faults: A fault document, relative to the project folder.
            record: MCAP file to which the run is recorded.
            journal: Folder in which its events are kept; by default they are not.
            prepare: Registers services and actions on an empty bus; then no cell is opened.
            watchers: Functions called with every event.

        Raises:
            FlexcellError: the behavior has errors, an argument is invalid, or the cell cannot be opened.
        """
        loaded = self._loaded(behavior)
        cell = simulated_cell(loaded, cell, simulate)
        require_no_errors(self.check(loaded, cell=cell))
        setup = CellSetup(
            cell=cell,
            seed=seed,
            store=str(store) if store is not None else None,
            journal=journal,
            prepare=prepare,
        )
        plan, setup = plan_in_cell(loaded, self.catalogue, setup)
        request = RunRequest(
            plan=plan,
            parameters=parameters or {},
            inputs=inputs or {},
            seed=seed or 0,
            faults=load_faults(self.folder / faults) if faults is not None else None,
        )
        if record is not None:
            documents = collect_documents(loaded, setup.cell)
            setup = replace(setup, recording=RecordingOptions(path=Path(record), documents=documents))
            request = replace(request, documents=documents)
        return run_headless(setup, request, watchers=watchers)

    def replay(self, recording: Path | str, *, behavior: Behavior | Path | str | None = None) -> ReplayReport:
        """Execute a recorded run again without robots and compare its events.

        Args:
            recording: The MCAP file.
            behavior: Another version of its behavior.

        Raises:
            FlexcellError: the recording or the behavior cannot be used.
        """
        changed = self._loaded(behavior) if behavior is not None else None
        recorded = load_recording(Path(recording))
        return outside_loop(lambda: replay(recorded, self.catalogue, behavior=changed))

    def _loaded(self, behavior: Behavior | Path | str) -> Behavior:
        return behavior if isinstance(behavior, Behavior) else self.behavior(behavior)
