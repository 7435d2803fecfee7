"""The runs of a journal, each with how it ended; what is over is read once."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import msgspec

from engine.cause_chain import describe_cause
from engine.errors import JournalError
from engine.event import RunEnded
from engine.journal import JournalSnapshot, RunRecord, journal_path, open_snapshot


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
        """Return all runs, newest first; none where there is no journal. A damaged one is errored, with that cause.

        Raises:
            JournalError: the journal cannot be read.
        """
        if not self._path.is_file():
            return ()
        with open_snapshot(self._path) as journal:
            return tuple(self._run(journal, record) for record in reversed(journal.runs()))

    def _run(self, journal: JournalSnapshot, record: RunRecord) -> PastRun:
        # A run that was resumed is another one: it has more events.
        key = (record.id, record.epoch)
        with self._lock:
            known = self._over.get(key)
        if known is not None and not record.damage:
            return known
        made = self._read(journal, record)
        if made.status != "running":
            with self._lock:
                self._over[key] = made
        return made

    def _read(self, journal: JournalSnapshot, record: RunRecord) -> PastRun:
        try:
            last = journal.last_event(record.id)
        except JournalError as error:
            # One damaged run is no reason to hide the others.
            return _past_run(record, status="errored", cause=error.message)
        if not isinstance(last, RunEnded):
            return _past_run(record, duration_s=last.time_s if last is not None else 0.0)
        success = is_success(last, self._success(record.id, record.document))
        return _past_run(
            record,
            status=last.status,
            outcome=last.outcome,
            success=success,
            cause=describe_cause(last.cause) if last.cause is not None and not success else "",
            duration_s=last.time_s,
        )


def _past_run(
    record: RunRecord,
    *,
    status: str = "running",
    outcome: str | None = None,
    success: bool = False,
    cause: str = "",
    duration_s: float = 0.0,
) -> PastRun:
    return PastRun(
        id=record.id,
        behavior=record.behavior,
        document=record.document,
        status=status,
        outcome=outcome,
        success=success,
        cause=cause,
        started_at_s=record.started_unix_s,
        duration_s=duration_s,
        events=record.last_seq,
    )


def is_success(end: RunEnded, meant: tuple[str, ...]) -> bool:
    """Tell whether a run ended well: with an outcome that meant success; where that is not known, without a cause."""
    if end.status != "finished":
        return False
    return end.outcome in meant if meant else end.cause is None
