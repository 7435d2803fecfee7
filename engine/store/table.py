"""The SQLite tables of the store and the plain, blocking operations on them."""

from __future__ import annotations

import sqlite3
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec

from engine.errors import EntryConflict, EntryNotFound, StoreError
from engine.nearness import near_names
from engine.sqlite_file import advice, open_sqlite

_VERSION = 1
_SCHEMA = """
CREATE TABLE IF NOT EXISTS entry(
    kind TEXT NOT NULL, name TEXT NOT NULL, revision INTEGER NOT NULL, value TEXT NOT NULL,
    PRIMARY KEY (kind, name)) STRICT;
CREATE TABLE IF NOT EXISTS change(
    seq INTEGER PRIMARY KEY AUTOINCREMENT, kind TEXT NOT NULL, name TEXT NOT NULL,
    revision INTEGER NOT NULL, value TEXT, UNIQUE (kind, name, revision)) STRICT;
"""
_UPSERT = """
INSERT INTO entry(kind, name, revision, value) VALUES (?, ?, ?, ?)
ON CONFLICT(kind, name) DO UPDATE SET revision = excluded.revision, value = excluded.value
"""


class Row(msgspec.Struct, frozen=True):
    """An entry or a change of it as stored: `value` is JSON, None for a deletion."""

    kind: str
    name: str
    revision: int
    value: str | None


class EntryTable:
    """One open store file; used by one thread at a time."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    @classmethod
    def open(cls, path: Path, *, busy_timeout_s: float) -> EntryTable:
        """Open or create the file; raises StoreError with the path and what to do."""
        try:
            connection = open_sqlite(path, schema=_SCHEMA, version=_VERSION, busy_timeout_s=busy_timeout_s)
        except (sqlite3.Error, OSError) as error:
            raise StoreError(f"the store cannot be opened: {error}", where=path, hint=advice(error)) from error
        return cls(path, connection)

    def get(self, kind: str, name: str) -> Row:
        """Return an entry or raise EntryNotFound with the near names."""
        with self._explained("cannot be read"):
            found = self._find(kind, name)
        if found is None:
            raise self._not_found(kind, name)
        return found

    def select(self, kind: str, prefix: str, *, values: bool) -> tuple[Row, ...]:
        """Return the entries of a kind (all when empty) under a prefix, sorted; without values on request."""
        column = "value" if values else "NULL"
        query = f"SELECT kind, name, revision, {column} FROM entry WHERE (? = '' OR kind = ?)"
        with self._explained("cannot be read"):
            # A range keeps the index and takes `_` and `%` in names as they are.
            rows = self._connection.execute(
                f"{query} AND name >= ? AND substr(name, 1, length(?)) = ? ORDER BY kind, name",
                (kind, kind, prefix, prefix, prefix),
            )
            return tuple(_row(row) for row in rows)

    def changes(self, kind: str, name: str) -> tuple[Row, ...]:
        """Return every change of an entry, oldest first."""
        with self._explained("cannot be read"):
            rows = self._connection.execute(
                "SELECT kind, name, revision, value FROM change WHERE kind = ? AND name = ? ORDER BY seq", (kind, name)
            )
            return tuple(_row(row) for row in rows)

    def put(self, kind: str, name: str, value: str, *, expected_revision: int | None) -> Row:
        """Write an entry in a transaction of its own."""
        with self._transaction():
            self._verify_revision(kind, name, expected_revision)
            return self._write(kind, name, value)

    def delete(self, kind: str, name: str, *, expected_revision: int | None) -> Row:
        """Remove an entry and return its last change."""
        with self._transaction():
            if self._find(kind, name) is None:
                raise self._not_found(kind, name)
            self._verify_revision(kind, name, expected_revision)
            gone = Row(kind, name, self._last_revision(kind, name) + 1, None)
            self._connection.execute("DELETE FROM entry WHERE kind = ? AND name = ?", (kind, name))
            self._record(gone)
            return gone

    def seed(self, entries: Sequence[tuple[str, str, str]], *, overwrite: bool) -> tuple[Row, ...]:
        """Write those (kind, name, value) that are missing or, with `overwrite`, differ; all in one transaction."""
        written: list[Row] = []
        with self._transaction():
            for kind, name, value in entries:
                found = self._find(kind, name)
                if found is None or (overwrite and found.value != value):
                    written.append(self._write(kind, name, value))
        return tuple(written)

    def close(self) -> None:
        """Release the file."""
        self._connection.close()

    def _find(self, kind: str, name: str) -> Row | None:
        row = self._connection.execute(
            "SELECT kind, name, revision, value FROM entry WHERE kind = ? AND name = ?", (kind, name)
        ).fetchone()
        return None if row is None else _row(row)

    def _write(self, kind: str, name: str, value: str) -> Row:
        row = Row(kind, name, self._last_revision(kind, name) + 1, value)
        self._connection.execute(_UPSERT, (row.kind, row.name, row.revision, row.value))
        self._record(row)
        return row

    def _record(self, row: Row) -> None:
        self._connection.execute(
            "INSERT INTO change(kind, name, revision, value) VALUES (?, ?, ?, ?)",
            (row.kind, row.name, row.revision, row.value),
        )

    def _last_revision(self, kind: str, name: str) -> int:
        row = self._connection.execute(
            "SELECT coalesce(max(revision), 0) FROM change WHERE kind = ? AND name = ?", (kind, name)
        ).fetchone()
        return int(row[0])

    def _verify_revision(self, kind: str, name: str, expected: int | None) -> None:
        if expected is None:
            return
        found = self._find(kind, name)
        there = 0 if found is None else found.revision
        if there != expected:
            state = f"revision {there} is there" if there else "there is no such entry"
            raise EntryConflict(
                f"{state}, revision {expected} was expected" if expected else f"{state}, none was expected",
                where=f"{kind} {name}",
                hint="read it again and decide anew",
            )

    def _not_found(self, kind: str, name: str) -> EntryNotFound:
        with self._explained("cannot be read"):
            rows = self._connection.execute("SELECT kind, name FROM entry WHERE kind = ? OR name = ?", (kind, name))
            known = [(str(row[0]), str(row[1])) for row in rows]
        elsewhere = [other for other, same in known if same == name]
        hint = f"there is a {elsewhere[0]} of this name" if elsewhere else near_names(name, (n for _, n in known))
        return EntryNotFound(f"there is no {kind} entry called {name}", where="store", hint=hint)

    @contextmanager
    def _transaction(self) -> Generator[None]:
        with self._explained("cannot be written"):
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._connection.execute("COMMIT")
            finally:
                # Whatever went wrong, the next transaction must find none open.
                if self._connection.in_transaction:
                    self._connection.rollback()

    @contextmanager
    def _explained(self, what: str) -> Generator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise StoreError(f"the store {what}: {error}", where=self.path, hint=advice(error)) from error


def _row(columns: Sequence[Any]) -> Row:
    kind, name, revision, value = columns
    return Row(kind, name, revision, value)
