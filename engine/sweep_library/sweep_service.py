"""The sweeps of a project for a server: read, executed and repeated in processes of their own, one sweep at a time."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Mapping
from pathlib import Path

import msgspec

from engine.errors import ControlError, RobotError
from engine.sweep_library.shrinkings import Shrinkings
from engine.sweep_library.sweep_files import sweep_file
from engine.sweep_library.sweep_process_link import SweepProcessLink, refusal
from engine.sweep_library.sweep_requests import (
    Answered,
    ExecuteSweep,
    Proceeding,
    RecordTrial,
    Refused,
    SaveCase,
    ShrinkProceeding,
    SweepAnswer,
    SweepRequest,
)
from engine.sweep_library.sweep_view import SweepLive

LIMIT_S = 120.0
"""Time limit of an answer, including what the first one loads on a busy computer."""
RECORD_LIMIT_S = 900.0
STOP_LIMIT_S = 10.0
"""Time that a sweep has for its end; then its process is killed. What has ended is saved already."""
_log = logging.getLogger("flexcell.sweeps")
LiveCallback = Callable[[str, SweepLive], None]


class SweepService:
    """The sweeps of one project; belongs to one event loop. `close` ends all its processes.

    Nothing is kept here but what is being executed: results are in their file, and read there.

    Args:
        project: The folder of the project.
        changed: Called with the id of the sweep that is executed, and how far it is.
    """

    def __init__(self, project: Path, *, changed: LiveCallback = lambda _sweep, _live: None) -> None:
        self._project = project.resolve()
        self._changed = changed
        self._reader: SweepProcessLink | None = None
        self._reading = asyncio.Lock()
        self._recording = asyncio.Lock()
        self._starting = asyncio.Lock()
        self._recorder: SweepProcessLink | None = None
        self._executor: SweepProcessLink | None = None
        self._following: asyncio.Task[None] | None = None
        self._live: dict[str, SweepLive] = {}
        self.shrinkings = Shrinkings(project)
        """The runs that are shrunk."""

    @property
    def live(self) -> Mapping[str, SweepLive]:
        """What is being executed, by its id; one sweep at most."""
        return self._live

    async def ask(self, request: SweepRequest) -> bytes:
        """Return the answer to a request as JSON; one after the other.

        Raises:
            NoSuchSweep, ControlError, DocumentError: it is refused.
            RobotError: the process does not answer; the next request starts another one.
        """
        async with self._reading:
            if self._reader is None:
                self._reader = await SweepProcessLink.start(self._project)
            try:
                return await self._reader.answer(request, limit_s=LIMIT_S)
            except (RobotError, asyncio.CancelledError):
                # A late answer would be mistaken for that to the next request.
                self._reader.close()
                self._reader = None
                raise

    async def start(self, sweep_id: str, *, again: bool = False) -> None:
        """Begin to execute what is left of a sweep, and return once its first runs can begin.

        Raises:
            ControlError: another sweep is being executed, or this one must not be.
            FlexcellError: it cannot be executed.
        """
        # Without a process, which takes seconds to say the same.
        await asyncio.to_thread(sweep_file, self._project, sweep_id)
        async with self._starting:
            await self._begin(sweep_id, again=again)

    async def _begin(self, sweep_id: str, *, again: bool) -> None:
        if self._live or self._executor is not None:
            running = next(iter(self._live), "another sweep")
            raise ControlError("a sweep is being executed already", where=running, hint="stop it, or wait for its end")
        process = self._executor = await SweepProcessLink.start(self._project)
        try:
            await process.send(ExecuteSweep(sweep=sweep_id, again=again))
            first = await process.receive(limit_s=LIMIT_S)
            if isinstance(first, Refused):
                raise refusal(first)
        except BaseException:
            self._executor = None
            process.close()
            raise
        self._publish(sweep_id, first.live if isinstance(first, Proceeding) else _idle(first))
        self._following = asyncio.create_task(self._follow(sweep_id, process), name=f"sweep {sweep_id}")

    def stop(self, sweep_id: str) -> None:
        """End the execution of a sweep; what has ended stays, and `start` goes on with the rest.

        Raises:
            ControlError: it is not being executed.
        """
        live = self._live.get(sweep_id)
        if live is None or self._executor is None:
            raise ControlError("this sweep is not being executed", where=sweep_id)
        if live.status != "stopping":
            self._publish(sweep_id, msgspec.structs.replace(live, status="stopping", remaining_s=None))
            self._executor.interrupt()

    async def record(self, sweep_id: str, number: int) -> bytes:
        """Execute a run again in a process of its own and return a `RecordedTrial` as JSON; one after the other.

        Raises:
            FlexcellError: it is refused, or its process has ended.
        """
        await asyncio.to_thread(sweep_file, self._project, sweep_id)
        async with self._recording:
            process = self._recorder = await SweepProcessLink.start(self._project)
            try:
                return await process.answer(RecordTrial(sweep=sweep_id, number=number), limit_s=RECORD_LIMIT_S)
            finally:
                self._recorder = None
                process.close()

    async def save_case(self, sweep_id: str, number: int, case: str) -> None:
        """Save a run that was shrunk as a test case, a sweep document at a path in the project.

        Raises:
            ControlError: it was not shrunk, or the behavior has changed since.
            DocumentError: the path is taken or leads out of the project.
        """
        found = self.shrinkings.of(sweep_id, number).found
        if found is None:
            raise ControlError("this run was not shrunk", where=f"run {number} of {sweep_id}", hint="shrink it first")
        await self.ask(SaveCase(sweep=sweep_id, case=case, found=found))
        self.shrinkings.note_case(sweep_id, number, case)

    async def close(self) -> None:
        """End all processes; a sweep that is being executed can go on later."""
        await self.shrinkings.close()
        for process in (self._reader, self._recorder, self._executor):
            if process is not None:
                process.close()
        self._reader = None
        if self._following is not None:
            await asyncio.wait({self._following})

    async def _follow(self, sweep_id: str, process: SweepProcessLink) -> None:
        problem = ""
        last = self._live.get(sweep_id, SweepLive())
        try:
            while last.status != "idle":
                stopping = self._live[sweep_id].status == "stopping"
                received = await process.receive(limit_s=STOP_LIMIT_S if stopping else None)
                match received:
                    case Proceeding():
                        last = received.live
                        if self._live[sweep_id].status == "stopping":
                            last = msgspec.structs.replace(last, status="stopping", remaining_s=None)
                        self._publish(sweep_id, last)
                    case Answered():
                        last = _idle(received)
                    case Refused():
                        message, where, _ = received.words
                        problem = f"{where}: {message}" if where else message
                        break
                    case ShrinkProceeding():
                        pass
        except RobotError as error:
            problem = error.message if self._live[sweep_id].status != "stopping" else ""
            _log.info("the execution of the sweep %s has ended: %s", sweep_id, error.message)
        finally:
            process.close()
            self._executor = None
            self._publish(
                sweep_id, msgspec.structs.replace(last, status="idle", remaining_s=None, rate_hz=0.0, problem=problem)
            )

    def _publish(self, sweep_id: str, live: SweepLive) -> None:
        if live.status == "idle":
            self._live.pop(sweep_id, None)
        else:
            self._live[sweep_id] = live
        self._changed(sweep_id, live)


def _idle(answered: SweepAnswer) -> SweepLive:
    assert isinstance(answered, Answered)
    return msgspec.json.decode(answered.body, type=SweepLive)
