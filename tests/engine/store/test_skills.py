"""The entry services of the bus are answered from the store."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import LoopClock
from engine.errors import EntryNotFound
from engine.skills.entries import EntryList, EntryRecord, ListEntries, ReadEntry, WriteEntry
from engine.store import SqliteStore, register_store


async def test_entries_are_written_read_and_listed_over_the_bus(tmp_path: Path) -> None:
    """The three services answer as the skills declare."""
    async with SqliteStore.open(tmp_path / "s.db") as store, SkillBus(LoopClock()) as bus:
        register_store(bus, store)
        written = await bus.call(WriteEntry(kind="record", name="a/b", value={"n": 1}), to="store")
        assert written == EntryRecord(kind="record", name="a/b", value={"n": 1}, revision=1)
        assert await bus.call(ReadEntry(kind="record", name="a/b"), to="store") == written
        assert await bus.call(ListEntries(prefix="a/"), to="store") == EntryList(entries=(("record", "a/b", 1),))
        with pytest.raises(EntryNotFound, match="did you mean a/b"):
            await bus.call(ReadEntry(kind="record", name="a/c"), to="store")
