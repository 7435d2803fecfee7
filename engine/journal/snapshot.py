"""A snapshot of a journal; every row is verified before it is returned."""

from __future__ import annotations

import sqlite3
import struct
from collections import Counter
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TypeVar

import msgspec

from engine.errors import JournalError
from engine.event import AnyEvent
from engine.host.sqlite_file import BoundedConnection, read_sqlite, stored_bytes
from engine.journal.batch import WorldState
from engine.journal.checksum import chain_start, checksum_of
from engine.journal.database import (
    BLOCKS_SINCE_VERSION,
    CHECKSUMS_SINCE_VERSION,
    DAMAGE_HINT,
    DRIVER_SINCE_VERSION,
    SCHEMA,
    journal_fault,
)
from engine.journal.engine_presence import living_engines
from engine.journal.event_block import EventBlock
from engine.journal.event_row import EventRow
from engine.journal.journal_port import RunOrigin, RunRecord
from engine.wording.suggestions import did_you_mean

T = TypeVar("T")

_RUNS = """
SELECT id, behavior, hash, status, epoch, started, {driver}, {checksums},
       coalesce({last}(SELECT max(seq) FROM event WHERE event.run = run.id), 0)
FROM run {join} ORDER BY started, rowid
"""
_DRIVER = "(SELECT engine FROM driver WHERE driver.run = run.id)"
_CHECKSUMS = "c.since, c.origin, c.record, c.seq, c.chain, c.world"
_LAST = "(SELECT last FROM block WHERE block.run = run.id ORDER BY seq DESC LIMIT 1), "
_JOIN = "LEFT JOIN checksum c ON c.run = run.id"
# The stored bytes of the text: an invalid text must not prevent reading the other rows.
_EVENTS = "SELECT run, seq, time_s, epoch, CAST(data AS BLOB), {checksum} FROM event WHERE run = ?"
_BLOCKS = "SELECT run, seq, last, epoch, sums, data, checksum FROM block WHERE run = ?"
_MAX_UNIX_S = 2**37


Stored = EventRow | EventBlock


class RunRow(msgspec.Struct, frozen=True, array_like=True):
    """The row of one run with its checksums; `since` is None in a file without any, 0 for a run of an older version."""

    id: str
    behavior: str
    document: str
    status: str
    epoch: int
    started_unix_s: float
    engine: str | None
    since: int | None
    origin: bytes | None
    record: bytes | None
    seq: int | None
    chain: bytes | None
    world: bytes | None
    last_seq: int

    @property
    def fault(self) -> str:
        """The inconsistency found in this row; empty when there is none."""
        if self.since is None or (self.since == 0 and (self.seq, self.chain, self.record) == (0, None, None)):
            return ""
        columns = (self.id, self.behavior, self.document, self.status, self.epoch, self.started_unix_s, self.engine)
        if self.record != checksum_of((*columns, self.since, self.origin)):
            return f"the record of run {self.id} is damaged"
        if self.last_seq != self.seq:
            return f"run {self.id} has {self.last_seq} events in the journal, and {self.seq} were written"
        return ""


class JournalSnapshot:
    """One journal file, opened for reading; used by one thread. Create it with `open_snapshot`."""

    def __init__(self, path: Path, connection: BoundedConnection) -> None:
        self.path = path
        self._connection = connection
        # All reads see the same instant, independent of concurrent writes.
        connection.execute("BEGIN")
        self._version = int(connection.execute("PRAGMA user_version").fetchone()[0])

    def runs(self) -> tuple[RunRecord, ...]:
        """Return all runs, oldest first; `damage` describes a damaged one.

        Raises:
            JournalError: the list of runs cannot be determined.
        """
        living = living_engines(self.path)
        return tuple(_record(row, living) for row in self._rows.values())

    def run(self, run_id: str) -> RunRecord:
        """Return one run.

        Raises:
            JournalError: there is no such run, or its record is damaged.
        """
        return _record(self._row(run_id), living_engines(self.path))

    def events(self, run_id: str) -> Iterator[AnyEvent]:
        """Yield the events of a run.

        Raises:
            JournalError: there is no such run, or an event is damaged or missing; the message names it.
        """
        row = self._row(run_id)
        chain, last, allowed = chain_start(run_id), 0, stored_bytes(self.path)
        for stored in self._stored(row):
            chain = self._verified(row, stored, chain)
            allowed -= len(stored.data)
            if allowed < 0:
                raise self._damaged(f"run {run_id} has more text than the whole file holds")
            last = stored.last
            yield from self._decoded(stored)
        if row.since and row.chain != chain:
            raise self._damaged(f"the events of run {run_id} end at {last}, and {row.seq} was the last")

    def last_event(self, run_id: str) -> AnyEvent | None:
        """Return the last event of a run without reading the others; None before the first.

        Raises:
            JournalError: there is no such run, or the event is damaged.
        """
        row = self._row(run_id)
        stored = self._last(row)
        if stored is None:
            return None
        chain = self._verified(row, stored, self._checksum_before(stored) or chain_start(run_id))
        if row.since and stored.last >= row.since and chain != row.chain:
            raise self._damaged(f"event {stored.last} of run {run_id} is not the last that was written")
        return self._decoded(stored)[-1]

    def origin(self, run_id: str) -> RunOrigin | None:
        """Return the start parameters of a run; None when the journal has none.

        Raises:
            JournalError: there is no such run, or the entry is damaged.
        """
        row = self._row(run_id)
        found = self._one("SELECT data FROM origin WHERE run = ?", run_id, tuple[str]) if self._version > 1 else None
        if row.since == 1 or row.origin is not None:
            now = checksum_of((run_id, found[0])) if found is not None else None
            if now != row.origin:
                raise self._damaged(f"the origin of run {run_id} is damaged: its checksum is wrong")
        if found is None:
            return None
        try:
            return msgspec.json.decode(found[0], type=RunOrigin)
        except (msgspec.DecodeError, RecursionError) as error:
            raise self._damaged(f"the origin of run {run_id} is damaged: {error}") from error

    def world(self, run_id: str) -> WorldState | None:
        """Return the state of the simulated world at the last commit of a run; None when there is none.

        Raises:
            JournalError: there is no such run, or the state is damaged.
        """
        row, query = self._row(run_id), "SELECT seq, data FROM world WHERE run = ?"
        found = self._one(query, run_id, tuple[int, bytes]) if self._version > 1 else None
        if row.since == 1 or row.world is not None:
            now = checksum_of((run_id, *found)) if found is not None else None
            if now != row.world:
                raise self._damaged(f"the simulated world of run {run_id} is damaged: its checksum is wrong")
        return WorldState(*found) if found is not None else None

    def _stored(self, row: RunRow) -> Iterator[Stored]:
        """Yield the event rows of a run: single events of an older version first, then blocks."""
        last = 0
        for found in self._connection.execute(f"{self._events} ORDER BY seq", (row.id,)):
            # A row with the right checksum has the right types; only the others must be checked.
            event = EventRow(*found) if row.since == 1 else self._typed(found, EventRow, what=_after(last, row.id))
            yield event
            last = event.seq
        if self._has_blocks:
            for found in self._connection.execute(f"{_BLOCKS} ORDER BY seq", (row.id,)):
                block = self._typed(found, EventBlock, what=_after(last, row.id))
                yield block
                last = block.last

    def _last(self, row: RunRow) -> Stored | None:
        end, what = "ORDER BY seq DESC LIMIT 1", f"the last event of run {row.id}"
        found = self._connection.execute(f"{_BLOCKS} {end}", (row.id,)).fetchone() if self._has_blocks else None
        if found is not None:
            return self._typed(found, EventBlock, what=what)
        found = self._connection.execute(f"{self._events} {end}", (row.id,)).fetchone()
        return self._typed(found, EventRow, what=what) if found is not None else None

    def _checksum_before(self, stored: Stored) -> bytes | None:
        """Return the checksum of the row before this one; None when there is no such row or checksum."""
        for table in ("block", "event") if isinstance(stored, EventBlock) else ("event",):
            query = f"SELECT {self._checksum if table == 'event' else 'checksum'} FROM {table}"  # noqa: S608 - our names
            where = "WHERE run = ? AND seq < ? ORDER BY seq DESC LIMIT 1"
            found = self._connection.execute(f"{query} {where}", (stored.run, stored.seq)).fetchone()
            if found is not None:
                what = f"the event before {stored.seq} of run {stored.run}"
                return self._typed(found, tuple[bytes | None], what=what)[0]
        return None

    @property
    def _has_blocks(self) -> bool:
        return self._version >= BLOCKS_SINCE_VERSION

    @property
    def _checksum(self) -> str:
        return "checksum" if self._version >= CHECKSUMS_SINCE_VERSION else "NULL"

    @property
    def _events(self) -> str:
        return _EVENTS.format(checksum=self._checksum)

    @cached_property
    def _rows(self) -> dict[str, RunRow]:
        checked = self._version >= CHECKSUMS_SINCE_VERSION
        query = _RUNS.format(
            driver=_DRIVER if self._version >= DRIVER_SINCE_VERSION else "NULL",
            checksums=_CHECKSUMS if checked else ", ".join(["NULL"] * 6),
            join=_JOIN if checked else "",
            last=_LAST if self._has_blocks else "",
        )
        rows = [self._typed(row, RunRow, what=f"run {row[0]!r:.80}") for row in self._connection.execute(query)]
        if checked:
            known = [str(row[0]) for row in self._connection.execute("SELECT run FROM checksum")]
            wrong = Counter(known) - Counter(row.id for row in rows) or Counter(row.id for row in rows) - Counter(known)
            if wrong:
                raise self._damaged(f"run {min(wrong)!r:.80} is in one of its tables only")
        return {row.id: row for row in rows}

    def _row(self, run_id: str) -> RunRow:
        row = self._rows.get(run_id)
        if row is None:
            raise JournalError(f"there is no run {run_id}", where=self.path, hint=did_you_mean(run_id, self._rows))
        if row.fault:
            raise self._damaged(row.fault)
        return row

    def _verified(self, row: RunRow, stored: Stored, before: bytes) -> bytes:
        """Verify a row and return the checksum that the next row is chained to."""
        try:
            has_checksum = row.since is not None and 0 < row.since <= stored.seq
            expected = stored.chained(before) if has_checksum else None
        except (TypeError, OverflowError, struct.error) as error:
            raise self._damaged(f"an event of run {row.id} is damaged: {error}") from error
        if stored.checksum != expected or stored.run != row.id:
            raise self._damaged(f"{_suspects(stored, row.id)} damaged or out of place: the checksum is wrong")
        return expected or before

    def _decoded(self, stored: Stored) -> tuple[AnyEvent, ...]:
        try:
            return stored.events()
        except JournalError as error:
            raise self._damaged(f"event {stored.seq} of run {stored.run}: {error.message}") from error

    def _one(self, query: str, run_id: str, kind: type[T]) -> T | None:
        found = self._connection.execute(query, (run_id,)).fetchone()
        return self._typed(found, kind, what=f"the stored data of run {run_id}") if found is not None else None

    def _typed(self, row: object, kind: type[T], *, what: str) -> T:
        try:
            return msgspec.convert(row, kind)
        except msgspec.ValidationError as error:
            raise self._damaged(f"{what} is damaged: {error}") from error

    def _damaged(self, what: str) -> JournalError:
        return JournalError(what, where=self.path, hint=DAMAGE_HINT)


def _after(seq: int, run: str) -> str:
    return f"the event after {seq} of run {run}"


def _suspects(stored: Stored, run: str) -> str:
    first, last = stored.suspects()
    return f"event {first} of run {run} is" if first == last else f"events {first} to {last} of run {run} are"


@contextmanager
def open_snapshot(path: Path) -> Generator[JournalSnapshot]:
    """Open a snapshot of a journal file for reading.

    Raises:
        JournalError: the file does not exist, cannot be read, or is damaged.
    """
    if not path.is_file():
        raise JournalError("there is no journal here", where=path, hint="give the directory given to --journal")
    try:
        connection = read_sqlite(path, schema=SCHEMA)
        try:
            yield JournalSnapshot(path, connection)
        finally:
            connection.close()
    except sqlite3.Error as error:
        raise journal_fault("cannot be read", path, error) from error


def _record(row: RunRow, living: Mapping[str, int]) -> RunRecord:
    started_s = row.started_unix_s
    return RunRecord(
        id=row.id,
        behavior=row.behavior,
        document=row.document,
        status=row.status,
        epoch=row.epoch,
        started_unix_s=started_s if 0 <= started_s < _MAX_UNIX_S else 0.0,
        last_seq=row.last_seq,
        driver=living.get(row.engine) if row.status == "running" and row.engine is not None else None,
        verified=row.since == 1,
        damage=row.fault,
    )
