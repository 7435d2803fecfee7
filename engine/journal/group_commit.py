"""Group commit: all pending events are written in one transaction, then the waiters are notified in order."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field

from engine.errors import JournalError
from engine.event import Event
from engine.journal.batch import NewRun, WorldState, WriteBatch
from engine.journal.database import JournalDatabase, RunRefused

WAKE_AT_EVENTS = 4096
"""Number of uncommitted events that wakes the writer without a commit."""
MAX_PENDING_EVENTS = 4 * WAKE_AT_EVENTS
"""Number of pending events of one run above which the run waits for the writer."""
WAKE_AFTER_S = 0.25
"""Time after the first pending event at which the writer is woken too: an idle run may never commit."""


@dataclass(eq=False)
class RunWriteQueue:
    """The pending record and events of one run and its write progress.

    The run's loop appends to `events` and `worlds`, the writer takes from the other end: neither waits for the other.
    `failure` is set when an event is lost; nothing is written after that. `listener` is notified of it when no commit
    is waiting.
    """

    run_id: str
    epoch: int
    new: NewRun | None = None
    """The record of a run that begins, until the writer has taken it."""
    events: list[Event] = field(default_factory=list[Event], repr=False)
    worlds: deque[WorldState] = field(default_factory=deque[WorldState], repr=False)
    appended: int = 0
    """Number of events so far, and of records that begin the run."""
    durable: int = 0
    last_seq: int = 0
    failure: JournalError | None = None
    listener: Callable[[JournalError], None] | None = None
    loop: asyncio.AbstractEventLoop | None = None

    def take(self) -> _Group:
        """Take all pending data; called by the writer."""
        new, self.new = self.new, None
        world = None
        # Before the events: a world state must not be written without the events before it.
        while self.worlds:
            world = self.worlds.popleft()
        # Two steps, each atomic for other threads; events appended in between stay for the next group.
        events = self.events[:]
        del self.events[: len(events)]
        return _Group(events, world, new)

    def fail(self, error: JournalError) -> None:
        """Stop writing this run; the first error is kept."""
        self.failure = self.failure or error

    def notify(self, error: JournalError) -> None:
        """Call the listener on its loop; may be called from any thread."""
        if self.listener is None or self.loop is None:
            return
        # The loop may be closed; then there is no listener.
        with suppress(RuntimeError):
            self.loop.call_soon_threadsafe(self.listener, error)


@dataclass(frozen=True, eq=False)
class _Group:
    events: list[Event]
    world: WorldState | None
    new: NewRun | None

    @property
    def empty(self) -> bool:
        return not self.events and self.world is None and self.new is None

    @property
    def counted(self) -> int:
        """What `RunWriteQueue.durable` counts."""
        return len(self.events) + (self.new is not None)


@dataclass(frozen=True, eq=False)
class CommitWaiter:
    """A commit on an event loop that waits until the present events of `write_queue` are durable."""

    write_queue: RunWriteQueue
    future: asyncio.Future[None] = field(repr=False)

    def notify(self, error: JournalError | None) -> None:
        """Resolve the future on its loop; called from the writer thread."""
        try:
            self.future.get_loop().call_soon_threadsafe(self._resolve, error)
        except RuntimeError:
            # The loop has been closed; nothing waits for this future.
            return

    def _resolve(self, error: JournalError | None) -> None:
        if self.future.done():
            return
        if error is None:
            self.future.set_result(None)
        else:
            self.future.set_exception(error)


class GroupCommitWriter:
    """Writes the queues with data: `flush` on the calling thread, or `start` a writer thread.

    A run only appends to its write queue; encoding happens when the group is written.
    """

    def __init__(self, database: JournalDatabase) -> None:
        self.queue: deque[RunWriteQueue | CommitWaiter] = deque()
        """Write queues with pending data, and waiting commits."""
        self.failure: JournalError | None = None
        """Set when the journal is closed and nothing can be written."""
        self.last_failure: JournalError | None = None
        """The latest write failure; later writes may succeed."""
        self._database = database
        self._lock = threading.Lock()
        self._wake = threading.Event()
        self._closing = False
        self._thread: threading.Thread | None = None

    @property
    def lock(self) -> threading.Lock:
        """Guards the database; hold it to use the connection outside the writer."""
        return self._lock

    @property
    def threaded(self) -> bool:
        """True when a writer thread runs."""
        return self._thread is not None

    def start(self) -> None:
        """Start the writer thread."""
        # A daemon thread, so that a journal that was not closed cannot keep the process from ending.
        self._thread = threading.Thread(target=self._serve, name="journal writer", daemon=True)
        self._thread.start()

    def wake(self) -> None:
        """Write the queued data: by the writer thread, or at once when there is none."""
        if self._thread is None:
            self.flush()
        # A set event has not been cleared yet, and the queue is read after it is cleared.
        elif not self._wake.is_set():
            self._wake.set()

    def wake_soon(self) -> None:
        """Wake the writer thread after `WAKE_AFTER_S`; called on an event loop."""
        if self._thread is None:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            return  # no loop runs: the data is written at the end
        loop.call_later(WAKE_AFTER_S, self._wake.set)

    def stop(self) -> None:
        """Write all pending data and end the thread."""
        self._closing = True
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        self.flush()

    def flush(self, *, asking: RunWriteQueue | None = None) -> None:
        """Write all queued data in one group and notify the waiters.

        A failure ends writing of the runs whose events were in the group, and of no others; their queues keep it.

        Args:
            asking: The run that checks its own failure afterwards.
        """
        with self._lock:
            items = [self.queue.popleft() for _ in range(len(self.queue))]
            waiters = [item for item in items if isinstance(item, CommitWaiter)]
            taken = {each: each.take() for each in dict.fromkeys(map(_queue_of, items))}
            self._requeue(taken)
            groups = {each: group for each, group in taken.items() if not group.empty}
            healthy = [each for each in groups if each.failure is None]
            try:
                self._write(groups)
            except Exception as error:
                # No commit may be left waiting after any error: every commit, waiting or later, raises it.
                self._fail(healthy, _unexpected(error))
            finally:
                for waiter in waiters:
                    waiter.notify(self.failure or waiter.write_queue.failure)
                notified = {asking, *(waiter.write_queue for waiter in waiters)}
                for write_queue in healthy:
                    if write_queue.failure is not None and write_queue not in notified:
                        write_queue.notify(write_queue.failure)

    def _requeue(self, write_queues: Iterable[RunWriteQueue]) -> None:
        """Queue those again that received data while they were emptied: such data queues nothing itself."""
        if nonempty := [each for each in write_queues if each.events or each.worlds]:
            self.queue.extend(nonempty)

            self._wake.set()

    def _serve(self) -> None:
        while not self._closing:
            self._wake.wait()
            self._wake.clear()
            self.flush()

    def _write(self, groups: dict[RunWriteQueue, _Group]) -> None:
        ready = {write_queue: group for write_queue, group in groups.items() if write_queue.failure is None}
        while ready and self.failure is None:
            try:
                self._database.store(
                    [
                        WriteBatch(write_queue.run_id, write_queue.epoch, group.events, group.world, group.new)
                        for write_queue, group in ready.items()
                    ]
                )
            except RunRefused as error:
                refused = next(write_queue for write_queue in ready if write_queue.run_id == error.where)
                self._fail([refused], JournalError(error.message, where=self._database.path, hint=error.hint))
                group = ready[refused]
                # The events of a run that has begun are refused, not that it has.
                if group.new is not None and group.events:
                    ready[refused] = _Group([], None, group.new)
                else:
                    del ready[refused]
                continue
            except JournalError as error:
                self._fail(ready, error)
                return
            for write_queue, group in ready.items():
                write_queue.durable += group.counted
            return

    def _fail(self, write_queues: Iterable[RunWriteQueue], error: JournalError) -> None:
        self.last_failure = error
        for write_queue in write_queues:
            write_queue.fail(error)


def _queue_of(item: RunWriteQueue | CommitWaiter) -> RunWriteQueue:
    return item.write_queue if isinstance(item, CommitWaiter) else item


def _unexpected(error: BaseException) -> JournalError:
    failure = JournalError(f"the journal writer failed: {type(error).__name__}: {error}", hint="report this defect")
    failure.__cause__ = error
    return failure
