"""The schema of an SQLite file at each version of its format, and a check that the file has no other objects."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

_OBJECTS = "SELECT type, name, tbl_name, sql FROM sqlite_schema"
_MOST_OBJECTS = 64


class ForeignSchema(sqlite3.DatabaseError):
    """A file holds objects other than the tables of its version."""


class DamagedFile(sqlite3.DatabaseError):
    """The pages of a file are inconsistent."""


class FormatTooNew(sqlite3.Error):
    """The file was written by a newer version of this program."""


@dataclass(frozen=True)
class SqliteMigrations:
    """The statements that create each version of the format from the one before, one script per version.

    A new file gets all of them and an older one those it lacks, so that both have the same definitions.
    """

    steps: Sequence[str]

    @property
    def version(self) -> int:
        """The latest version."""
        return len(self.steps)

    def verify(self, connection: sqlite3.Connection) -> int:
        """Check that a file has exactly the schema of its version; return that version, 0 for an empty file.

        Nothing in the file is executed: views, triggers, virtual tables, generated columns and constraints are refused
        by their text.

        Raises:
            FormatTooNew: a newer version of this program wrote the file.
            ForeignSchema: the file has other tables, columns or indexes, or views or triggers.
            sqlite3.Error: the file cannot be read.
        """
        found = int(connection.execute("PRAGMA user_version").fetchone()[0])
        if found > self.version:
            raise FormatTooNew(f"its format is {found}, this program knows {self.version}")
        present = _objects(connection)
        expected = _expected(tuple(self.steps[: max(found, 0)]))
        for name in sorted({*present, *expected}):
            if present.get(name) != expected.get(name):
                kind = (present.get(name) or expected[name])[0]
                problem = "differs from" if name in present and name in expected else "is not part of"
                problem = "is missing from" if name not in present else problem
                raise ForeignSchema(f"its {kind} {name:.80} {problem} format {found}")
        return found

    def upgrade(self, connection: sqlite3.Connection) -> None:
        """Migrate a file to the latest version in one transaction.

        Raises:
            FormatTooNew: a newer version of this program wrote the file.
            ForeignSchema: the file is not of this kind.
            sqlite3.Error: the file cannot be written.
        """
        if self.verify(connection) == self.version:
            return
        # Two processes may run this at once: the version is read again under the lock.
        connection.execute("BEGIN IMMEDIATE")
        try:
            for step in self.steps[self.verify(connection) :]:
                for statement in _statements(step):
                    connection.execute(statement)
            connection.execute(f"PRAGMA user_version={self.version}")
            connection.execute("COMMIT")
        finally:
            if connection.in_transaction:
                connection.rollback()


Object = tuple[str, str, str]


def _objects(connection: sqlite3.Connection) -> dict[str, Object]:
    rows = connection.execute(f"{_OBJECTS} LIMIT {_MOST_OBJECTS + 1}").fetchall()
    if len(rows) > _MOST_OBJECTS:
        raise ForeignSchema(f"it has more than {_MOST_OBJECTS} tables, indexes, views and triggers")
    return {str(name): (str(kind), str(table), _plain(sql)) for kind, name, table, sql in rows}


@cache
def _expected(steps: tuple[str, ...]) -> dict[str, Object]:
    connection = sqlite3.connect(":memory:")
    try:
        for step in steps:
            connection.executescript(step)
        return _objects(connection)
    finally:
        connection.close()


def _plain(sql: object) -> str:
    """Return a definition without insignificant whitespace, which differs between versions."""
    text = " ".join(str(sql or "").split())
    for sign in "(),":
        text = text.replace(f" {sign}", sign).replace(f"{sign} ", sign)
    return text


def _statements(script: str) -> list[str]:
    """Split a script into complete statements."""
    statements: list[str] = []
    statement = ""
    for line in script.splitlines(keepends=True):
        statement += line
        if sqlite3.complete_statement(statement):
            statements.append(statement)
            statement = ""
    return statements
