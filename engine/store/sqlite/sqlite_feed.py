"""Reads the changes committed to a store file by polling it."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from threading import Event

from engine.errors import StoreError
from engine.host.sqlite_file import advice, read_sqlite
from engine.store.rows import RevisionRow
from engine.store.sqlite.store_schema import CHANGE, SCHEMA, row_of

PERIOD_S = 0.2
"""Polling period of the file."""


class SqliteChangeSource:
    """The changes of a store file since the source was opened."""

    def __init__(self, path: Path, *, busy_timeout_s: float) -> None:
        self._path = path
        self._busy_timeout_s = busy_timeout_s
        self._connection: sqlite3.Connection | None = None
        # Opened for this query only: another thread reads the feed.
        connection = read_sqlite(path, schema=SCHEMA, busy_timeout_s=busy_timeout_s)
        try:
            self._last_seq = int(connection.execute("SELECT coalesce(max(seq), 0) FROM change").fetchone()[0])
        finally:
            connection.close()
        self._version: int | None = None

    def wait(self, stop: Event) -> tuple[RevisionRow, ...]:
        """Return the changes committed since the last call, or none after one period."""
        if self._version is not None and stop.wait(PERIOD_S):
            return ()
        try:
            return self._read()
        except sqlite3.Error as error:
            raise StoreError(f"its changes cannot be read: {error}", where=self._path, hint=advice(error)) from error

    def close(self) -> None:
        """Close the file."""
        if self._connection is not None:
            self._connection.close()

    def _read(self) -> tuple[RevisionRow, ...]:
        if self._connection is None:
            self._connection = read_sqlite(self._path, schema=SCHEMA, busy_timeout_s=self._busy_timeout_s)
        version = int(self._connection.execute("PRAGMA data_version").fetchone()[0])
        if version == self._version:
            return ()
        self._version = version
        query = CHANGE.replace("SELECT ", "SELECT r.seq, ", 1)
        found = self._connection.execute(f"{query} WHERE r.seq > ? ORDER BY r.seq", (self._last_seq,)).fetchall()
        if found:
            self._last_seq = int(found[-1][0])
        return tuple(row_of(columns[1:]) for columns in found)
