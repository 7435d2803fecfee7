"""What only the SQLite store can show: its file, its locks, its worker thread."""

from __future__ import annotations

import asyncio
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


async def test_a_cancelled_write_that_took_effect_is_still_told(tmp_path: Path) -> None:
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
