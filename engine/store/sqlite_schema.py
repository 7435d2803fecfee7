"""The tables of a store file, and the queries that read rows from them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from engine.store.row import Row, Selection
from engine.store.words import AFTER_PREFIX, whole_tag

VERSION = 2
SCHEMA = """
CREATE TABLE IF NOT EXISTS entry(
    kind TEXT NOT NULL, name TEXT NOT NULL, revision INTEGER NOT NULL, value TEXT NOT NULL,
    PRIMARY KEY (kind, name)) STRICT;
CREATE TABLE IF NOT EXISTS change(
    seq INTEGER PRIMARY KEY AUTOINCREMENT, kind TEXT NOT NULL, name TEXT NOT NULL,
    revision INTEGER NOT NULL, value TEXT, UNIQUE (kind, name, revision)) STRICT;
CREATE TABLE IF NOT EXISTS note(
    kind TEXT NOT NULL, name TEXT NOT NULL, revision INTEGER NOT NULL, tags TEXT NOT NULL,
    changed_unix_ms INTEGER NOT NULL, author TEXT NOT NULL, reason TEXT NOT NULL, restores INTEGER,
    writer TEXT NOT NULL, PRIMARY KEY (kind, name, revision)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS word(
    kind TEXT NOT NULL, name TEXT NOT NULL, word TEXT NOT NULL, PRIMARY KEY (kind, name, word)) STRICT, WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS word_first ON word(word, kind, name);
CREATE INDEX IF NOT EXISTS name_first ON entry(name, kind, revision);
-- Entries of a file of version 1 have no words yet.
INSERT OR IGNORE INTO word(kind, name, word)
WITH RECURSIVE part(kind, name, word, rest) AS (
    SELECT kind, name, '',
        replace(replace(replace(replace(name, '_', ' '), '/', ' '), '.', ' '), '-', ' ') || ' ' FROM entry
    UNION ALL
    SELECT kind, name, substr(rest, 1, instr(rest, ' ') - 1), substr(rest, instr(rest, ' ') + 1)
    FROM part WHERE rest <> '')
SELECT kind, name, word FROM part WHERE word <> '';
"""

_NOTE = "n.tags, n.changed_unix_ms, n.author, n.reason, n.restores, n.writer"
_JOIN = "LEFT JOIN note n ON n.kind = r.kind AND n.name = r.name AND n.revision = r.revision"
ENTRY = f"SELECT r.kind, r.name, r.revision, r.value, {_NOTE} FROM entry r {_JOIN}"
KEY = f"SELECT r.kind, r.name, r.revision, NULL, {_NOTE} FROM entry r {_JOIN}"
CHANGE = f"SELECT r.kind, r.name, r.revision, r.value, {_NOTE} FROM change r {_JOIN}"
MANY = 20_000
"""Words are counted no further to find the rarest."""


def row_of(columns: Sequence[Any]) -> Row:
    """Return what one of the queries found."""
    kind, name, revision, value, tags, changed_unix_ms, author, reason, restores, writer = columns
    return Row(
        kind=kind,
        name=name,
        revision=revision,
        value=value,
        tags=tuple(json.loads(tags)) if tags else (),
        changed_unix_ms=changed_unix_ms or 0,
        by=author or "",
        reason=reason or "",
        restores=restores,
        writer=writer or "",
    )


def word_ranges(selection: Selection) -> tuple[tuple[str, str], ...]:
    """Return for each tag and word that is asked for the range its words lie in, the end excluded."""
    tags = [(whole_tag(tag), f"{whole_tag(tag)}\x00") for tag in selection.tags]
    return (*tags, *((word, word + AFTER_PREFIX) for word in selection.words))


def conditions(selection: Selection, *, rarest: tuple[str, str] | None) -> tuple[str, list[object]]:
    """Return the WHERE clause of a selection with its arguments; `rarest` is the word range that is searched."""
    if rarest is None:
        where, given = _plain_conditions(selection, "r")
        return (f" WHERE {where}" if where else ""), given
    # The index of words leads to the few entries of a page, whichever part of all entries has the word.
    parts, given = ["w.word >= ? AND w.word < ?"], list[object](rarest)
    where, more = _plain_conditions(selection, "w")
    parts += [where] if where else []
    given += more
    for span in word_ranges(selection):
        if span != rarest:
            parts.append(
                "EXISTS (SELECT 1 FROM word v WHERE v.kind = w.kind AND v.name = w.name AND v.word >= ? AND v.word < ?)"
            )
            given += span
    found = f"SELECT DISTINCT w.kind, w.name FROM word w WHERE {' AND '.join(parts)} ORDER BY w.kind, w.name LIMIT ?"
    return f" WHERE (r.kind, r.name) IN ({found})", [*given, limit_of(selection)]


def limit_of(selection: Selection) -> int:
    """Return how many rows are asked for, as SQLite takes it."""
    return -1 if selection.limit is None else selection.limit


def _plain_conditions(selection: Selection, table: str) -> tuple[str, list[object]]:
    parts: list[str] = []
    given: list[object] = []
    if selection.kind:
        parts.append(f"{table}.kind = ?")
        given.append(selection.kind)
    if selection.prefix:
        parts.append(f"{table}.name >= ? AND {table}.name < ?")
        given += [selection.prefix, selection.prefix + AFTER_PREFIX]
    if selection.after is not None:
        parts.append(f"({table}.kind, {table}.name) > (?, ?)")
        given += selection.after
    return " AND ".join(parts), given
