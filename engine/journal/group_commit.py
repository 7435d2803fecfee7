"""Group commit: everything that waits is written in one transaction, then all who wait are told, in order."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field

from engine.errors import JournalError
from engine.event import Event
from engine.journal.batch import WorldState, WriteBatch
from engine.journal.database import JournalDatabase, RunRefused

WAKE_AT_EVENTS = 4096
"""Number of uncommitted events that wakes the writer without a commit."""
MAX_PENDING_EVENTS = 4 * WAKE_AT_EVENTS
"""A run whose own events come faster than the writer writes waits for it above so many."""
WAKE_AFTER_S = 0.25
"""So long after the first of them it is woken too: a run that only waits has no effect that is due a commit."""


@dataclass(eq=False)
class RunWriteQueue:
    """What is to be written of one run, and how far it has been.

    The run's loop appends to `events` and `worlds`, the writer takes from their other end: neither waits for the other.
    `failure` is the reason why it never will be again: an event of it is lost. `listener` hears of it where no commit
    waits to be told.
    """

    run_id: str
    epoch: int
    events: list[Event] = field(default_factory=list[Event], repr=False)
    worlds: deque[WorldState] = field(default_factory=deque[WorldState], repr=False)
    appended: int = 0
    durable: int = 0
    last_seq: int = 0
    failure: JournalError | None = None
    listener: Callable[[JournalError], None] | None = None
    loop: asyncio.AbstractEventLoop | None = None

    def take(self) -> _Group:
        """Take everything that is there; called by the writer."""
        world = None
        # Before the events: a world must not come to the disk without those that led to it.
        while self.worlds:
            world = self.worlds.popleft()
        # In two steps, each of which is whole to another thread; what is appended in between stays for the next time.
        events = self.events[:]
        del self.events[: len(events)]
        return _Group(events, world)

    def fail(self, error: JournalError) -> None:
        """Write nothing more of this run."""
        self.failure = self.failure or error

    def tell(self, error: JournalError) -> None:
        """Call the listener on its loop; may be called from any thread."""
        if self.listener is None or self.loop is None:
            return
        # That loop may be closed: nobody listens there any more.
        with suppress(RuntimeError):
            self.loop.call_soon_threadsafe(self.listener, error)


@dataclass(frozen=True, eq=False)
class _Group:
    events: list[Event]
    world: WorldState | None


@dataclass(frozen=True, eq=False)
class CommitWaiter:
    """Somebody on an event loop who wants to know that what `ledger` was given so far is durable."""

    ledger: RunWriteQueue
    future: asyncio.Future[None] = field(repr=False)

    def tell(self, error: JournalError | None) -> None:
        """Wake the waiting loop; called from the writer thread."""
        try:
            self.future.get_loop().call_soon_threadsafe(self._resolve, error)
        except RuntimeError:
            # That loop was closed in the meantime: nobody waits there any more.
            return

    def _resolve(self, error: JournalError | None) -> None:
        if self.future.done():
            return
        if error is None:
            self.future.set_result(None)
        else:
            self.future.set_exception(error)


class GroupCommitWriter:
    """Writes what is in the ledgers it was told of; `flush` on the calling thread, or `start` a thread that does.

    Appending to its ledger is all that a run pays; encoding happens when the group is written.
    """

    def __init__(self, database: JournalDatabase) -> None:
        self.queue: deque[RunWriteQueue | CommitWaiter] = deque()
        """Ledgers that have something to write, and who waits for that."""
        self.failure: JournalError | None = None
        """Why nothing at all can be written any more: it is closed."""
        self.last_failure: JournalError | None = None
        """The newest reason why something was not written; what comes later may be."""
        self._database = database
        self._lock = threading.Lock()
        self._wake = threading.Event()
        self._closing = False
        self._thread: threading.Thread | None = None

    @property
    def lock(self) -> threading.Lock:
        """Guards the database; hold it to use the connection beside the writer."""
        return self._lock

    @property
    def threaded(self) -> bool:
        """True when a thread of its own writes."""
        return self._thread is not None

    def start(self) -> None:
        """Let a thread write from now on."""
        # A daemon, so that a journal nobody closed cannot keep the process from ending.
        self._thread = threading.Thread(target=self._serve, name="journal writer", daemon=True)
        self._thread.start()

    def wake(self) -> None:
        """Have what is queued written: by the thread, or at once where there is none."""
        if self._thread is None:
            self.flush()
        # What is set already is not yet cleared, and what is queued is looked at after that.
        elif not self._wake.is_set():
            self._wake.set()

    def wake_soon(self) -> None:
        """Tell the thread, after a while, that something is there; called on an event loop."""
        if self._thread is None:
            return
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            return  # nobody runs: what is there is written at the end
        loop.call_later(WAKE_AFTER_S, self._wake.set)

    def stop(self) -> None:
        """Write what is left and end the thread."""
        self._closing = True
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        self.flush()

    def flush(self, *, asking: RunWriteQueue | None = None) -> None:
        """Write everything queued now in one group and tell the waiters.

        A failure ends the runs whose events were in the group, for good, and no others: it is kept in their ledgers.

        Args:
            asking: The run that will look for its failure itself.
        """
        with self._lock:
            items = [self.queue.popleft() for _ in range(len(self.queue))]
            waiters = [item for item in items if isinstance(item, CommitWaiter)]
            taken = {ledger: ledger.take() for ledger in dict.fromkeys(map(_ledger_of, items))}
            self._look_again(taken)
            groups = {ledger: group for ledger, group in taken.items() if group.events or group.world is not None}
            healthy = [ledger for ledger in groups if ledger.failure is None]
            try:
                self._write(groups)
            except Exception as error:
                # Nobody may be left waiting, whatever broke: every commit, waiting or later, raises it.
                self._fail(healthy, _unexpected(error))
            finally:
                for waiter in waiters:
                    waiter.tell(self.failure or waiter.ledger.failure)
                told = {asking, *(waiter.ledger for waiter in waiters)}
                for ledger in healthy:
                    if ledger.failure is not None and ledger not in told:
                        ledger.tell(ledger.failure)

    def _look_again(self, ledgers: Iterable[RunWriteQueue]) -> None:
        """Come back to those to which something was appended while they were emptied: nobody told of it."""
        if left := [ledger for ledger in ledgers if ledger.events or ledger.worlds]:
            self.queue.extend(left)
            self._wake.set()

    def _serve(self) -> None:
        while not self._closing:
            self._wake.wait()
            self._wake.clear()
            self.flush()

    def _write(self, groups: dict[RunWriteQueue, _Group]) -> None:
        while True:
            ready = {ledger: group for ledger, group in groups.items() if ledger.failure is None}
            if not ready or self.failure is not None:
                return
            try:
                self._database.store(
                    [
                        WriteBatch(ledger.run_id, ledger.epoch, group.events, group.world)
                        for ledger, group in ready.items()
                    ]
                )
            except RunRefused as error:
                refused = next(ledger for ledger in ready if ledger.run_id == error.where)
                self._fail([refused], JournalError(error.message, where=self._database.path, hint=error.hint))
                continue
            except JournalError as error:
                self._fail(ready, error)
                return
            for ledger, group in ready.items():
                ledger.durable += len(group.events)
            return

    def _fail(self, ledgers: Iterable[RunWriteQueue], error: JournalError) -> None:
        self.last_failure = error
        for ledger in ledgers:
            ledger.fail(error)


def _ledger_of(item: RunWriteQueue | CommitWaiter) -> RunWriteQueue:
    return item.ledger if isinstance(item, CommitWaiter) else item


def _unexpected(error: BaseException) -> JournalError:
    failure = JournalError(f"the journal writer broke: {type(error).__name__}: {error}", hint="report this defect")
    failure.__cause__ = error
    return failure
