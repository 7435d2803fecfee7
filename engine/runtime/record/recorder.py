"""Records the events of one run: numbers them, journals them, and passes them to watchers."""

from __future__ import annotations

import itertools
import logging
from collections.abc import Callable
from typing import Concatenate, ParamSpec

from engine.cause_chain import escape_surrogates
from engine.clock import Clock
from engine.errors import Cause, JournalError
from engine.event import Event, MessageLogged, RunEnded
from engine.journal import NullRunJournal, RunJournal

P = ParamSpec("P")
Watcher = Callable[[Event], None]
_log = logging.getLogger("flexcell.run")


class Recorder:
    """Numbers, journals and publishes the events of one run, on the loop thread.

    Args:
        clock: The clock of the run.
        journal: Durable store of the events.
        after_seq: The number of the last event of a resumed run.
        after_s: The time of that event.
    """

    def __init__(self, clock: Clock, journal: RunJournal, *, after_seq: int = 0, after_s: float = 0.0) -> None:
        self._clock_now_s = clock.now_s
        self._journal = journal
        self._append = journal.append
        self._after_s = after_s
        self._start_s = clock.now_s() - after_s
        self._keeps = not isinstance(journal, NullRunJournal)
        self._watchers: tuple[Watcher, ...] = ()
        self._numbers = itertools.count(after_seq + 1)
        self.count: Callable[[], int] = self._numbers.__next__
        """Number an event without recipients, like `emit` without its fields; for hot paths."""
        self.heard = self._keeps
        """Whether events are stored or watched; otherwise they are only numbered."""
        self.ended = False
        """True once the end of the run is recorded; later events of abandoned states are dropped."""

    def begin(self) -> None:
        """Let the time of the run begin now: what was prepared may wait for its start."""
        self._start_s = self._clock_now_s() - self._after_s

    def now_s(self) -> float:
        """Seconds since the start of the run, rounded to microseconds so that equal instants print equally."""
        # Rounding to a whole number costs half of `round(…, 6)`, and every event calls this.
        return round((self._clock_now_s() - self._start_s) * 1e6) / 1e6

    def emit(self, event: Callable[Concatenate[int, float, P], Event], /, *_: P.args, **fields: P.kwargs) -> None:
        """Record the next event of this class, numbered and timed; without recipients it is only numbered."""
        if self.heard and not self.ended:
            seq, time_s = self.stamp()
            self.record(event(seq, time_s, *_, **fields))
        else:
            self.count()

    def stamp(self) -> tuple[int, float]:
        """Return number and time of the next event, which the caller makes and records: half the cost of `emit`."""
        return self.count(), self.now_s()

    def record(self, event: Event) -> None:
        """Store and publish an event that was created with the last stamp."""
        if not self.ended:
            self._append(event)
            if self._watchers:
                self.publish(event)

    def log(self, path: str, message: str, *, level: str = "info") -> None:
        """Write a message about a node into the event log; about the run as a whole where `path` is empty."""
        self.emit(MessageLogged, path=path, level=level, message=escape_surrogates(message))

    def end(self, status: str, outcome: str | None, cause: Cause | None) -> RunEnded:
        """Record the last event and return it, for `publish` once it is known whether it could be stored."""
        event = RunEnded(*self.stamp(), status=status, outcome=outcome, cause=cause)
        self._journal.append(event)
        self.ended = True
        return event

    def publish(self, event: Event) -> None:
        """Pass an event to all watchers."""
        for watcher in self._watchers:
            try:
                watcher(event)
            except Exception:
                # A watcher may raise any exception; the run must continue.
                _log.exception("a watcher of the run failed and was removed")
                self.unwatch(watcher)

    def watch(self, watcher: Watcher) -> None:
        """Call `watcher` with every event from now on."""
        self._watchers = (*self._watchers, watcher)
        self.heard = True

    def unwatch(self, watcher: Watcher) -> None:
        """Stop calling `watcher`."""
        self._watchers = tuple(w for w in self._watchers if w is not watcher)
        self.heard = self._keeps or bool(self._watchers)

    def on_lost(self, listener: Callable[[JournalError], None]) -> None:
        """Call `listener` when recorded events cannot be made durable and no commit is pending to raise the error."""
        self._journal.on_failure(listener)

    async def apply_backpressure(self) -> None:
        """Wait for the journal where it lags far behind; call it regularly while events are recorded without a wait.

        Raises:
            JournalError: it cannot be written; the run must stop.
        """
        await self._journal.apply_backpressure()

    def append_world_state(self, state: bytes) -> None:
        """Store the state of the simulated world with the next commit."""
        self._journal.append_world_state(state)

    async def commit(self) -> None:
        """Make the recorded events durable; required before any effect leaves the engine.

        Raises:
            JournalError: it cannot be written; the run must stop.
        """
        await self._journal.commit()
