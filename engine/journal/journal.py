"""The journal of runs: append-only, in one SQLite file, durable before an effect leaves the engine."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from engine.errors import JournalError
from engine.event import Event
from engine.journal.batch import NewRun, WorldState
from engine.journal.database import JournalDatabase, journal_fault
from engine.journal.engine_presence import EnginePresence
from engine.journal.group_commit import (
    MAX_PENDING_EVENTS,
    WAKE_AT_EVENTS,
    CommitWaiter,
    GroupCommitWriter,
    RunWriteQueue,
)
from engine.journal.journal_port import RunOrigin
from engine.journal.snapshot import open_snapshot

JOURNAL_FILE = "journal.db"


def journal_path(place: Path | str) -> Path:
    """Return the journal file of a directory (`journal.db` in it) or of a file path (`*.db`)."""
    path = Path(place)
    return path if path.suffix == ".db" and not path.is_dir() else path / JOURNAL_FILE


class SqliteRunJournal:
    """The journal of one run, a part of a `Journal`."""

    def __init__(self, write_queue: RunWriteQueue, writer: GroupCommitWriter, *, place: Path) -> None:
        self._place = place
        self._write_queue = write_queue
        self._writer = writer
        self._events = write_queue.events

    @property
    def run_id(self) -> str:
        """The id of the run."""
        return self._write_queue.run_id

    @property
    def epoch(self) -> int:
        """1 for the engine that started the run, plus 1 for each that resumed it."""
        return self._write_queue.epoch

    def append(self, event: Event) -> None:
        """Append an event; the next commit of any run, or a timer, encodes and writes it."""
        write_queue, events = self._write_queue, self._events
        events.append(event)
        write_queue.appended += 1
        write_queue.last_seq = event.seq
        waiting = len(events)
        if waiting == 1:
            self._writer.queue.append(write_queue)
            self._writer.wake_soon()
        elif waiting >= WAKE_AT_EVENTS:
            self._writer.wake()

    async def events(self) -> Sequence[Event]:
        """Return the events of the run so far; reads on another thread when a writer thread runs."""
        await self.commit()
        return await asyncio.to_thread(self._read) if self._writer.threaded else self._read()

    def _read(self) -> Sequence[Event]:
        with open_snapshot(self._place) as journal:
            return tuple(journal.events(self.run_id))

    async def apply_backpressure(self) -> None:
        """Return at once, or commit when more than `MAX_PENDING_EVENTS` are not on disk yet."""
        # Those that the writer has taken are in memory too.
        if self._write_queue.appended - self._write_queue.durable > MAX_PENDING_EVENTS:
            await self.commit()

    def append_world_state(self, state: bytes) -> None:
        """Append the state of the simulated world; the next commit stores it with the events so far."""
        self._write_queue.worlds.append(WorldState(self._write_queue.last_seq, state))
        self._writer.queue.append(self._write_queue)

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        """Call `listener` on this event loop when events cannot be written and no commit is waiting."""
        self._write_queue.listener, self._write_queue.loop = listener, asyncio.get_running_loop()

    async def commit(self) -> None:
        """Return when all appended events are on disk.

        Raises:
            JournalError: an event could not be written, now or at an earlier commit; the run must stop.
        """
        write_queue, writer = self._write_queue, self._writer
        if (failure := writer.failure or write_queue.failure) is not None:
            raise _again(failure)
        if write_queue.durable == write_queue.appended:
            return
        if not writer.threaded:
            writer.flush(asking=write_queue)
            if (failure := writer.failure or write_queue.failure) is not None:
                raise _again(failure)
            return
        waiter = CommitWaiter(write_queue, asyncio.get_running_loop().create_future())
        writer.queue.append(waiter)
        writer.wake()
        if (failure := writer.failure) is not None:
            # Closed or failed since the first check: the writer may not notify any further waiter.
            waiter.future.cancel()
            raise _again(failure)
        await waiter.future


class Journal:
    """All runs journaled in one file; open it with `Journal.open`, close it or use `with`."""

    def __init__(self, database: JournalDatabase, writer: GroupCommitWriter, presence: EnginePresence) -> None:
        self.path = database.path
        self._database = database
        self._writer = writer
        self._presence = presence
        self._closed = False

    @classmethod
    def open(cls, place: Path | str, *, inline: bool = False, busy_timeout_s: float = 5.0) -> Journal:
        """Open or create the journal in a directory, or at a path that ends in `.db`.

        Args:
            place: The directory or file.
            inline: Write on the calling thread, inside `commit` and when many events are pending, so that a run in
                virtual time stays deterministic; otherwise one writer thread commits for all runs together.
            busy_timeout_s: Time to wait for another process that holds the file locked.

        Raises:
            JournalError: the file cannot be opened.
        """
        database = JournalDatabase.open(journal_path(place), busy_timeout_s=busy_timeout_s)
        try:
            presence = EnginePresence.open(database.path)
        except OSError as error:
            database.close()
            raise journal_fault("cannot be opened", database.path, error) from error
        writer = GroupCommitWriter(database)
        if not inline:
            writer.start()
        return cls(database, writer, presence)

    def begin(
        self, run_id: str, *, behavior: str, document: str, started_unix_s: float, origin: RunOrigin | None = None
    ) -> SqliteRunJournal:
        """Have a new run stored, and return its journal.

        With a writer thread nothing is waited for, since the event loop must not wait for a disk while arms move: the
        next commit of the run returns once it is durable, or raises. Without one it is durable at the return.

        Raises:
            JournalError: the run already exists, or the journal cannot be written; with a writer thread only if it is
                known already.
        """
        self._refuse_unusable()
        new = NewRun(
            behavior=behavior,
            document=document,
            started_unix_s=started_unix_s,
            origin=origin,
            engine=self._presence.engine,
        )
        write_queue = RunWriteQueue(run_id, epoch=1, new=new, appended=1)
        self._writer.queue.append(write_queue)
        if self._writer.threaded:
            self._writer.wake()
        else:
            self._writer.flush(asking=write_queue)
            if write_queue.failure is not None:
                raise _again(write_queue.failure)
        return SqliteRunJournal(write_queue, self._writer, place=self.path)

    def resume(self, run_id: str) -> SqliteRunJournal:
        """Take over an existing run: the engine that drove it before can no longer commit.

        Raises:
            JournalError: there is no such run, or the journal cannot be written.
        """
        self._refuse_unusable()
        with self._writer.lock:
            epoch = self._database.take_over_run(run_id, engine=self._presence.engine)
        return SqliteRunJournal(RunWriteQueue(run_id, epoch), self._writer, place=self.path)

    def close(self) -> None:
        """Write all pending events and close the file; may be called again.

        Raises:
            JournalError: pending events could not be written and no commit has reported it.
        """
        if self._closed:
            return
        self._closed = True
        reported = self._writer.last_failure
        try:
            self._writer.stop()
        finally:
            self._database.close()
            self._presence.close()
        failure = self._writer.last_failure
        self._writer.failure = JournalError("the journal is closed", where=self.path, hint="open it again")
        if failure is not None and failure is not reported:
            raise _again(failure)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _refuse_unusable(self) -> None:
        if self._writer.failure is not None:
            raise _again(self._writer.failure)


def _again(failure: JournalError) -> JournalError:
    # A new object for each raise: a shared exception would collect all tracebacks.
    copy = JournalError(failure.message, where=failure.where, hint=failure.hint)
    copy.__cause__ = failure.__cause__
    return copy
