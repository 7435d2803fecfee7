"""Reads a journal without writing to it: for timelines, run reports, replay and resuming."""

from __future__ import annotations

import sqlite3
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import msgspec

from engine.errors import JournalError
from engine.event import AnyEvent
from engine.journal.batch import WorldState
from engine.journal.codec import decode_event
from engine.journal.database import journal_fault
from engine.journal.journal import journal_path
from engine.journal.port import RunOrigin, RunRecord
from engine.journal.presence import living_engines
from engine.nearness import near_names
from engine.sqlite_file import read_sqlite

_RUNS = """
SELECT id, behavior, hash, status, epoch, started,
       coalesce((SELECT max(seq) FROM event WHERE event.run = run.id), 0), {driver} FROM run ORDER BY started, rowid
"""
_DRIVER = "(SELECT engine FROM driver WHERE driver.run = run.id)"
_DRIVER_SINCE_VERSION = 3


def list_runs(place: Path | str) -> tuple[RunRecord, ...]:
    """Return the runs of a journal directory or file, oldest first.

    Raises:
        JournalError: there is no journal, or it cannot be read.
    """
    with _reading(place) as connection:
        living = living_engines(journal_path(place))
        return tuple(
            RunRecord(
                id=str(run),
                behavior=str(behavior),
                document=str(document),
                status=str(status),
                epoch=int(epoch),
                started_unix_s=float(started),
                last_seq=int(last),
                driver=living.get(str(engine)) if status == "running" else None,
            )
            for run, behavior, document, status, epoch, started, last, engine in connection.execute(_runs(connection))
        )


def find_run(place: Path | str, run_id: str) -> RunRecord:
    """Return one run.

    Raises:
        JournalError: there is no such journal or run.
    """
    runs = {record.id: record for record in list_runs(place)}
    if run_id not in runs:
        raise JournalError(f"there is no run {run_id}", where=journal_path(place), hint=near_names(run_id, runs))
    return runs[run_id]


def read_events(place: Path | str, run_id: str) -> tuple[AnyEvent, ...]:
    """Return the durable events of a run by `seq`; empty when it stored none yet.

    Raises:
        JournalError: there is no such journal or run, or a stored event is damaged.
    """
    with _reading(place) as connection:
        known = [str(row[0]) for row in connection.execute("SELECT id FROM run ORDER BY started")]
        if run_id not in known:
            raise JournalError(f"there is no run {run_id}", where=journal_path(place), hint=near_names(run_id, known))
        rows = connection.execute("SELECT data FROM event WHERE run = ? ORDER BY seq", (run_id,))
        return tuple(decode_event(str(row[0])) for row in rows)


def read_origin(place: Path | str, run_id: str) -> RunOrigin | None:
    """Return how a run was started; None where the journal does not know.

    Raises:
        JournalError: the journal cannot be read, or the entry is damaged.
    """
    with _reading(place) as connection:
        row = connection.execute("SELECT data FROM origin WHERE run = ?", (run_id,)).fetchone()
    if row is None:
        return None
    try:
        return msgspec.json.decode(str(row[0]), type=RunOrigin)
    except msgspec.DecodeError as error:
        raise JournalError(f"the origin of run {run_id} is damaged: {error}", where=journal_path(place)) from error


def read_world(place: Path | str, run_id: str) -> WorldState | None:
    """Return the simulated world as the last commit of a run left it; None where there was none.

    Raises:
        JournalError: the journal cannot be read.
    """
    with _reading(place) as connection:
        row = connection.execute("SELECT seq, data FROM world WHERE run = ?", (run_id,)).fetchone()
    return WorldState(int(row[0]), bytes(row[1])) if row is not None else None


def _runs(connection: sqlite3.Connection) -> str:
    """Return the query; a journal that only older versions have written knows no engines."""
    version = int(connection.execute("PRAGMA user_version").fetchone()[0])
    return _RUNS.format(driver=_DRIVER if version >= _DRIVER_SINCE_VERSION else "NULL")


@contextmanager
def _reading(place: Path | str) -> Generator[sqlite3.Connection]:
    path = journal_path(place)
    if not path.is_file():
        raise JournalError("there is no journal here", where=path, hint="give the directory given to --journal")
    try:
        connection = read_sqlite(path)
        try:
            yield connection
        finally:
            connection.close()
    except sqlite3.Error as error:
        raise journal_fault("cannot be read", path, error) from error
