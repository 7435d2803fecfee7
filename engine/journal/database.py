"""The SQLite file behind a journal: its tables, its transactions, and the fence between engines."""

from __future__ import annotations

import sqlite3
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from itertools import count
from operator import attrgetter, ne
from pathlib import Path
from typing import NamedTuple

import msgspec

from engine.errors import JournalError
from engine.event import Event, RunEnded
from engine.host.sqlite_file import advice, open_sqlite
from engine.host.sqlite_migrations import SqliteMigrations
from engine.journal.batch import NewRun, WriteBatch
from engine.journal.checksum import chain_start, checksum_of
from engine.journal.event_block import EventBlock, new_blocks

SCHEMA = SqliteMigrations(
    (
        """
CREATE TABLE IF NOT EXISTS run(
    id TEXT PRIMARY KEY, behavior TEXT NOT NULL, hash TEXT NOT NULL, status TEXT NOT NULL,
    epoch INTEGER NOT NULL, started REAL NOT NULL) STRICT;
CREATE TABLE IF NOT EXISTS event(
    run TEXT NOT NULL, seq INTEGER NOT NULL, time_s REAL NOT NULL, epoch INTEGER NOT NULL, data TEXT NOT NULL,
    PRIMARY KEY (run, seq)) STRICT, WITHOUT ROWID;
""",
        """
CREATE TABLE IF NOT EXISTS origin(run TEXT PRIMARY KEY, data TEXT NOT NULL) STRICT;
CREATE TABLE IF NOT EXISTS world(run TEXT PRIMARY KEY, seq INTEGER NOT NULL, data BLOB NOT NULL) STRICT;
""",
        """
CREATE TABLE IF NOT EXISTS driver(run TEXT PRIMARY KEY, engine TEXT NOT NULL) STRICT;
""",
        # A run of an older version has a row without checksums; the chain starts at event `since`.
        """
ALTER TABLE event ADD COLUMN checksum BLOB;
CREATE TABLE checksum(
    run TEXT PRIMARY KEY, since INTEGER NOT NULL, seq INTEGER NOT NULL, chain BLOB, record BLOB, origin BLOB,
    world BLOB) STRICT, WITHOUT ROWID;
INSERT INTO checksum(run, since, seq) SELECT id, 0, 0 FROM run;
""",
        # From this version on events are written in blocks; rows of older events stay unchanged.
        """
CREATE TABLE block(
    run TEXT NOT NULL, seq INTEGER NOT NULL, last INTEGER NOT NULL, epoch INTEGER NOT NULL, sums BLOB NOT NULL,
    data BLOB NOT NULL, checksum BLOB NOT NULL, PRIMARY KEY (run, seq)) STRICT;
""",
    )
)
BLOCKS_SINCE_VERSION = 5
CHECKSUMS_SINCE_VERSION = 4
DRIVER_SINCE_VERSION = 3
_INSERT_BLOCK = "INSERT INTO block(run, seq, last, epoch, sums, data, checksum) VALUES (?, ?, ?, ?, ?, ?, ?)"
_LAST_SEQ = """
SELECT coalesce((SELECT last FROM block WHERE run = ?1 ORDER BY seq DESC LIMIT 1),
                (SELECT max(seq) FROM event WHERE run = ?1), 0)
"""
_seq_of = attrgetter("seq")
_SET_DRIVER = "INSERT OR REPLACE INTO driver(run, engine) VALUES (?, ?)"
_RECORD = """
SELECT id, behavior, hash, status, epoch, started, (SELECT engine FROM driver WHERE driver.run = run.id),
       checksum.since, checksum.origin, checksum.record
FROM run LEFT JOIN checksum ON checksum.run = run.id WHERE run.id = ?
"""

DAMAGE_HINT = "restore a copy of the journal, or move it away"


class _End(NamedTuple):
    """The end of a run's events: the number of the last event, and the checksum that the next row is chained to."""

    seq: int
    chain: bytes


class RunRefused(JournalError):
    """The events of one run cannot be stored; other runs are not affected."""


class JournalDatabase:
    """One open journal file; used by one thread at a time."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection
        self._ends: dict[str, _End] = {}
        """The end of each run that this engine drives."""

    @classmethod
    def open(cls, path: Path, *, busy_timeout_s: float) -> JournalDatabase:
        """Open or create the file; raises JournalError with the path and a hint."""
        try:
            connection = open_sqlite(path, schema=SCHEMA, busy_timeout_s=busy_timeout_s)
        except (sqlite3.Error, OSError) as error:
            raise journal_fault("cannot be opened", path, error) from error
        return cls(path, connection)

    def take_over_run(self, run_id: str, *, engine: str) -> int:
        """Make this engine the only writer of the run; return the new epoch."""
        with self._writing() as connection:
            try:
                self._require_undamaged(run_id)
            except RunRefused as error:
                raise JournalError(error.message, where=self.path, hint=error.hint) from error
            row = connection.execute(
                "UPDATE run SET epoch = epoch + 1, status = 'running' WHERE id = ? RETURNING epoch", (run_id,)
            ).fetchone()
            if row is None:
                raise JournalError(f"there is no run {run_id}", where=self.path, hint="`flexcell runs` lists them")
            connection.execute(_SET_DRIVER, (run_id, engine))
            end = self._end(run_id)
            self._seal(run_id)
        self._ends[run_id] = end
        return int(row[0])

    def store(self, batches: Sequence[WriteBatch]) -> None:
        """Write the batches of several runs in one durable transaction.

        Raises:
            RunRefused: one run must not write, or its events are out of order; nothing is written.
            JournalError: the file cannot be written; nothing is written.
        """
        encoded = [(each, _blocks(each, self._end_before(each))) for each in batches]
        with self._writing():
            for each, blocks in encoded:
                if each.new is not None:
                    self._insert_run(each.run, each.epoch, each.new)
                self._check_fence(each.run, each.epoch)
                self._insert_blocks(each.run, blocks)
                self._store_status(each.run, each.events)
                self._store_world(each)
        for each, blocks in encoded:
            if blocks:
                self._ends[each.run] = _End(blocks[-1].last, blocks[-1].checksum)
            elif each.new is not None:
                self._ends[each.run] = self._end_before(each)

    def close(self) -> None:
        """Release the file."""
        self._connection.close()

    def _end_before(self, batch: WriteBatch) -> _End:
        return _End(0, chain_start(batch.run)) if batch.new is not None else self._ends[batch.run]

    def _insert_run(self, run_id: str, epoch: int, new: NewRun) -> None:
        """Insert a run with status running."""
        text = msgspec.json.encode(new.origin).decode() if new.origin is not None else None
        origin_checksum = checksum_of((run_id, text)) if text is not None else None
        try:
            self._connection.execute(
                "INSERT INTO run(id, behavior, hash, status, epoch, started) VALUES (?, ?, ?, 'running', ?, ?)",
                (run_id, new.behavior, new.document, epoch, new.started_unix_s),
            )
        except sqlite3.IntegrityError as error:
            raise RunRefused(f"run {run_id} already exists", where=run_id, hint="resume it") from error
        if text is not None:
            self._connection.execute("INSERT INTO origin(run, data) VALUES (?, ?)", (run_id, text))
        self._connection.execute(_SET_DRIVER, (run_id, new.engine))
        self._connection.execute(
            "INSERT INTO checksum(run, since, seq, chain, origin) VALUES (?, 1, 0, ?, ?)",
            (run_id, chain_start(run_id), origin_checksum),
        )
        self._seal(run_id)

    def _check_fence(self, run: str, epoch: int) -> None:
        row = self._connection.execute("SELECT epoch FROM run WHERE id = ?", (run,)).fetchone()
        if row is None or int(row[0]) != epoch:
            state = "has been removed" if row is None else f"is driven by another engine now (epoch {row[0]})"
            raise RunRefused(
                f"run {run} {state}; this engine (epoch {epoch}) must not write to it",
                where=run,
                hint="stop this engine: the other one has resumed the run",
            )

    def _insert_blocks(self, run: str, blocks: Sequence[EventBlock]) -> None:
        if not blocks:
            return
        try:
            self._connection.executemany(_INSERT_BLOCK, map(msgspec.structs.astuple, blocks))
        except sqlite3.IntegrityError as error:
            raise RunRefused(f"an event from seq {blocks[0].seq} on is already stored: {error}", where=run) from error
        end = blocks[-1]
        self._connection.execute("UPDATE checksum SET seq = ?, chain = ? WHERE run = ?", (end.last, end.checksum, run))

    def _store_world(self, batch: WriteBatch) -> None:
        if batch.world is not None:
            row = (batch.run, batch.world.seq, batch.world.data)
            self._connection.execute("INSERT OR REPLACE INTO world(run, seq, data) VALUES (?, ?, ?)", row)
            self._connection.execute("UPDATE checksum SET world = ? WHERE run = ?", (checksum_of(row), batch.run))

    def _store_status(self, run: str, events: Sequence[Event]) -> None:
        # Such an event is rare, and this is the cheapest test for one.
        if RunEnded not in map(type, events):
            return
        for event in events:
            if isinstance(event, RunEnded):
                self._require_undamaged(run)
                self._connection.execute("UPDATE run SET status = ? WHERE id = ?", (event.status, run))
                self._seal(run)

    def _seal(self, run: str) -> None:
        """Store the checksum of the present record of a run."""
        row = self._connection.execute(_RECORD, (run,)).fetchone()
        self._connection.execute("UPDATE checksum SET record = ? WHERE run = ?", (checksum_of(row[:-1]), run))

    def _require_undamaged(self, run: str) -> None:
        """Refuse to compute a checksum over a damaged record."""
        row = self._connection.execute(_RECORD, (run,)).fetchone()
        if row is not None and row[-1] is not None and row[-1] != checksum_of(row[:-1]):
            raise RunRefused(f"the record of run {run} is damaged", where=run, hint=DAMAGE_HINT)

    def _end(self, run: str) -> _End:
        """Return the end of a run; the chain of a run of an older version starts here."""
        row = self._connection.execute("SELECT seq, chain FROM checksum WHERE run = ?", (run,)).fetchone()
        last = int(self._connection.execute(_LAST_SEQ, (run,)).fetchone()[0])
        if row is not None and row[1] is not None:
            if last != row[0]:
                raise JournalError(
                    f"run {run} has {last} events in the journal, and {row[0]} were written",
                    where=self.path,
                    hint=DAMAGE_HINT,
                )
            return _End(last, bytes(row[1]))
        self._connection.execute(
            "UPDATE checksum SET since = ?, seq = ?, chain = ? WHERE run = ?", (last + 1, last, chain_start(run), run)
        )
        return _End(last, chain_start(run))

    @contextmanager
    def _writing(self) -> Generator[sqlite3.Connection]:
        """Open a transaction: at its end either everything that the block wrote is durable, or nothing.

        Raises:
            JournalError: the file cannot be written.
        """
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            yield self._connection
            self._connection.execute("COMMIT")
        except sqlite3.Error as error:
            raise journal_fault("cannot be written", self.path, error) from error
        finally:
            # After any error no transaction may stay open.
            if self._connection.in_transaction:
                self._connection.rollback()


def journal_fault(what: str, path: Path, error: sqlite3.Error | OSError) -> JournalError:
    """Return the JournalError of an SQLite error, with the file and advice."""
    return JournalError(f"the journal {what}: {error}", where=path, hint=advice(error))


def _blocks(batch: WriteBatch, end: _End) -> list[EventBlock]:
    """Return the rows of the events of a batch, which must follow the last stored event."""
    events = batch.events
    if not events:
        return []
    if any(map(ne, map(_seq_of, events), count(end.seq + 1))):
        raise RunRefused(_out_of_order(events, end.seq + 1), where=batch.run, hint="report this defect")
    try:
        return list(new_blocks(batch.run, batch.epoch, events, end.chain))
    except JournalError as error:
        raise RunRefused(error.message, where=batch.run, hint=error.hint) from error


def _out_of_order(events: Sequence[Event], expected: int) -> str:
    number, event = next((n, event) for n, event in enumerate(events, expected) if event.seq != n)
    if event.seq < number:
        return f"event {event.seq} is already stored"
    return f"event {event.seq} arrived where event {number} was expected"
