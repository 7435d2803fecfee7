"""A session: an open cell, the behaviors of a project, and any number of runs and operators at once."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import msgspec

from engine.archive import Archive
from engine.bus.json_bus import JsonBus, LocalJsonBus
from engine.cell.cell_connection import CellConnection
from engine.cell.open_cell import OpenCell
from engine.document import Behavior
from engine.document.faults import Faults
from engine.document.substitutes import Substitutes
from engine.editing import DocumentRepository
from engine.errors import ControlError, FlexcellError
from engine.event import Event
from engine.journal import Journal, list_runs
from engine.library.behavior_library import BehaviorView
from engine.project.bus_inspector import BusInspector
from engine.project.cell_reopening import CellReopening
from engine.project.cell_runner import CellRunner, PreparedRun
from engine.project.resume_plan import plan_resume
from engine.project.run_request import (
    RunPosition,
    RunRequest,
    StartData,
    paused_before,
    require_names,
    require_same_devices,
    require_simulation,
    start_data,
    start_of,
)
from engine.project.session_entries import StoredEntries
from engine.project.session_operators import OperatorRoster, RunOperator
from engine.project.session_recordings import SessionRecordings
from engine.project.session_run import InterruptedRun, SessionRun, forget_oldest, interrupted_run, known_run
from engine.project.session_stops import SessionStops
from engine.project.stop_recovery import StopRecovery
from engine.recording import RecordedDocuments
from engine.recording.recorded_run import read_run, version_snapshot
from engine.runtime.control import Breakpoint, Control, load_breakpoints, save_breakpoints
from engine.runtime.history.hot_change import ChangeReport
from engine.runtime.history.live_run import LiveRun, LiveRunChange
from engine.runtime.history.run_view import RunView
from engine.runtime.history.userdata_history import UserdataHistory
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.runtime.run_options import RunOptions

RunCallback = Callable[[LiveRun, LiveRunChange], None]


class Session:
    """The model of the dashboard; belongs to the event loop that creates it. `recordings` records its runs."""

    def __init__(
        self,
        cell: OpenCell,
        *,
        project: Path,
        catalogue: Catalogue,
        journal: Journal,
        recordings: SessionRecordings | None = None,
        reopening: CellReopening | None = None,
    ) -> None:
        self.cell = cell
        self.reopening = reopening or CellReopening(cell.document)
        self._entries = StoredEntries(cell)
        self.documents = DocumentRepository(project, catalogue, stored=self._entries.of_cell, cell=cell.document)
        self._library = self.documents.library
        self.archive = Archive(project, catalogue, journal.path)
        self._journal = journal
        self._recordings = recordings
        self._runner = CellRunner(cell, journal, recorder=recordings)
        self._runs: dict[str, SessionRun] = {}
        self._callbacks: tuple[RunCallback, ...] = ()
        self._operators = OperatorRoster()
        self._stops = SessionStops(cell, self._runs)
        self.reopening.refuse_while(self._stops.activity)
        self.recovery = StopRecovery(cell, self._stops)

    async def __aenter__(self) -> Self:
        await self._entries.open()
        self._stops.begin()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop every run and wait until its robots are at rest."""
        self._stops.end()
        for started in self._runs.values():
            started.run.stop("the session was closed")
        tasks = [started.task for started in self._runs.values() if started.task is not None]
        if tasks:
            await asyncio.wait(tasks)
        await self._stops.released()
        if self._recordings is not None:
            await self._recordings.close()
        self._entries.close()

    @property
    def bus(self) -> JsonBus:
        """The cell's bus, by name and JSON."""
        return LocalJsonBus(self.cell.bus)

    @property
    def inspector(self) -> BusInspector:
        """The cell's bus, for a person at a screen."""
        return BusInspector(self.cell.bus)

    @property
    def cell_name(self) -> str:
        """Name of the connected cell."""
        return self.cell.name

    def behaviors(self) -> tuple[BehaviorView, ...]:
        """Return all behaviors of the project, sorted by id."""
        return self._library.views()

    def behavior(self, behavior_id: str) -> BehaviorView:
        """Return one behavior; raises DocumentError if there is no such behavior."""
        return self._library.view(behavior_id)

    def runs(self) -> tuple[RunView, ...]:
        """Return the runs of this session, newest first."""
        return tuple(started.view() for started in reversed(self._runs.values()))

    def run(self, run_id: str) -> RunView:
        """Return one run; raises FlexcellError if there is no such run."""
        return known_run(self._runs, run_id).view()

    async def start(
        self,
        behavior_id: str,
        *,
        parameters: Mapping[str, object],
        seed: int,
        inputs: Mapping[str, object] | None = None,
        supervision: RunOptions | None = None,
        breakpoints: bool = False,
        begin: RunPosition | None = None,
        until: str | None = None,
        faults: Faults | None = None,
    ) -> str:
        """Start a run, and return its id; refused while the cell is stopped, see `recovery`.

        Args:
            behavior_id: Id of the behavior.
            parameters: Values for its parameters; with `begin`, those of that run are the default.
            seed: Seed of its random numbers.
            inputs: Initial values of userdata keys.
            supervision: Autonomy, whether an operator is demanded, time-outs.
            breakpoints: Whether to use the breakpoints file of the behavior.
            begin: Where to start instead of at the beginning; the cell is not restored, and `inputs` replace values.
            until: A node before which it pauses once.
            faults: Faults injected into this run only.

        Raises:
            FlexcellError: the behavior has errors, a parameter is invalid, the cell is stopped (ControlError), or the
                journal cannot be written (JournalError); the run has then failed.
        """
        behavior, plan = await asyncio.to_thread(self._planned, behavior_id)
        await asyncio.to_thread(self._library.require_fit, behavior_id)
        watched = supervision or RunOptions()
        if breakpoints:
            watched = msgspec.structs.replace(watched, breakpoints=load_breakpoints(behavior.file))
        watched = paused_before(plan, watched, until)
        start = None
        if begin is not None:
            start = await asyncio.to_thread(start_of, self._journal.path, begin, plan, self.cell.document)
            parameters = start.parameters(plan, parameters)
            start, inputs = start.with_userdata(plan, inputs or {}), {}
        if self.cell.document is not None:
            await asyncio.to_thread(require_names, behavior, self._library.catalogue, self.cell.document, parameters)
        request = RunRequest(
            plan=plan,
            parameters=parameters,
            inputs=inputs or {},
            seed=seed,
            supervision=watched,
            faults=faults,
            start=start,
            documents=await self._recorded_documents(behavior),
        )
        await self._stops.require_released()
        prepared = await self._runner.start(request)
        self._stops.note_start(begin.run if begin is not None else None)
        run_id = self._add(behavior_id, prepared)
        await prepared.entered()
        return run_id

    async def start_data(self, behavior_id: str, path: str) -> StartData:
        """Return the data with which a run of a behavior can start at a node: of the last run that entered it."""
        _, plan = await asyncio.to_thread(self._planned, behavior_id)
        return await asyncio.to_thread(start_data, self._journal.path, plan, path)

    def interrupted(self) -> tuple[InterruptedRun, ...]:
        """Return the runs of the journal whose process died, oldest first."""
        return tuple(interrupted_run(each) for each in list_runs(self._journal.path) if each.interrupted)

    async def resume(self, run_id: str, *, answers: Mapping[str, str] | None = None, changed: bool = False) -> str:
        """Resume an interrupted run of this project and cell, and return its id; refused while the cell is stopped.

        A simulated world is restored unless another run is active.

        Raises:
            ResumeDecisionRequired: states that were active require a decision.
            FlexcellError: the run cannot be resumed here.
        """
        found = await asyncio.to_thread(read_run, self._journal.path, run_id)
        behavior_id = self._library.id_of(Path(found.origin.behavior))
        if found.origin.cell != self._cell_file():
            there = found.origin.cell or "no cell"
            raise ControlError(f"this run was executed in {there}", where=run_id, hint="serve that cell")
        require_same_devices(found, self.cell.document)
        catalogue = self._library.catalogue
        behavior, plan = await asyncio.to_thread(self._planned, behavior_id, found.substitutes)
        require_simulation(plan, self.cell.document)
        # Before the decision whether the world is restored: another run may start in between.
        documents = await self._recorded_documents(behavior)
        await self._stops.require_released()
        alone = all(started.result is not None for started in self._runs.values())
        resumption = plan_resume(
            found,
            plan,
            catalogue=catalogue,
            answers=answers,
            changed=changed,
            restore=alone and found.origin.seed == self.cell.seed,
        )
        watched = RunOptions(autonomy=resumption.autonomy, demand_operator=found.origin.demand_operator)
        prepared = await self._runner.resume(resumption, supervision=watched, documents=documents)
        return self._add(behavior_id, prepared, events=found.events)

    def executes_classes_of(self, modules: Collection[str]) -> bool:
        """Return whether a run that has not ended has states of these modules."""
        return any(started.executes_classes_of(modules) for started in self._runs.values())

    def control(self, run_id: str) -> Control:
        """Return the control interface of an active run.

        Raises:
            ControlError: the run has ended.
            FlexcellError: there is no such run.
        """
        started = known_run(self._runs, run_id)
        if started.run.ended:
            raise ControlError("this run is over", where=run_id)
        return started.run.control

    def operate(self, run_id: str) -> RunOperator:
        """Attach an operator to a run, until `detach` or `lose` of the result; any number of operators may be attached.

        Raises:
            ControlError: the run has ended.
            FlexcellError: there is no such run.
        """
        return self._operators.attach(run_id, self.control(run_id))

    async def change(self, run_id: str, *, preempt: bool = False) -> ChangeReport:
        """Replace the behavior of a paused run with the current content of its file; see `Run.change`.

        Raises:
            ControlError: the run cannot continue in the new version; it is unchanged.
            DocumentError: the file cannot be read or has errors.
        """
        self.control(run_id)
        started = known_run(self._runs, run_id)
        behavior, plan = await asyncio.to_thread(self._planned, started.behavior_id, started.run.plan.substitutes)
        kept = await asyncio.to_thread(version_snapshot, behavior)
        self.control(run_id)
        return started.run.change(plan, preempt=preempt, kept=kept)

    async def step_back(self, run_id: str, path: str = "") -> tuple[str, ...]:
        """Undo the last step of a paused run; see `engine.runtime.run.Run.step_back`.

        Raises:
            ControlError: the run has ended, is not paused, or a step cannot be undone; nothing has moved.
            JournalError: its journal cannot be read.
        """
        self.control(run_id)
        return await known_run(self._runs, run_id).run.step_back(path)

    def _planned(self, behavior_id: str, substitutes: Substitutes | None = None) -> tuple[Behavior, Plan]:
        """Read, check and plan a behavior, on a thread because it may be large."""
        behavior = self._library.behavior(behavior_id).with_substitutes(substitutes)
        return behavior, new_plan(behavior, self._library.catalogue)

    async def stop(self, run_id: str, *, reason: str) -> None:
        """Request a run to stop and return immediately; has no effect on a run that has ended."""
        known_run(self._runs, run_id).stop(reason)

    async def stop_all(self, *, reason: str) -> None:
        """Stop every run, cancel every goal of any client, and return when every robot is at rest.

        With a stop relay, the devices accept no motion until every run has ended. No run starts before the release.

        Raises:
            RobotError: a robot did not confirm; the others are stopped nevertheless, and stay latched.
        """
        await self._stops.stop_all(reason=reason)

    @property
    def cell_connection(self) -> CellConnection:
        """Whether every device of the cell is connected."""
        return self.cell.connection

    async def connect_cell(self) -> None:
        """Reconnect lost devices of the cell; has no effect if none is lost.

        Raises:
            ControlError: a run is active.
            RobotError: a device cannot be reconnected.
        """
        for run_id, started in self._runs.items():
            if started.result is None and not self.cell.connection.connected:
                raise ControlError("a run is active", where=run_id, hint="stop it first, then connect the cell")
        await self.cell.reconnect()

    def breakpoints(self, behavior_id: str) -> tuple[Breakpoint, ...]:
        """Return the breakpoints of a behavior, from the file next to it.

        Raises:
            DocumentError: there is no such behavior, or its breakpoints file is invalid.
        """
        return load_breakpoints(self._library.file_of(behavior_id))

    def keep_breakpoints(self, behavior_id: str, breakpoints: Iterable[Breakpoint]) -> None:
        """Write the breakpoints file of a behavior; raises DocumentError if there is no such behavior."""
        save_breakpoints(self._library.file_of(behavior_id), breakpoints)

    async def wait(self, run_id: str) -> RunView:
        """Wait until a run has ended and return it."""
        started = known_run(self._runs, run_id)
        if started.task is not None:
            await asyncio.wait({started.task})
        return self.run(run_id)

    def subscribe(self, callback: RunCallback) -> Callable[[], None]:
        """Call `callback` with the run and what changed, for every event of a run; returns what unsubscribes."""
        self._callbacks = (*self._callbacks, callback)
        return lambda: self._unsubscribe(callback)

    def events(self, run_id: str, *, after: int = 0) -> list[Event]:
        """Return the events of a run with `seq` > `after`, in order."""
        return self.live(run_id).events[after:]  # `seq` counts from 1 without gaps

    def live(self, run_id: str) -> LiveRun:
        """Return the state of a run, which is kept up to date; raises FlexcellError if there is no such run."""
        return known_run(self._runs, run_id).live

    def userdata(self, run_id: str) -> UserdataHistory:
        """Return an empty userdata history of a run, to be filled from its events; raises FlexcellError."""
        run = known_run(self._runs, run_id).run
        return UserdataHistory(lambda: run.plan)

    def recording_files(self, run_id: str) -> tuple[Path, ...]:
        """Return the recordings of a run, oldest first, also of an active run; `run_id` may be a recording's path.

        Empty if the run was not recorded. Thread-safe.

        Raises:
            RecordingError: there is no recording at that path in the project.
        """
        if run_id.endswith((".mcap", ".mcap.part")):
            return (self.archive.recording_file(run_id),)
        return self._recordings.files(run_id) if self._recordings is not None else ()

    def latest(self, topic: str) -> object | None:
        """Return the latest message of a bus topic, or None."""
        try:
            return self.cell.bus.find_topic(topic).latest
        except FlexcellError:
            return None  # this cell has no such topic, which is not an error of the viewer

    def subscribe_topic(self, topic: str, callback: Callable[[Any], None]) -> Callable[[], None]:
        """Call back with every new message of a topic, beginning immediately with the latest one.

        Raises:
            BusError: this cell has no such topic.
        """
        found = self.cell.bus.find_topic(topic)
        if found.latest is not None:
            callback(found.latest)
        return found.subscribe(callback).close

    async def _recorded_documents(self, behavior: Behavior) -> RecordedDocuments | None:
        """Prepare a recording before its run exists, whose clock starts then; None if it is not recorded."""
        return await self._recordings.prepare(behavior, cell=self.cell) if self._recordings is not None else None

    def _publish(self, live: LiveRun, event: Event) -> None:
        change = live.apply(event)
        if change is None:
            return
        for callback in self._callbacks:
            callback(live, change)

    def _add(self, behavior_id: str, prepared: PreparedRun, *, events: Iterable[Event] = ()) -> str:
        run = prepared.run
        started = SessionRun(behavior_id, prepared, events=events)
        self._runs[run.id] = started
        run.watch(lambda event: self._publish(started.live, event))
        started.task = asyncio.create_task(started.execute(), name=f"session run {run.id}")
        forget_oldest(self._runs)
        return run.id

    def _cell_file(self) -> str | None:
        return str(self.cell.document.file.resolve()) if self.cell.document is not None else None

    def _unsubscribe(self, callback: RunCallback) -> None:
        self._callbacks = tuple(known for known in self._callbacks if known is not callback)
