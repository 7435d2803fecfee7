"""What only the SQLite store can show: its file, its locks, its worker thread."""

from __future__ import annotations

import asyncio
import resource
import sqlite3
from pathlib import Path

import pytest

from engine.errors import StoreError
from engine.store import EntryChange, SqliteStore


async def test_a_locked_file_is_reported_and_the_store_goes_on_afterwards(tmp_path: Path) -> None:
    """A store, unlike a journal, recovers when the lock is gone."""
    async with SqliteStore.open(tmp_path / "s.db", busy_timeout_s=0.01) as store:
        thief = sqlite3.connect(store.path, isolation_level=None)
        thief.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError, match=r"s\.db: the store cannot be written: .*locked.*end that program"):
            await store.put("record", "a", {})
        thief.close()
        assert (await store.put("record", "a", {})).revision == 1


def test_a_file_that_is_no_database_is_refused_with_its_path(tmp_path: Path) -> None:
    """Opening says what is wrong and where."""
    (tmp_path / "s.db").write_bytes(b"no database" * 100)
    with pytest.raises(StoreError, match=r"s\.db: the store cannot be opened: .*not a database"):
        SqliteStore.open(tmp_path / "s.db")


async def test_the_loop_goes_on_while_a_write_waits_for_a_lock(tmp_path: Path) -> None:
    """The worker thread waits, not the event loop."""
    async with SqliteStore.open(tmp_path / "s.db", busy_timeout_s=10.0) as store:
        thief = sqlite3.connect(store.path, isolation_level=None, check_same_thread=False)
        thief.execute("BEGIN IMMEDIATE")
        writing = asyncio.create_task(store.put("record", "a", {}))
        turns = 0
        while turns < 100:
            await asyncio.sleep(0)
            turns += 1
        assert not writing.done()
        thief.execute("ROLLBACK")
        thief.close()
        assert (await writing).revision == 1


async def test_a_cancelled_write_that_took_effect_is_still_reported(tmp_path: Path) -> None:
    """Watchers hear what the database holds, whatever became of the caller."""
    heard: asyncio.Queue[EntryChange] = asyncio.Queue()
    async with SqliteStore.open(tmp_path / "s.db", busy_timeout_s=10.0) as store:
        store.watch(heard.put_nowait)
        thief = sqlite3.connect(store.path, isolation_level=None, check_same_thread=False)
        thief.execute("BEGIN IMMEDIATE")
        writing = asyncio.create_task(store.put("record", "a", {}))
        started = asyncio.create_task(store.list())
        await asyncio.sleep(0)
        writing.cancel()
        thief.execute("ROLLBACK")
        thief.close()
        await started
        names = [key.name for key in await store.list()]
        told = [heard.get_nowait().name for _ in range(heard.qsize())]
        assert names == told


async def test_a_disk_that_is_full_refuses_the_write_and_keeps_the_rest(tmp_path: Path) -> None:
    """Files may grow to 200 kB; the store goes on once there is space again."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    async with SqliteStore.open(tmp_path / "s.db") as store:
        await store.put("record", "a", {"n": 1})
        resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, limits[1]))
        try:
            with pytest.raises(StoreError, match=r"s\.db: the store cannot be written: .*free"):
                await store.put("record", "b", {"text": "x" * 1_000_000})
            assert [key.name for key in await store.list()] == ["a"]
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        assert (await store.put("record", "b", {"text": "x" * 1_000_000})).revision == 1


async def test_a_store_of_the_first_format_is_read_searched_and_written(tmp_path: Path) -> None:
    """A file from before entries had tags, times and words."""
    old = sqlite3.connect(tmp_path / "s.db", isolation_level=None)
    old.executescript(
        """
        CREATE TABLE entry(kind TEXT NOT NULL, name TEXT NOT NULL, revision INTEGER NOT NULL, value TEXT NOT NULL,
            PRIMARY KEY (kind, name)) STRICT;
        CREATE TABLE change(seq INTEGER PRIMARY KEY AUTOINCREMENT, kind TEXT NOT NULL, name TEXT NOT NULL,
            revision INTEGER NOT NULL, value TEXT, UNIQUE (kind, name, revision)) STRICT;
        INSERT INTO entry VALUES ('record', 'left/old.pick-2', 1, '{"n":1}');
        INSERT INTO change VALUES (1, 'record', 'left/old.pick-2', 1, '{"n":1}');
        PRAGMA user_version=1;
        """
    )
    old.close()
    async with SqliteStore.open(tmp_path / "s.db") as store:
        assert (await store.get("record", "left/old.pick-2")).value == {"n": 1}
        for text in ("left", "old", "pick", "2"):
            assert [key.name for key in await store.list(text=text)] == ["left/old.pick-2"]
        assert (await store.put("record", "left/old.pick-2", {"n": 2}, tags=["new"])).revision == 2
        assert await store.undo("record", "left/old.pick-2") == (await store.history("record", "left/old.pick-2"))[2]
        assert (await store.get("record", "left/old.pick-2")).value == {"n": 1}
