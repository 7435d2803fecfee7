"""The tables of a store file, and the queries that read their rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec

from engine.host.sqlite_migrations import DamagedFile, SqliteMigrations
from engine.store.rows import EntryQuery, RevisionRow
from engine.store.search_terms import AFTER_PREFIX, tag_term

SCHEMA = SqliteMigrations(
    (
        """
CREATE TABLE IF NOT EXISTS entry(
    kind TEXT NOT NULL, name TEXT NOT NULL, revision INTEGER NOT NULL, value TEXT NOT NULL,
    PRIMARY KEY (kind, name)) STRICT;
CREATE TABLE IF NOT EXISTS change(
    seq INTEGER PRIMARY KEY AUTOINCREMENT, kind TEXT NOT NULL, name TEXT NOT NULL,
    revision INTEGER NOT NULL, value TEXT, UNIQUE (kind, name, revision)) STRICT;
""",
        # Entries of a file of version 1 have no words yet; a name above the length limit gets none.
        """
CREATE TABLE IF NOT EXISTS note(
    kind TEXT NOT NULL, name TEXT NOT NULL, revision INTEGER NOT NULL, tags TEXT NOT NULL,
    changed_unix_ms INTEGER NOT NULL, author TEXT NOT NULL, reason TEXT NOT NULL, restores INTEGER,
    writer TEXT NOT NULL, PRIMARY KEY (kind, name, revision)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS word(
    kind TEXT NOT NULL, name TEXT NOT NULL, word TEXT NOT NULL, PRIMARY KEY (kind, name, word)) STRICT, WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS word_first ON word(word, kind, name);
CREATE INDEX IF NOT EXISTS name_first ON entry(name, kind, revision);
INSERT OR IGNORE INTO word(kind, name, word)
WITH RECURSIVE part(kind, name, word, rest) AS (
    SELECT kind, name, '',
        replace(replace(replace(replace(name, '_', ' '), '/', ' '), '.', ' '), '-', ' ') || ' ' FROM entry
        WHERE length(CAST(name AS BLOB)) <= 128
    UNION ALL
    SELECT kind, name, substr(rest, 1, instr(rest, ' ') - 1), substr(rest, instr(rest, ' ') + 1)
    FROM part WHERE rest <> '')
SELECT kind, name, word FROM part WHERE word <> '';
""",
    )
)
_NOTE = "n.tags, n.changed_unix_ms, n.author, n.reason, n.restores, n.writer"
_JOIN = "LEFT JOIN note n ON n.kind = r.kind AND n.name = r.name AND n.revision = r.revision"
ENTRY = f"SELECT r.kind, r.name, r.revision, r.value, {_NOTE} FROM entry r {_JOIN}"  # noqa: S608 - our names
KEY = f"SELECT r.kind, r.name, r.revision, NULL, {_NOTE} FROM entry r {_JOIN}"  # noqa: S608
CHANGE = f"SELECT r.kind, r.name, r.revision, r.value, {_NOTE} FROM change r {_JOIN}"  # noqa: S608
MANY = 20_000
"""Limit of the count of a word when the rarest one is determined."""


class _Columns(msgspec.Struct, frozen=True, array_like=True):
    kind: str
    name: str
    revision: int
    value: str | None
    tags: str | None
    changed_unix_ms: int | None
    author: str | None
    reason: str | None
    restores: int | None
    writer: str | None


def row_of(columns: Sequence[Any]) -> RevisionRow:
    """Return the revision in a row of one of the queries.

    Raises:
        DamagedFile: the row is not a revision.
    """
    try:
        row = msgspec.convert(columns, _Columns)
        tags = msgspec.json.decode(row.tags, type=tuple[str, ...]) if row.tags else ()
    except (msgspec.DecodeError, UnicodeEncodeError) as error:
        raise DamagedFile(f"a row is not an entry: {error}") from error
    return RevisionRow(
        kind=row.kind,
        name=row.name,
        revision=row.revision,
        value=row.value,
        tags=tags,
        changed_unix_ms=row.changed_unix_ms or 0,
        by=row.author or "",
        reason=row.reason or "",
        restores=row.restores,
        writer=row.writer or "",
    )


def word_ranges(selection: EntryQuery) -> tuple[tuple[str, str], ...]:
    """Return the half-open range of words for each tag and word of a query."""
    tags = [(tag_term(tag), f"{tag_term(tag)}\x00") for tag in selection.tags]
    return (*tags, *((word, word + AFTER_PREFIX) for word in selection.words))


def conditions(selection: EntryQuery, *, rarest: tuple[str, str] | None) -> tuple[str, list[object]]:
    """Return the WHERE clause of a query with its arguments; `rarest` is the word range to search first."""
    if rarest is None:
        where, arguments = _plain_conditions(selection, "r")
        return (f" WHERE {where}" if where else ""), arguments
    # The index of words finds the entries of a page without a scan of all entries.
    parts, arguments = ["w.word >= ? AND w.word < ?"], list[object](rarest)
    where, more = _plain_conditions(selection, "w")
    parts += [where] if where else []
    arguments += more
    for span in word_ranges(selection):
        if span != rarest:
            parts.append(
                "EXISTS (SELECT 1 FROM word v WHERE v.kind = w.kind AND v.name = w.name AND v.word >= ? AND v.word < ?)"
            )
            arguments += span
    where = " AND ".join(parts)
    found = f"SELECT DISTINCT w.kind, w.name FROM word w WHERE {where} ORDER BY w.kind, w.name LIMIT ?"  # noqa: S608
    return f" WHERE (r.kind, r.name) IN ({found})", [*arguments, limit_of(selection)]


def limit_of(selection: EntryQuery) -> int:
    """Return the row limit of a query for SQLite, -1 for none."""
    return -1 if selection.limit is None else selection.limit


def _plain_conditions(selection: EntryQuery, table: str) -> tuple[str, list[object]]:
    parts: list[str] = []
    arguments: list[object] = []
    if selection.kind:
        parts.append(f"{table}.kind = ?")
        arguments.append(selection.kind)
    if selection.prefix:
        parts.append(f"{table}.name >= ? AND {table}.name < ?")
        arguments += [selection.prefix, selection.prefix + AFTER_PREFIX]
    if selection.after is not None:
        parts.append(f"({table}.kind, {table}.name) > (?, ?)")
        arguments += selection.after
    return " AND ".join(parts), arguments
