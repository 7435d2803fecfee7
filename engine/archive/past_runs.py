"""The runs of a journal, each with how it ended; what is over is read once."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Callable
from pathlib import Path

import msgspec

from engine.cause import describe
from engine.errors import JournalError
from engine.event import RunEnded
from engine.journal import decode_event, journal_path
from engine.journal.database import journal_fault
from engine.sqlite_file import read_sqlite

_RUNS = "SELECT id, behavior, hash, started, epoch FROM run ORDER BY started DESC, rowid DESC"
_LAST = "SELECT data, time_s, seq FROM event WHERE run = ? ORDER BY seq DESC LIMIT 1"


class PastRun(msgspec.Struct, frozen=True, kw_only=True):
    """A run as its journal tells it; `status` is running, finished, stopped or errored.

    `behavior` is what the behavior calls itself. `running` is a run that has no end in the journal: it is under way
    somewhere, or its engine died.
    """

    id: str
    behavior: str
    document: str
    """The hash of what the behavior meant."""
    status: str
    outcome: str | None
    success: bool
    cause: str
    started_at_s: float
    duration_s: float
    """On the run's own clock."""
    events: int

    @property
    def failed(self) -> bool:
        """Whether it ended badly."""
        return self.status == "errored" or (self.status == "finished" and not self.success)


class PastRuns:
    """The runs of one journal; may be used from any thread.

    Args:
        place: The directory or file of the journal; there need not be one.
        success: Tells the outcomes that meant success to a behavior, by a run and its document hash; none if unknown.
    """

    def __init__(self, place: Path, *, success: Callable[[str, str], tuple[str, ...]]) -> None:
        self._path = journal_path(place)
        self._success = success
        self._lock = threading.Lock()
        self._over: dict[tuple[str, int], PastRun] = {}

    def all(self) -> tuple[PastRun, ...]:
        """Return all runs, newest first; none where there is no journal.

        Raises:
            JournalError: the journal cannot be read.
        """
        if not self._path.is_file():
            return ()
        try:
            connection = read_sqlite(self._path)
            try:
                rows = connection.execute(_RUNS).fetchall()
                return tuple(self._run(connection, row) for row in rows)
            finally:
                connection.close()
        except sqlite3.Error as error:
            raise journal_fault("cannot be read", self._path, error) from error

    def _run(self, connection: sqlite3.Connection, row: tuple[object, ...]) -> PastRun:
        run, behavior, document, started, epoch = row
        # A run that was resumed is another one: it has more events.
        key = (str(run), int(str(epoch)))
        with self._lock:
            known = self._over.get(key)
        if known is not None:
            return known
        made = self._read(connection, str(run), str(behavior), str(document), float(str(started)))
        if made.status != "running":
            with self._lock:
                self._over[key] = made
        return made

    def _read(
        self, connection: sqlite3.Connection, run: str, behavior: str, document: str, started_at_s: float
    ) -> PastRun:
        last = connection.execute(_LAST, (run,)).fetchone()
        data, time_s, seq = last if last is not None else ("", 0.0, 0)
        ended = _end(str(data))
        outcome = ended.outcome if ended is not None else None
        meant = self._success(run, document) if ended is not None else ()
        success = ended is not None and is_success(ended, meant)
        return PastRun(
            id=run,
            behavior=behavior,
            document=document,
            status=ended.status if ended is not None else "running",
            outcome=outcome,
            success=success,
            cause=describe(ended.cause) if ended is not None and ended.cause is not None and not success else "",
            started_at_s=started_at_s,
            duration_s=float(time_s),
            events=int(seq),
        )


def is_success(end: RunEnded, meant: tuple[str, ...]) -> bool:
    """Tell whether a run ended well: with an outcome that meant success; where that is not known, without a cause."""
    if end.status != "finished":
        return False
    return end.outcome in meant if meant else end.cause is None


def _end(data: str) -> RunEnded | None:
    try:
        event = decode_event(data) if data else None
    except JournalError:
        # One damaged run is no reason to hide the others; opening it says what is wrong.
        return None
    return event if isinstance(event, RunEnded) else None
