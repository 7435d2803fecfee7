"""The composition root of runs: each run of this project gets its cell, bus, journal, recording and faults here."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from engine.bus import SkillBus
from engine.cell.cell_store import absolute_address
from engine.cell.open_cell import OpenCell
from engine.clock import new_clock
from engine.document.cell import Cell
from engine.document.faults import Faults
from engine.errors import ControlError, JournalError
from engine.faults import FaultPort
from engine.journal import Journal, JournalPort, NullJournal, RunJournal, RunOrigin
from engine.project.resume_plan import ResumePlan, plan_again
from engine.project.run_recorder import RunRecorder, RunStartRecord, open_recorder
from engine.project.run_request import RunRequest
from engine.recording import RecordedDocuments, RecordingOptions
from engine.recording.recorded_run import document_snapshot, read_run
from engine.runtime.plan import Plan
from engine.runtime.record.skill_port import BusPort
from engine.runtime.run import Run
from engine.runtime.run_id import new_run_id
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult
from engine.skills.devices import EnableDevice
from engine.stop import StopRelay


@dataclass(frozen=True, kw_only=True)
class CellSetup:
    """What is opened for runs, and closed after them."""

    cell: Cell | None = None
    """The cell; without it, an empty bus."""
    seed: int | None = None
    """Seed of the random part poses of a simulated world; None for the nominal poses."""
    store: str | None = None
    """Replaces the store of the cell: a file, or the address of a MongoDB server."""
    relay: StopRelay | None = None
    """Stops the devices although the event loop is blocked; without it, STOP needs the event loop."""
    journal: Path | str | None = None
    """Folder of the journal; without it, no event is kept."""
    recording: RecordingOptions | None = None
    """The recording of one run."""
    prepare: Callable[[SkillBus], object] | None = None
    """Registers fakes of a test on the bus before the first run."""
    enabling: EnableDevice | None = None
    """A person permits motion of all real devices; None where nobody does."""
    capture: Path | None = None
    """Folder to which the bytes of all connections to real devices are captured."""


@dataclass(frozen=True, kw_only=True)
class PreparedRun:
    """A run that is being entered into its journal and is recorded from its first event on, not yet executing."""

    run: Run
    faults: FaultPort | None
    started_unix_s: float
    """The time of its start; of a resumed run that of its first start."""
    journal: RunJournal
    end_recording: Callable[[], None] = lambda: None

    async def entered(self) -> None:
        """Return when its entry in the journal is on the disk.

        Raises:
            JournalError: it cannot be written; the run fails too.
        """
        try:
            await self.journal.commit()
        except JournalError as error:
            # The journal tells whoever waits for it, and nobody else.
            self.run.fail(error)
            raise

    async def execute(self) -> RunResult:
        """Execute the run to its end; raises as `Run.execute` does."""
        try:
            return await self.run.execute()
        finally:
            self.end_recording()


class CellRunner:
    """Starts runs in one open cell; any number may be active.

    Args:
        cell: The open cell.
        journal: Keeps the events of its runs.
        recorder: Records its runs.
    """

    def __init__(self, cell: OpenCell, journal: JournalPort, *, recorder: RunRecorder | None = None) -> None:
        self.cell = cell
        self._journal = journal
        self._recorder = recorder

    async def start(self, request: RunRequest) -> PreparedRun:
        """Enter a new run into the journal and return it, not yet executing.

        Nothing is awaited unless the world is restored: what the caller has just found out still holds.

        Raises:
            DocumentError: a parameter or input is invalid; the journal has no entry of the run.
            JournalError: the journal is known not to be writable; otherwise `entered` of the run raises it.
            RobotError: the run commands devices, and a device of the cell is lost; the world cannot be restored.
        """
        started_unix_s = time.time()
        plan, start = request.plan, request.start
        self._require_devices(plan)
        parameters = plan.checked_parameters(request.parameters)
        inputs = plan.checked_inputs(request.inputs)
        world = start.recorded.world if start is not None and start.recorded is not None else None
        if request.restore_world and world is not None:
            await self.cell.restore(world.data)
        run_id = request.run_id or new_run_id(plan.name)
        entry = self._journal.begin(
            run_id,
            behavior=plan.name,
            document=plan.document_hash,
            started_unix_s=started_unix_s,
            origin=self._origin(request, parameters, inputs) if self._keeps_events else None,
        )
        faults = self._faults(request.faults, seed=request.seed)
        run = Run(
            plan,
            run=run_id,
            bus=self.cell.bus,
            parameters=parameters,
            inputs=inputs,
            seed=request.seed,
            journal=entry,
            supervision=request.supervision,
            skills=faults,
            checkpoint=start.checkpoint if start is not None else None,
            world=self.cell.snapshot if self.cell.has_world and self._keeps_events else None,
        )
        return self._prepared(run, entry, request, faults=faults, started_unix_s=started_unix_s)

    async def resume(
        self,
        resumption: ResumePlan,
        *,
        supervision: RunOptions,
        documents: RecordedDocuments | None = None,
    ) -> PreparedRun:
        """Take over an interrupted run and return it, not yet executing; its previous process can no longer write.

        Args:
            resumption: The decision how it is resumed, of which the world is restored before any motion.
            supervision: Operator, autonomy, breakpoints, time-outs.
            documents: Documents kept in its recording; without them it is not recorded.

        Raises:
            JournalError: the journal cannot be written.
            RobotError: a device of the cell is lost, or the world cannot be restored.
            ControlError: events are not kept here; its previous process has continued the run, which can no longer
                be resumed like this.
        """
        resumed_unix_s = time.time()
        run_id, place = resumption.found.id, resumption.found.place
        if not self._keeps_events:
            raise ControlError("a run can only be resumed in its journal", where=run_id, hint="give --journal DIR")
        self._require_devices(resumption.plan)
        entry = self._journal.resume(run_id)
        now = plan_again(resumption, read_run(place, run_id), demanded=supervision.demand_operator)
        checkpoint, origin, world = now.checkpoint, now.found.origin, now.found.world
        if now.restores and world is not None:
            await self.cell.restore(world.data)
        run = Run(
            now.plan,
            run=run_id,
            bus=self.cell.bus,
            parameters=checkpoint.parameters if checkpoint is not None else origin.parameters,
            inputs=origin.inputs if checkpoint is None else {},
            seed=origin.run_seed,
            journal=entry,
            supervision=supervision,
            checkpoint=replace(checkpoint, epoch=entry.epoch) if checkpoint is not None else None,
            world=self.cell.snapshot if self.cell.has_world else None,
        )
        request = RunRequest(plan=now.plan, inputs=origin.inputs, supervision=supervision, documents=documents)
        prepared = self._prepared(run, entry, request, faults=None, started_unix_s=resumed_unix_s)
        return replace(prepared, started_unix_s=now.found.record.started_unix_s)

    @property
    def _keeps_events(self) -> bool:
        return not isinstance(self._journal, NullJournal)

    def _require_devices(self, plan: Plan) -> None:
        """Reject a run that commands devices while one is lost: its first motion would fail."""
        if plan.commands_hardware:
            self.cell.require_connected()

    def _faults(self, faults: Faults | None, *, seed: int) -> FaultPort | None:
        bus = self.cell.bus
        return FaultPort(BusPort(bus), faults, clock=bus.clock, seed=seed) if faults is not None else None

    def _prepared(
        self, run: Run, journal: RunJournal, request: RunRequest, *, faults: FaultPort | None, started_unix_s: float
    ) -> PreparedRun:
        if self._recorder is None or request.documents is None:
            return PreparedRun(run=run, faults=faults, started_unix_s=started_unix_s, journal=journal)
        start = RunStartRecord(
            documents=request.documents,
            inputs=request.inputs,
            supervision=request.supervision,
            started_unix_s=started_unix_s,
        )
        end_recording = self._recorder.record(run, self.cell.bus, start)
        return PreparedRun(
            run=run, faults=faults, started_unix_s=started_unix_s, journal=journal, end_recording=end_recording
        )

    def _origin(
        self, request: RunRequest, parameters: dict[str, object], inputs: dict[str, object]
    ) -> RunOrigin | None:
        """Return what the journal keeps about a start, so that the run can be resumed."""
        behavior, cell = request.plan.source, self.cell
        if behavior is None:
            return None
        document, documents = document_snapshot(behavior)
        return RunOrigin(
            behavior=request.source or str(behavior.file.resolve()),
            document=document,
            documents=documents,
            parameters=msgspec.to_builtins(parameters),
            inputs=msgspec.to_builtins(inputs),
            cell=str(cell.document.file.resolve()) if cell.document is not None else None,
            simulated=tuple(cell.document.simulated) if cell.document is not None else (),
            real=tuple(cell.document.document.real_devices) if cell.document is not None else (),
            store=absolute_address(cell.store_path) if cell.store_path is not None else None,
            seed=cell.seed,
            run_seed=request.seed,
            clock="virtual" if cell.bus.clock.virtual else "real",
            autonomy=request.supervision.autonomy,
            demand_operator=request.supervision.demand_operator,
        )


async def execute_within(limit_s: float | None, prepared: PreparedRun) -> RunResult:
    """Execute a run to its end; stop it when it takes longer than this, on its clock."""
    if limit_s is None:
        return await prepared.execute()
    reason = f"timeout: the run took longer than {limit_s:g} s"
    timer = asyncio.get_running_loop().call_later(limit_s, prepared.run.stop, reason)
    try:
        return await prepared.execute()
    finally:
        timer.cancel()


@asynccontextmanager
async def open_cell(
    cell: Cell | None,
    *,
    seed: int | None = None,
    store: str | None = None,
    relay: StopRelay | None = None,
    capture: Path | None = None,
) -> AsyncGenerator[OpenCell]:
    """Open a cell and the relay that stops it; when the block ends, its robots come to rest before the relay ends.

    Args:
        cell: The cell; without it, an empty bus.
        seed: Seed of the random part poses of a simulated world; None for the nominal poses.
        store: Replaces the store of the cell: a file, or the address of a MongoDB server.
        relay: Stops the devices although the event loop is blocked.
        capture: Folder to which the bytes of all connections to real devices are captured; None for none.

    Raises:
        FlexcellError: store, world or robots cannot be opened.
    """
    async with AsyncExitStack() as stack:
        if relay is not None:
            await stack.enter_async_context(relay)
        opened = OpenCell(cell, seed=seed, store_path=store, relay=relay, capture=capture)
        yield await stack.enter_async_context(opened)


@asynccontextmanager
async def open_cell_runner(setup: CellSetup) -> AsyncGenerator[CellRunner]:
    """Open journal, recording, relay and cell, in this order, and close them in reverse order.

    Raises:
        FlexcellError: one of them cannot be opened; those opened before it are closed.
    """
    inline = new_clock().virtual
    async with AsyncExitStack() as stack:
        journal: JournalPort = NullJournal()
        if setup.journal is not None:
            journal = stack.enter_context(Journal.open(setup.journal, inline=inline))
        recorder = await stack.enter_async_context(open_recorder(setup.recording, inline=inline))
        cell = await stack.enter_async_context(
            open_cell(setup.cell, seed=setup.seed, store=setup.store, relay=setup.relay, capture=setup.capture)
        )
        if setup.prepare is not None:
            setup.prepare(cell.bus)
        if setup.enabling is not None:
            await cell.enable(setup.enabling.reason, by=setup.enabling.by)
        yield CellRunner(cell, journal, recorder=recorder)
