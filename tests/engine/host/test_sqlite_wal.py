"""Damage in the write-ahead log of an SQLite file."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from engine.host.sqlite_file import open_sqlite
from engine.host.sqlite_migrations import DamagedFile, SqliteMigrations

SCHEMA = SqliteMigrations(("CREATE TABLE lines (number INTEGER PRIMARY KEY, text TEXT NOT NULL) STRICT;",))
COMMITS = 6


@pytest.fixture(scope="module")
def crashed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database as a killed process leaves it: all but the tables is in the log."""
    folder = tmp_path_factory.mktemp("killed")
    open_sqlite(folder / "lines.db", schema=SCHEMA, busy_timeout_s=5.0).close()
    connection = open_sqlite(folder / "lines.db", schema=SCHEMA, busy_timeout_s=5.0)
    for number in range(COMMITS):
        connection.execute("INSERT INTO lines VALUES (?, ?)", (number, "word " * 400))
    left = tmp_path_factory.mktemp("left")
    for name in ("lines.db", "lines.db-wal"):
        shutil.copy(folder / name, left / name)
    connection.close()
    return left / "lines.db"


def _lines(path: Path) -> list[int]:
    connection = open_sqlite(path, schema=SCHEMA, busy_timeout_s=5.0)
    try:
        return [number for (number,) in connection.execute("SELECT number FROM lines ORDER BY number")]
    finally:
        connection.close()


def _end(path: Path) -> str:
    try:
        return f"{len(_lines(path))} lines"
    except DamagedFile as error:
        return "told" if "lines.db-wal is damaged near byte" in str(error) else str(error)


def _copy_with_flip(crashed: Path, folder: Path, at: int) -> Path:
    folder.mkdir()
    shutil.copy(crashed, folder / "lines.db")
    log = bytearray(crashed.with_name("lines.db-wal").read_bytes())
    log[at] ^= 0x10
    (folder / "lines.db-wal").write_bytes(log)
    return folder / "lines.db"


def test_a_flipped_byte_loses_no_commit_but_the_latest_unnoticed(crashed: Path, tmp_path: Path) -> None:
    size = crashed.with_name("lines.db-wal").stat().st_size
    # Every byte of the header of the log, and some of each frame.
    ends = [_end(_copy_with_flip(crashed, tmp_path / str(at), at)) for at in (*range(32), *range(32, size, 631))]
    assert set(ends) == {"told", f"{COMMITS - 1} lines"}
    assert ends.count("told") > ends.count(f"{COMMITS - 1} lines")


def test_a_refused_log_stays_as_it_is(crashed: Path, tmp_path: Path) -> None:
    path = _copy_with_flip(crashed, tmp_path / "one", 5000)
    before = path.with_name("lines.db-wal").read_bytes()
    assert [_end(path), _end(path)] == ["told", "told"]
    assert path.with_name("lines.db-wal").read_bytes() == before


def test_a_log_whose_latest_commit_was_cut_is_read_up_to_there(crashed: Path, tmp_path: Path) -> None:
    shutil.copy(crashed, tmp_path / "lines.db")
    log = crashed.with_name("lines.db-wal").read_bytes()
    (tmp_path / "lines.db-wal").write_bytes(log[:-100])
    assert _lines(tmp_path / "lines.db") == list(range(COMMITS - 1))


def test_a_log_that_begins_anew_in_front_of_older_frames_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "lines.db"
    writer = open_sqlite(path, schema=SCHEMA, busy_timeout_s=5.0)
    for number in range(COMMITS):
        writer.execute("INSERT INTO lines VALUES (?, ?)", (number, "word " * 400))
    writer.execute("PRAGMA wal_checkpoint(RESTART)")
    assert _lines(path) == list(range(COMMITS))
    writer.execute("INSERT INTO lines VALUES (?, ?)", (COMMITS, "one more"))
    assert _lines(path) == list(range(COMMITS + 1))
    writer.close()
