"""The SQLite tables of the store and the blocking operations on them."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path

from engine.errors import EntryNotFound, StoreError
from engine.host.sqlite_file import advice, open_sqlite
from engine.store.rows import ChangeStamp, EntryDraft, EntryQuery, RevisionRow, deletion_row, needs_seeding, next_row
from engine.store.search_terms import terms_of
from engine.store.sqlite.sqlite_feed import SqliteChangeSource
from engine.store.sqlite.store_schema import CHANGE, ENTRY, KEY, MANY, SCHEMA, conditions, limit_of, row_of, word_ranges
from engine.store.table import ChangeSource, entry_not_found, missing_revisions, verify_revision
from engine.store.undo_chain import undo_row

_UPSERT = """
INSERT INTO entry(kind, name, revision, value) VALUES (?, ?, ?, ?)
ON CONFLICT(kind, name) DO UPDATE SET revision = excluded.revision, value = excluded.value
"""
_MEMORY = ":memory:"
_NEAR = 1000
"""Maximum number of names compared for a suggestion."""


class SqliteTable:
    """One open store file; used by one thread at a time."""

    def __init__(self, path: Path, connection: sqlite3.Connection, *, busy_timeout_s: float) -> None:
        self.path = path
        self._connection = connection
        self._busy_timeout_s = busy_timeout_s

    @classmethod
    def open(cls, path: Path, *, busy_timeout_s: float) -> SqliteTable:
        """Open or create the file; raises StoreError with the path and a hint."""
        try:
            connection = open_sqlite(path, schema=SCHEMA, busy_timeout_s=busy_timeout_s)
        except (sqlite3.Error, OSError) as error:
            raise StoreError(f"the store cannot be opened: {error}", where=path, hint=advice(error)) from error
        return cls(path, connection, busy_timeout_s=busy_timeout_s)

    @property
    def address(self) -> str:
        """The path of the file."""
        return str(self.path)

    def get(self, kind: str, name: str) -> RevisionRow:
        """Return an entry or raise EntryNotFound with similar names."""
        with self._translated_errors("cannot be read"):
            found = self._find(kind, name)
        if found is None:
            raise self._not_found(kind, name)
        return found

    def select(self, selection: EntryQuery, *, values: bool) -> tuple[RevisionRow, ...]:
        """Return entries sorted by kind and name, with their values if `values`."""
        with self._translated_errors("cannot be read"):
            where, given = conditions(selection, rarest=self._rarest(word_ranges(selection)))
            rows = self._connection.execute(
                f"{ENTRY if values else KEY}{where} ORDER BY r.kind, r.name LIMIT ?", (*given, limit_of(selection))
            )
            return tuple(row_of(row) for row in rows)

    def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry, including deleted ones, sorted."""
        with self._translated_errors("cannot be read"):
            rows = self._connection.execute("SELECT DISTINCT kind, name FROM change ORDER BY kind, name")
            return tuple((str(kind), str(name)) for kind, name in rows)

    def changes(self, kind: str, name: str) -> tuple[RevisionRow, ...]:
        """Return every revision of an entry, oldest first."""
        with self._translated_errors("cannot be read"):
            return self._history(kind, name)

    def put(self, draft: EntryDraft, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Write an entry in its own transaction."""
        with self._transaction():
            last = self._last(draft.kind, draft.name)
            verify_revision(draft.kind, draft.name, last, expected_revision)
            return self._commit(next_row(draft, last, stamp))

    def delete(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Delete an entry and return its last revision."""
        with self._transaction():
            last = self._last(kind, name)
            if last is None or last.value is None:
                raise self._not_found(kind, name)
            verify_revision(kind, name, last, expected_revision)
            return self._commit(deletion_row(last, stamp))

    def undo(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Restore the entry before its last change."""
        with self._transaction():
            history = self._history(kind, name)
            if not history:
                raise self._not_found(kind, name)
            verify_revision(kind, name, history[-1], expected_revision)
            return self._commit(undo_row(history, stamp))

    def seed(self, drafts: Sequence[EntryDraft], stamp: ChangeStamp, *, overwrite: bool) -> tuple[RevisionRow, ...]:
        """Write the drafts that are missing or, with `overwrite`, differ; all in one transaction."""
        written: list[RevisionRow] = []
        with self._transaction():
            for draft in drafts:
                last = self._last(draft.kind, draft.name)
                if needs_seeding(draft, last, overwrite=overwrite):
                    written.append(self._commit(next_row(draft, last, stamp)))
        return tuple(written)

    def import_histories(self, histories: Sequence[Sequence[RevisionRow]]) -> tuple[RevisionRow, ...]:
        """Import entries with their revisions in one transaction; return the new revisions."""
        with self._transaction():
            new = [
                row
                for history in histories
                if history
                for row in missing_revisions(self._history(history[0].kind, history[0].name), history)
            ]
            for row in new:
                self._commit(row)
        return tuple(new)

    def feed(self) -> ChangeSource | None:
        """Open a feed of changes; None for a database in memory."""
        if str(self.path) == _MEMORY:
            return None
        with self._translated_errors("cannot be read"):
            return SqliteChangeSource(self.path, busy_timeout_s=self._busy_timeout_s)

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    def _find(self, kind: str, name: str) -> RevisionRow | None:
        row = self._connection.execute(f"{ENTRY} WHERE r.kind = ? AND r.name = ?", (kind, name)).fetchone()
        return None if row is None else row_of(row)

    def _last(self, kind: str, name: str) -> RevisionRow | None:
        row = self._connection.execute(
            f"{CHANGE} WHERE r.kind = ? AND r.name = ? ORDER BY r.revision DESC LIMIT 1", (kind, name)
        ).fetchone()
        return None if row is None else row_of(row)

    def _history(self, kind: str, name: str) -> tuple[RevisionRow, ...]:
        rows = self._connection.execute(f"{CHANGE} WHERE r.kind = ? AND r.name = ? ORDER BY r.revision", (kind, name))
        return tuple(row_of(row) for row in rows)

    def _commit(self, row: RevisionRow) -> RevisionRow:
        key = (row.kind, row.name)
        self._connection.execute(
            "INSERT INTO change(kind, name, revision, value) VALUES (?, ?, ?, ?)", (*key, row.revision, row.value)
        )
        self._connection.execute(
            "INSERT INTO note(kind, name, revision, tags, changed_unix_ms, author, reason, restores, writer)"
            " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (
                *key,
                row.revision,
                json.dumps(row.tags),
                row.changed_unix_ms,
                row.by,
                row.reason,
                row.restores,
                row.writer,
            ),
        )
        self._connection.execute("DELETE FROM word WHERE kind = ? AND name = ?", key)
        if row.value is None:
            self._connection.execute("DELETE FROM entry WHERE kind = ? AND name = ?", key)
            return row
        self._connection.execute(_UPSERT, (*key, row.revision, row.value))
        self._connection.executemany(
            "INSERT INTO word(kind, name, word) VALUES (?, ?, ?)",
            [(*key, word) for word in terms_of(row.name, row.tags)],
        )
        return row

    def _rarest(self, ranges: Sequence[tuple[str, str]]) -> tuple[str, str] | None:
        """Return the range with the fewest entries; None when there is no range."""
        if len(ranges) < 2:
            return ranges[0] if ranges else None
        counted: list[tuple[int, tuple[str, str]]] = []
        for span in ranges:
            query = "SELECT count(*) FROM (SELECT 1 FROM word WHERE word >= ? AND word < ? LIMIT ?)"
            counted.append((int(self._connection.execute(query, (*span, MANY)).fetchone()[0]), span))
        return min(counted)[1]

    def _not_found(self, kind: str, name: str) -> EntryNotFound:
        with self._translated_errors("cannot be read"):
            others = self._connection.execute("SELECT kind FROM entry WHERE name = ?", (name,)).fetchall()
            # Names with the same beginning come first, so that the limit does not drop them.
            names = self._connection.execute(
                "SELECT name FROM entry WHERE kind = ? ORDER BY substr(name, 1, 2) <> ?, name LIMIT ?",
                (kind, name[:2], _NEAR),
            ).fetchall()
        return entry_not_found(
            kind, name, elsewhere=[str(row[0]) for row in others], names=[str(row[0]) for row in names]
        )

    @contextmanager
    def _transaction(self) -> Generator[None]:
        with self._translated_errors("cannot be written"):
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._connection.execute("COMMIT")
            finally:
                # After any error no transaction may stay open.
                if self._connection.in_transaction:
                    self._connection.rollback()

    @contextmanager
    def _translated_errors(self, what: str) -> Generator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise StoreError(f"the store {what}: {error}", where=self.path, hint=advice(error)) from error
