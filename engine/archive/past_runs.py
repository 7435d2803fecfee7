"""The runs of a journal with their results; each ended run is read once."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

from engine.cause_chain import describe_cause
from engine.errors import JournalError
from engine.event import RunEnded
from engine.journal import JournalSnapshot, RunRecord, journal_path, open_snapshot
from engine.runtime.history.run_view import RunView, run_duration_s


class PastRun(RunView, frozen=True, kw_only=True):
    """A run in its journal; `status` is running, finished, stopped or errored.

    A run with status `running` has no end in the journal: it is active in another process, or its process died.
    `document` is the semantic hash of the behavior, `events` the number of events.
    """

    document: str
    events: int

    @property
    def failed(self) -> bool:
        """Whether it ended without success."""
        return self.status == "errored" or (self.status == "finished" and not self.success)


class PastRuns:
    """The runs of one journal; thread-safe.

    Args:
        place: The folder or file of the journal; it may be missing.
        success: Returns the success outcomes of a behavior, by a run and its document hash; empty if unknown.
    """

    def __init__(self, place: Path, *, success: Callable[[str, str], tuple[str, ...]]) -> None:
        self._path = journal_path(place)
        self._success = success
        self._lock = threading.Lock()
        self._over: dict[tuple[str, int], PastRun] = {}

    def all(self) -> tuple[PastRun, ...]:
        """Return all runs, newest first; empty without a journal. A damaged run is errored, with that cause.

        Raises:
            JournalError: the journal cannot be read.
        """
        if not self._path.is_file():
            return ()
        with open_snapshot(self._path) as journal:
            return tuple(self._run(journal, record) for record in reversed(journal.runs()))

    def _run(self, journal: JournalSnapshot, record: RunRecord) -> PastRun:
        # A resumed run must be read again: it has more events.
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
            # A damaged run must not hide the others.
            return _past_run(record, status="errored", cause=error.message)
        if not isinstance(last, RunEnded):
            return _past_run(record, duration_s=run_duration_s(last))
        success = is_success(last, self._success(record.id, record.document))
        return _past_run(
            record,
            status=last.status,
            outcome=last.outcome,
            success=success,
            cause=describe_cause(last.cause) if last.cause is not None and not success else "",
            duration_s=run_duration_s(last),
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
    """Return whether a run ended with a success outcome or, if these are unknown, without a cause."""
    if end.status != "finished":
        return False
    return end.outcome in meant if meant else end.cause is None
