"""Opens an SQLite file the durable way, and says in words why one cannot be used."""

from __future__ import annotations

import sqlite3
from pathlib import Path

_ADVICE = {
    "SQLITE_FULL": "the disk is full: free some space",
    "SQLITE_READONLY": "make the file and its directory writable",
    "SQLITE_BUSY": "another program holds it locked: end that program",
    "SQLITE_LOCKED": "another program holds it locked: end that program",
    "SQLITE_NOTADB": "this is no SQLite file: move it away",
    "SQLITE_CORRUPT": "the file is damaged: restore a copy or move it away",
    "SQLITE_CANTOPEN": "check that the directory exists and is writable",
    "SQLITE_IOERR": "reading or writing the disk failed: check free space, file size limits and the disk",
}


class FormatTooNew(sqlite3.Error):
    """The file was written by a newer version of this program."""


def open_sqlite(path: Path, *, schema: str, version: int, busy_timeout_s: float) -> sqlite3.Connection:
    """Open or create `path` in WAL mode with a sync at every commit; transactions are begun by hand.

    The connection may be handed to another thread, but used by one at a time.

    Raises:
        sqlite3.Error: the file cannot be opened, is not SQLite, or has a newer format than `version`.
        OSError: the directory cannot be made.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    connection = sqlite3.connect(path, timeout=busy_timeout_s, isolation_level=None, check_same_thread=False)
    try:
        connection.execute("PRAGMA journal_mode=WAL")
        connection.execute("PRAGMA synchronous=FULL")
        _prepare(connection, schema, version)
    except sqlite3.Error:
        connection.close()
        raise
    return connection


def read_sqlite(path: Path, *, busy_timeout_s: float = 5.0) -> sqlite3.Connection:
    """Open an existing file for reading only; raises sqlite3.Error when it is missing."""
    return sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=busy_timeout_s)


def advice(error: sqlite3.Error | OSError) -> str:
    """Say what the reader can do about an error of SQLite or of the file system."""
    if isinstance(error, OSError):
        return "check that the directory exists and is writable"
    if isinstance(error, FormatTooNew):
        return "use the newer version of flexcell that wrote it"
    name = getattr(error, "sqlite_errorname", "")
    return next((text for code, text in _ADVICE.items() if name.startswith(code)), "check the file and the disk")


def _prepare(connection: sqlite3.Connection, schema: str, version: int) -> None:
    found = int(connection.execute("PRAGMA user_version").fetchone()[0])
    if found > version:
        raise FormatTooNew(f"its format is {found}, this program knows {version}")
    if found < version:
        # Two processes may create the file at once: the schema is written "if not exists" in one transaction.
        connection.executescript(f"BEGIN IMMEDIATE;\n{schema}\nPRAGMA user_version={version};\nCOMMIT;")
