"""A file that calls itself ours is used only where its tables are ours, and no query of it runs without end."""

from __future__ import annotations

import sqlite3
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from engine.archive.past_runs import PastRuns
from engine.errors import JournalError, StoreError
from engine.host.sqlite_file import MAX_VALUE_BYTES, BoundedConnection, open_sqlite, read_sqlite
from engine.host.sqlite_migrations import ForeignSchema, SqliteMigrations
from engine.journal import Journal, list_runs, read_events
from engine.store.sqlite.sqlite_store import SqliteStore

ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT"
NOTES = SqliteMigrations(("CREATE TABLE note(text TEXT NOT NULL) STRICT;", "CREATE INDEX note_text ON note(text);"))
ADDED = [
    f"CREATE VIEW v AS {ENDLESS} i FROM n",
    "CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM event; END",
    "CREATE TABLE extra(x)",
    "CREATE INDEX by_status ON run(status)",
    "CREATE VIRTUAL TABLE words USING fts5(text)",
    "ALTER TABLE run ADD COLUMN more TEXT GENERATED ALWAYS AS (upper(id)) VIRTUAL",
    "ALTER TABLE run ADD COLUMN more TEXT DEFAULT '1' CHECK (json_valid(more))",
    f"DROP TABLE run; CREATE VIEW run AS {ENDLESS} i AS id, '' AS behavior, '' AS hash, '' AS status, 1 AS epoch,"
    " 0.0 AS started FROM n",
    "DROP TABLE event",
    "DROP TABLE block",
]


def changed(file: Path, script: str) -> None:
    connection = sqlite3.connect(file, isolation_level=None)
    connection.executescript(script)
    connection.close()


@pytest.mark.parametrize("script", ADDED)
def test_a_journal_with_other_tables_is_refused_by_all_who_open_it(tmp_path: Path, script: str) -> None:
    """Views, triggers, virtual tables and generated columns are never executed."""
    with Journal.open(tmp_path) as journal:
        journal.begin("r", behavior="b", document="d", started_unix_s=0.0)
    changed(tmp_path / "journal.db", script)
    # Of a constraint that calls a function SQLite itself says so, as schemas are not trusted.
    said = r"journal\.db: the journal cannot be (read|opened): (its (view|trigger|table|index) .*format 5|.*unsafe use)"
    for use in _users(tmp_path):
        with pytest.raises(JournalError, match=said + ".*move it away"):
            use()


def _users(folder: Path) -> tuple[Callable[[], object], ...]:
    return (
        lambda: list_runs(folder),
        lambda: read_events(folder, "r"),
        lambda: Journal.open(folder),
        lambda: PastRuns(folder, success=lambda run, document: ()).all(),
    )


@pytest.mark.parametrize(
    "script",
    [
        f"CREATE VIEW v AS {ENDLESS} i FROM n",
        f"DROP TABLE entry; CREATE VIEW entry AS {ENDLESS} 'a' AS kind, 'a' AS name, 1 AS revision, '' AS value FROM n",
        "CREATE TRIGGER t AFTER INSERT ON change BEGIN DELETE FROM entry; END",
    ],
)
async def test_a_store_with_other_tables_is_refused(tmp_path: Path, script: str) -> None:
    async with SqliteStore.open(tmp_path / "s.db") as store:
        await store.put("record", "a", {"n": 1})
    changed(tmp_path / "s.db", script)
    with pytest.raises(StoreError, match=r"s\.db: the store cannot be opened: its (view|table|trigger)"):
        SqliteStore.open(tmp_path / "s.db")


async def test_a_row_of_a_store_that_is_none_is_a_damaged_file(tmp_path: Path) -> None:
    async with SqliteStore.open(tmp_path / "s.db") as store:
        await store.put("record", "a", {"n": 1})
        changed(tmp_path / "s.db", "UPDATE note SET tags = '[1, {'")
        with pytest.raises(StoreError, match=r"s\.db: the store cannot be read: a row is not an entry"):
            await store.get("record", "a")
        changed(tmp_path / "s.db", "UPDATE note SET tags = '[]'; UPDATE entry SET value = '{\"n\": '")
        with pytest.raises(StoreError, match="record a"):
            await store.get("record", "a")


def test_a_file_of_an_older_version_is_the_same_as_a_new_one_afterwards(tmp_path: Path) -> None:
    changed(tmp_path / "n.db", "CREATE TABLE  note ( text  TEXT NOT NULL ) STRICT; PRAGMA user_version=1")
    for file in ("n.db", "new.db"):
        open_sqlite(tmp_path / file, schema=NOTES, busy_timeout_s=1.0).close()
        assert NOTES.verify(sqlite3.connect(tmp_path / file)) == 2


def test_a_file_of_an_older_version_with_more_in_it_is_not_upgraded(tmp_path: Path) -> None:
    changed(tmp_path / "n.db", "CREATE TABLE note(text TEXT NOT NULL) STRICT; CREATE VIEW v AS SELECT 1")
    changed(tmp_path / "n.db", "PRAGMA user_version=1")
    with pytest.raises(ForeignSchema, match="its view v is not part of format 1"):
        open_sqlite(tmp_path / "n.db", schema=NOTES, busy_timeout_s=1.0)


@pytest.fixture
def notes(tmp_path: Path) -> BoundedConnection:
    open_sqlite(tmp_path / "n.db", schema=NOTES, busy_timeout_s=1.0).close()
    return read_sqlite(tmp_path / "n.db", schema=NOTES)


def test_a_query_without_end_is_ended(notes: BoundedConnection) -> None:
    """What a query may take depends on the size of the file, not on the clock."""
    with pytest.raises(sqlite3.OperationalError, match="interrupted"):
        notes.execute(f"{ENDLESS} count(*) FROM n")
    assert notes.execute(f"{ENDLESS} i FROM n LIMIT 1000").fetchall()[-1] == (1000,)
    notes.close()


def test_a_value_may_be_so_large_and_no_larger(notes: BoundedConnection) -> None:
    with pytest.raises(sqlite3.Error, match="too big"):
        notes.execute(f"SELECT length(zeroblob({MAX_VALUE_BYTES + 1}))").fetchone()
    with pytest.raises(sqlite3.Error, match="attached"):
        notes.execute("ATTACH ':memory:' AS other")
    notes.close()


def test_a_file_whose_pages_do_not_fit_together_is_not_written_to(tmp_path: Path) -> None:
    connection = open_sqlite(tmp_path / "n.db", schema=NOTES, busy_timeout_s=1.0)
    connection.executemany("INSERT INTO note VALUES (?)", [("x" * 100,)] * 1000)
    connection.close()
    whole = bytearray((tmp_path / "n.db").read_bytes())
    page = 4096 * 2
    whole[page + 3 : page + 5] = b"\0\1"  # the number of rows of a page
    (tmp_path / "n.db").write_bytes(whole)
    with pytest.raises(sqlite3.DatabaseError):
        open_sqlite(tmp_path / "n.db", schema=NOTES, busy_timeout_s=1.0)


def test_files_and_new_folders_are_their_owners_alone(tmp_path: Path) -> None:
    with Journal.open(tmp_path / ".flexcell" / "deep") as journal:
        journal.begin("r", behavior="b", document="d", started_unix_s=0.0)
        modes = {file.name: stat.S_IMODE(file.stat().st_mode) for file in journal.path.parent.glob("journal.db*")}
    assert modes == dict.fromkeys(("journal.db", "journal.db-shm", "journal.db-wal"), 0o600)
    assert stat.S_IMODE((tmp_path / ".flexcell").stat().st_mode) == 0o700


def test_what_others_could_read_is_taken_from_them(tmp_path: Path) -> None:
    """A state folder of ours and files of ours; a folder that somebody gave is left as it is."""
    state, given = tmp_path / ".flexcell", tmp_path / "given"
    for folder in (state, given):
        folder.mkdir()
        folder.chmod(0o755)
        (folder / "journal.db").touch(0o644)
        Journal.open(folder).close()
        assert stat.S_IMODE((folder / "journal.db").stat().st_mode) == 0o600
    assert [stat.S_IMODE(folder.stat().st_mode) for folder in (state, given)] == [0o700, 0o755]
