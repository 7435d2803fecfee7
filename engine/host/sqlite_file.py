"""Opens an SQLite file durably and as untrusted data; describes why a file cannot be used.

A file may come from any source. Its schema is verified before anything in it is executed, the work of a query
is bounded by the size of the file, and only the owner may read the file.
"""

from __future__ import annotations

import sqlite3
from contextlib import suppress
from pathlib import Path
from typing import Any

from engine.host.private_files import make_private_folder, new_private_file
from engine.host.sqlite_migrations import DamagedFile, ForeignSchema, FormatTooNew, SqliteMigrations
from engine.host.sqlite_wal import require_whole_log

MAX_VALUE_BYTES = 64 * 2**20
"""Size limit of one text or blob."""
_MAX_SQL_BYTES = 64 * 1024
_STEPS_A_CALL = 100_000
_FREE_STEPS = 2_000_000
_STEPS_A_BYTE = 20

_ADVICE = {
    "SQLITE_FULL": "the disk is full: free some space",
    "SQLITE_READONLY": "make the file and its directory writable",
    "SQLITE_BUSY": "another program holds it locked: end that program",
    "SQLITE_LOCKED": "another program holds it locked: end that program",
    "SQLITE_NOTADB": "this is not an SQLite file: move it away",
    "SQLITE_CORRUPT": "the file is damaged: restore a copy or move it away",
    "SQLITE_CANTOPEN": "check that the directory exists and is writable",
    "SQLITE_IOERR": "reading or writing the disk failed: check free space, file size limits and the disk",
    "SQLITE_INTERRUPT": "the file makes queries work too long for its size: restore a copy or move it away",
    "SQLITE_TOOBIG": f"a value has at most {MAX_VALUE_BYTES // 2**20} MB",
}
_UNUSABLE = "this file is damaged or not a file of flexcell: restore a copy or move it away"


class BoundedConnection(sqlite3.Connection):
    """A connection that limits the work of a query by the size of the file.

    Created by `open_sqlite` and `read_sqlite`; `bound` is called once.
    """

    def bound(self, path: Path) -> None:
        """Interrupt every query that works longer than the size of the file at `path` can require."""
        self._path = path
        self._steps = self._allowed = 0
        self.set_progress_handler(self._is_too_long, _STEPS_A_CALL)

    def execute(self, *given: Any) -> sqlite3.Cursor:
        """Execute one statement with its own work limit."""
        self._steps = 0
        try:
            return super().execute(*given)
        except UnicodeDecodeError as error:
            # SQLite's own message quotes invalid text.
            raise DamagedFile(f"the file holds invalid text: {error}") from error

    def _is_too_long(self) -> int:
        self._steps += _STEPS_A_CALL
        if self._steps > self._allowed:
            self._allowed = _FREE_STEPS + _STEPS_A_BYTE * stored_bytes(self._path)
        return int(self._steps > self._allowed)


def open_sqlite(path: Path, *, schema: SqliteMigrations, busy_timeout_s: float) -> BoundedConnection:
    """Open or create `path` in WAL mode with a sync at every commit; transactions are opened explicitly.

    An older format is migrated to the latest. The file, and a folder created for it, are private to the owner.
    The connection may move between threads; one thread uses it at a time.

    Raises:
        sqlite3.Error: the file cannot be opened, is not SQLite, is damaged, foreign, or has a newer format.
        OSError: the directory or file cannot be created.
    """
    if str(path) != ":memory:":
        make_private_folder(path.parent)
        new_private_file(path)
        require_whole_log(path)
    connection = sqlite3.connect(
        path, timeout=busy_timeout_s, isolation_level=None, check_same_thread=False, factory=BoundedConnection
    )
    try:
        _distrust(connection, path)
        schema.verify(connection)
        connection.execute("PRAGMA journal_mode=WAL")
        connection.execute("PRAGMA synchronous=FULL")
        schema.upgrade(connection)
        _require_sound(connection)
    except sqlite3.Error:
        connection.close()
        raise
    return connection


def read_sqlite(path: Path, *, schema: SqliteMigrations, busy_timeout_s: float = 5.0) -> BoundedConnection:
    """Open an existing file for reading only.

    Raises:
        sqlite3.Error: the file is missing, cannot be opened, is not SQLite, has foreign tables or a newer format.
    """
    connection = sqlite3.connect(
        f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=busy_timeout_s, isolation_level=None,
        check_same_thread=False, factory=BoundedConnection,
    )  # fmt: skip
    try:
        _distrust(connection, path)
        schema.verify(connection)
    except sqlite3.Error:
        connection.close()
        raise
    return connection


def stored_bytes(path: Path) -> int:
    """Return the size of a database including its write-ahead log; a valid query reads no more."""
    sizes = 0
    for file in (path, path.with_name(f"{path.name}-wal")):
        with suppress(OSError):
            sizes += file.stat().st_size
    return sizes


def advice(error: sqlite3.Error | OSError) -> str:
    """Return advice for an error of SQLite or of the file system."""
    if isinstance(error, OSError):
        return "check that the directory exists and is writable"
    if isinstance(error, FormatTooNew):
        return "use the newer version of flexcell that wrote it"
    if isinstance(error, ForeignSchema | DamagedFile):
        return _UNUSABLE
    name = getattr(error, "sqlite_errorname", "")
    return next((text for code, text in _ADVICE.items() if name.startswith(code)), "check the file and the disk")


def _distrust(connection: BoundedConnection, path: Path) -> None:
    """Disable everything in the file except stored rows."""
    connection.bound(path)
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_VALUE_BYTES)
    connection.setlimit(sqlite3.SQLITE_LIMIT_SQL_LENGTH, _MAX_SQL_BYTES)
    connection.setlimit(sqlite3.SQLITE_LIMIT_ATTACHED, 0)
    connection.setlimit(sqlite3.SQLITE_LIMIT_TRIGGER_DEPTH, 0)
    connection.execute("PRAGMA trusted_schema=OFF")
    connection.execute("PRAGMA cell_size_check=ON")
    connection.execute("PRAGMA mmap_size=0")
    # Available from Python 3.12 on.
    defensive = getattr(sqlite3, "SQLITE_DBCONFIG_DEFENSIVE", None)
    if defensive is not None:
        connection.setconfig(defensive, True)  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType]


def _require_sound(connection: sqlite3.Connection) -> None:
    """Refuse to write into a file with inconsistent pages: that would increase the damage."""
    fault = str(connection.execute("PRAGMA quick_check(1)").fetchone()[0])
    if fault != "ok":
        raise DamagedFile(" ".join(fault.split()))
