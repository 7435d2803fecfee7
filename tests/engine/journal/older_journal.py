"""Makes journals as earlier versions of the program left them."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from pathlib import Path

from engine.event import Event
from engine.journal import encode_event

_STEPS = (
    """
    CREATE TABLE run(
        id TEXT PRIMARY KEY, behavior TEXT NOT NULL, hash TEXT NOT NULL, status TEXT NOT NULL,
        epoch INTEGER NOT NULL, started REAL NOT NULL) STRICT;
    CREATE TABLE event(
        run TEXT NOT NULL, seq INTEGER NOT NULL, time_s REAL NOT NULL, epoch INTEGER NOT NULL, data TEXT NOT NULL,
        PRIMARY KEY (run, seq)) STRICT, WITHOUT ROWID;
    """,
    """
    CREATE TABLE origin(run TEXT PRIMARY KEY, data TEXT NOT NULL) STRICT;
    CREATE TABLE world(run TEXT PRIMARY KEY, seq INTEGER NOT NULL, data BLOB NOT NULL) STRICT;
    """,
    "CREATE TABLE driver(run TEXT PRIMARY KEY, engine TEXT NOT NULL) STRICT;",
)


def write_older_journal(file: Path, version: int, run: str, events: Sequence[Event]) -> None:
    """Write a journal of format 1, 2 or 3 with one run under way."""
    connection = sqlite3.connect(file, isolation_level=None)
    for step in _STEPS[:version]:
        connection.executescript(step)
    connection.execute("INSERT INTO run VALUES (?, 'transfer', 'abc', 'running', 1, 10.0)", (run,))
    rows = [(run, event.seq, event.time_s, encode_event(event).decode()) for event in events]
    connection.executemany("INSERT INTO event VALUES (?, ?, ?, 1, ?)", rows)
    if version > 1:
        connection.execute('INSERT INTO origin VALUES (?, \'{"behavior":"/b.yaml"}\')', (run,))
        connection.execute("INSERT INTO world VALUES (?, ?, x'0102')", (run, len(events)))
    connection.execute(f"PRAGMA user_version={version}")
    connection.close()


def write_format_4(file: Path) -> None:
    """Write a journal of two runs that are over, as the last version that kept a row for each event left it."""
    connection = sqlite3.connect(file, isolation_level=None)
    connection.executescript(Path(__file__).with_name("format_4.sql").read_text(encoding="utf-8"))
    connection.execute("PRAGMA journal_mode=WAL")
    connection.close()
