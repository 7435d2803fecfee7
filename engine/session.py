"""A session: an open cell, the behaviors of a project, and any number of runs at once."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import msgspec

from engine.bus.access import BusAccess, LocalBus
from engine.cause import describe
from engine.cell import OpenCell
from engine.errors import FlexcellError
from engine.event import Event
from engine.journal import Journal
from engine.library import BehaviorView, Library
from engine.nearness import near_names
from engine.plan import Catalogue, new_plan
from engine.run import Run, RunResult
from engine.run_id import new_run_id

EventCallback = Callable[[str, Event], None]
_KEPT_RUNS = 200


class RunView(msgspec.Struct, frozen=True, kw_only=True):
    """One run, under way or over; `status` is running, stopping, finished, stopped or errored."""

    id: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    cause: str
    started_at_s: float
    duration_s: float


class _Started:
    """A run of this session with its task and events."""

    def __init__(self, behavior_id: str, run: Run, started_s: float) -> None:
        self.behavior_id = behavior_id
        self.run = run
        self.started_s = started_s
        self.started_at_s = time.time()
        self.events: list[Event] = []
        self.stopping = False
        self.result: RunResult | None = None
        self.task: asyncio.Task[None] | None = None


class Session:
    """What the dashboard works on; belongs to the event loop it is made on."""

    def __init__(self, cell: OpenCell, *, project: Path, catalogue: Catalogue, journal: Journal) -> None:
        self.cell = cell
        self._library = Library(project, catalogue)
        self._journal = journal
        self._runs: dict[str, _Started] = {}
        self._callbacks: tuple[EventCallback, ...] = ()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop every run and wait until its robots rest."""
        for started in self._runs.values():
            started.run.stop("the session was closed")
        tasks = [started.task for started in self._runs.values() if started.task is not None]
        if tasks:
            await asyncio.wait(tasks)

    @property
    def bus(self) -> BusAccess:
        """The cell's bus, by name and JSON."""
        return LocalBus(self.cell.bus)

    @property
    def cell_name(self) -> str:
        """Name of the connected cell."""
        return self.cell.name

    def behaviors(self) -> tuple[BehaviorView, ...]:
        """Return all behaviors of the project, sorted by id."""
        return self._library.views()

    def behavior(self, behavior_id: str) -> BehaviorView:
        """Return one behavior; raises DocumentError when the id names none."""
        return self._library.view(behavior_id)

    def runs(self) -> tuple[RunView, ...]:
        """Return the runs of this session, newest first."""
        return tuple(self._view(run_id, started) for run_id, started in reversed(self._runs.items()))

    def run(self, run_id: str) -> RunView:
        """Return one run; raises FlexcellError when the id names none."""
        return self._view(run_id, self._known(run_id))

    async def start(self, behavior_id: str, *, parameters: Mapping[str, object], seed: int) -> str:
        """Start a run and return its id.

        Raises:
            FlexcellError: it cannot start: the behavior has errors, or a parameter is not acceptable.
        """
        behavior = self._library.behavior(behavior_id)
        plan = new_plan(behavior, self._library.catalogue)
        run_id = new_run_id(plan.name)
        checked = plan.checked_parameters(parameters)
        journal = self._journal.begin(
            run_id, behavior=plan.name, document=plan.document_hash, started_unix_s=time.time()
        )
        run = Run(plan, run=run_id, bus=self.cell.bus, parameters=checked, seed=seed, journal=journal)
        started = self._runs[run_id] = _Started(behavior_id, run, self.cell.bus.clock.now_s())
        run.watch(lambda event: self._tell(run_id, event))
        started.task = asyncio.create_task(self._execute(started), name=f"session run {run_id}")
        self._forget_oldest()
        return run_id

    async def stop(self, run_id: str, *, reason: str) -> None:
        """Ask a run to stop and return at once; stopping one that is over does nothing."""
        started = self._known(run_id)
        if started.result is None:
            started.stopping = True
            started.run.stop(reason)

    async def wait(self, run_id: str) -> RunView:
        """Wait until a run is over and return it."""
        started = self._known(run_id)
        if started.task is not None:
            await asyncio.wait({started.task})
        return self.run(run_id)

    def subscribe(self, callback: EventCallback) -> Callable[[], None]:
        """Call back with (run id, event) for every event of every run; returns what ends it."""
        self._callbacks = (*self._callbacks, callback)
        return lambda: self._unsubscribe(callback)

    def events(self, run_id: str, *, after: int = 0) -> list[Event]:
        """Return the events of a run with `seq` > `after`, in order."""
        events = self._known(run_id).events
        return events[after:]  # `seq` counts from 1 without gaps

    def latest(self, topic: str) -> object | None:
        """Return the newest message of a bus topic, or None."""
        try:
            return self.cell.bus.find_topic(topic).latest
        except FlexcellError:
            return None  # nobody publishes it in this cell, which is not an error of the viewer

    def subscribe_topic(self, topic: str, callback: Callable[[Any], None]) -> Callable[[], None]:
        """Call back with every new message of a topic, the newest one first, at once.

        Raises:
            BusError: this cell has no such topic.
        """
        found = self.cell.bus.find_topic(topic)
        if found.latest is not None:
            callback(found.latest)
        return found.subscribe(callback).close

    async def _execute(self, started: _Started) -> None:
        started.result = await started.run.execute()

    def _tell(self, run_id: str, event: Event) -> None:
        self._runs[run_id].events.append(event)
        for callback in self._callbacks:
            callback(run_id, event)

    def _unsubscribe(self, callback: EventCallback) -> None:
        self._callbacks = tuple(known for known in self._callbacks if known is not callback)

    def _known(self, run_id: str) -> _Started:
        if run_id not in self._runs:
            raise FlexcellError(f"there is no run {run_id!r}", hint=near_names(run_id, self._runs))
        return self._runs[run_id]

    def _forget_oldest(self) -> None:
        """Keep memory bounded; the journal keeps every run."""
        over = [run_id for run_id, started in self._runs.items() if started.result is not None]
        for run_id in over[: max(0, len(self._runs) - _KEPT_RUNS)]:
            del self._runs[run_id]

    def _view(self, run_id: str, started: _Started) -> RunView:
        result = started.result
        now_s = self.cell.bus.clock.now_s()
        return RunView(
            id=run_id,
            behavior=started.behavior_id,
            status=result.status if result else ("stopping" if started.stopping else "running"),
            outcome=result.outcome if result else None,
            success=result.success if result else False,
            cause=describe(result.cause) if result and result.cause and not result.success else "",
            started_at_s=started.started_at_s,
            duration_s=result.duration_s if result else now_s - started.started_s,
        )
