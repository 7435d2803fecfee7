"""Reading a journal names what is missing or damaged."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from engine.errors import JournalError
from engine.event import MessageLogged
from engine.journal import Journal, list_runs, read_events
from tests.engine.journal.older_journal import write_older_journal


def test_a_missing_journal_is_named_and_not_made(tmp_path: Path) -> None:
    """Reading creates no file."""
    with pytest.raises(JournalError, match=r"journal\.db: there is no journal here"):
        list_runs(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_run_gets_the_near_names(tmp_path: Path) -> None:
    """A mistyped run id is answered with the one that was meant."""
    with Journal.open(tmp_path) as journal:
        journal.begin("morning", behavior="b", document="d", started_unix_s=0.0)
    with pytest.raises(JournalError, match=r"there is no run mornin \(did you mean morning\?\)"):
        read_events(tmp_path, "mornin")


def test_a_damaged_event_is_reported_as_damage(tmp_path: Path) -> None:
    """A row that is no event raises the journal's error."""
    file = tmp_path / "journal.db"
    write_older_journal(file, 3, "r", [MessageLogged(seq=1, time_s=0.0, path="root", level="info", message="x")])
    connection = sqlite3.connect(file)
    connection.execute('UPDATE event SET data = \'{"event": "lo\'')
    connection.commit()
    connection.close()
    with pytest.raises(JournalError, match="event 1 of run r: this is not an event"):
        read_events(tmp_path, "r")


def test_a_file_that_is_no_database_cannot_be_read(tmp_path: Path) -> None:
    """SQLite's complaint is passed on with the path."""
    (tmp_path / "journal.db").write_bytes(b"no database" * 100)
    with pytest.raises(JournalError, match=r"cannot be read.*not a database"):
        list_runs(tmp_path)
