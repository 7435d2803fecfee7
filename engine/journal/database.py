"""The SQLite file behind a journal: its tables, its transactions, and the fence between engines."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from pathlib import Path

import msgspec

from engine.errors import JournalError
from engine.event import Event, RunEnded
from engine.journal.batch import Batch
from engine.journal.codec import encode_event
from engine.journal.port import RunOrigin
from engine.sqlite_file import advice, open_sqlite

SCHEMA_VERSION = 3
_SCHEMA = """
CREATE TABLE IF NOT EXISTS run(
    id TEXT PRIMARY KEY, behavior TEXT NOT NULL, hash TEXT NOT NULL, status TEXT NOT NULL,
    epoch INTEGER NOT NULL, started REAL NOT NULL) STRICT;
CREATE TABLE IF NOT EXISTS event(
    run TEXT NOT NULL, seq INTEGER NOT NULL, time_s REAL NOT NULL, epoch INTEGER NOT NULL, data TEXT NOT NULL,
    PRIMARY KEY (run, seq)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS origin(run TEXT PRIMARY KEY, data TEXT NOT NULL) STRICT;
CREATE TABLE IF NOT EXISTS world(run TEXT PRIMARY KEY, seq INTEGER NOT NULL, data BLOB NOT NULL) STRICT;
CREATE TABLE IF NOT EXISTS driver(run TEXT PRIMARY KEY, engine TEXT NOT NULL) STRICT;
"""
_INSERT_EVENT = "INSERT INTO event(run, seq, time_s, epoch, data) VALUES (?, ?, ?, ?, ?)"
_SET_DRIVER = "INSERT OR REPLACE INTO driver(run, engine) VALUES (?, ?)"


class RunRefused(JournalError):
    """The events of one run cannot be stored; those of the other runs can."""


class JournalDatabase:
    """One open journal file; used by one thread at a time."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    @classmethod
    def open(cls, path: Path, *, busy_timeout_s: float) -> JournalDatabase:
        """Open or create the file; raises JournalError with the path and what to do."""
        try:
            connection = open_sqlite(path, schema=_SCHEMA, version=SCHEMA_VERSION, busy_timeout_s=busy_timeout_s)
        except (sqlite3.Error, OSError) as error:
            raise journal_fault("cannot be opened", path, error) from error
        return cls(path, connection)

    def insert_run(
        self,
        run_id: str,
        *,
        behavior: str,
        document: str,
        started_unix_s: float,
        origin: RunOrigin | None,
        engine: str,
    ) -> int:
        """Store a new run as running, driven by `engine`; return its epoch."""
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            self._connection.execute(
                "INSERT INTO run(id, behavior, hash, status, epoch, started) VALUES (?, ?, ?, 'running', 1, ?)",
                (run_id, behavior, document, started_unix_s),
            )
            if origin is not None:
                text = msgspec.json.encode(origin).decode()
                self._connection.execute("INSERT INTO origin(run, data) VALUES (?, ?)", (run_id, text))
            self._connection.execute(_SET_DRIVER, (run_id, engine))
            self._connection.execute("COMMIT")
        except sqlite3.IntegrityError as error:
            raise JournalError(f"run {run_id} is there already", where=self.path, hint="resume it") from error
        except sqlite3.Error as error:
            raise journal_fault("cannot be written", self.path, error) from error
        finally:
            if self._connection.in_transaction:
                self._connection.rollback()
        return 1

    def take_over_run(self, run_id: str, *, engine: str) -> int:
        """Make this engine the only one that may write to the run; return the new epoch."""
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            row = self._connection.execute(
                "UPDATE run SET epoch = epoch + 1, status = 'running' WHERE id = ? RETURNING epoch", (run_id,)
            ).fetchone()
            if row is not None:
                self._connection.execute(_SET_DRIVER, (run_id, engine))
            self._connection.execute("COMMIT")
        except sqlite3.Error as error:
            raise journal_fault("cannot be written", self.path, error) from error
        finally:
            if self._connection.in_transaction:
                self._connection.rollback()
        if row is None:
            raise JournalError(f"there is no run {run_id}", where=self.path, hint="`flexcell runs` lists them")
        return int(row[0])

    def store(self, batches: Sequence[Batch]) -> None:
        """Write what several runs have, in one durable transaction.

        Raises:
            RunRefused: one run may not write or gave an event twice; nothing was written.
            JournalError: the file cannot be written; nothing was.
        """
        rows = [(each.run, each.epoch, _rows(each.run, each.epoch, each.events)) for each in batches]
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            for run, epoch, events in rows:
                self._check_fence(run, epoch)
                self._insert_events(run, events)
            for each in batches:
                self._store_status(each.run, each.events)
                self._store_world(each)
            self._connection.execute("COMMIT")
        except sqlite3.Error as error:
            raise journal_fault("cannot be written", self.path, error) from error
        finally:
            # Whatever went wrong, the next transaction must find none open.
            if self._connection.in_transaction:
                self._connection.rollback()

    def close(self) -> None:
        """Release the file."""
        self._connection.close()

    def _check_fence(self, run: str, epoch: int) -> None:
        row = self._connection.execute("SELECT epoch FROM run WHERE id = ?", (run,)).fetchone()
        if row is None or int(row[0]) != epoch:
            now = "has been removed" if row is None else f"is driven by another engine now (epoch {row[0]})"
            raise RunRefused(
                f"run {run} {now}; this one (epoch {epoch}) may not write any more",
                where=run,
                hint="stop this engine: the other one has resumed the run",
            )

    def _insert_events(self, run: str, rows: Sequence[tuple[str, int, float, int, str]]) -> None:
        try:
            self._connection.executemany(_INSERT_EVENT, rows)
        except sqlite3.IntegrityError as error:
            raise RunRefused(f"an event from seq {rows[0][1]} on is stored already: {error}", where=run) from error

    def _store_world(self, batch: Batch) -> None:
        if batch.world is not None:
            row = (batch.run, batch.world.seq, batch.world.data)
            self._connection.execute("INSERT OR REPLACE INTO world(run, seq, data) VALUES (?, ?, ?)", row)

    def _store_status(self, run: str, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, RunEnded):
                self._connection.execute("UPDATE run SET status = ? WHERE id = ?", (event.status, run))


def journal_fault(what: str, path: Path, error: sqlite3.Error | OSError) -> JournalError:
    """Word an error of SQLite: what, which file, what to do."""
    return JournalError(f"the journal {what}: {error}", where=path, hint=advice(error))


def _rows(run: str, epoch: int, events: Sequence[Event]) -> list[tuple[str, int, float, int, str]]:
    try:
        return [(run, e.seq, e.time_s, epoch, encode_event(e).decode()) for e in events]
    except JournalError as error:
        raise RunRefused(error.message, where=run, hint=error.hint) from error
