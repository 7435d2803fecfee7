"""The entry services of the bus are answered from the store."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import LoopClock
from engine.errors import EntryNotFound
from engine.skills.entries import (
    DeleteEntry,
    EntryChanged,
    EntryList,
    EntryRecord,
    ListEntries,
    ReadEntry,
    ReadHistory,
    ReadRevision,
    UndoEntry,
    WriteEntry,
)
from engine.store import SqliteStore, publish_changes, register_store


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


async def test_changes_are_undone_reported_and_published_over_the_bus(tmp_path: Path) -> None:
    """Who changed what and why is on `store/changes` and in the history, whichever program did it."""
    async with (
        SqliteStore.open(tmp_path / "s.db") as store,
        SqliteStore.open(tmp_path / "s.db") as other,
        SkillBus(LoopClock()) as bus,
    ):
        register_store(bus, store)
        await publish_changes(bus, store)
        with bus.topic("store/changes", EntryChanged).stream() as changes:
            write = WriteEntry(kind="record", name="a", value={"n": 1}, tags=("x",), by="ana", reason="taught")
            await bus.call(write, to="store")
            assert await bus.call(ListEntries(text="a", tags=("x",)), to="store") == EntryList(
                entries=(("record", "a", 1),)
            )
            undone = await bus.call(UndoEntry(kind="record", name="a", by="bor"), to="store")
            assert (undone.revision, undone.deleted, undone.by) == (2, True, "bor")
            await other.put("record", "b", {}, by="another program")
            told = [await asyncio.wait_for(changes.next(), 60) for _ in range(3)]
        assert [(change.name, change.by, change.reason, change.tags) for change in told] == [
            ("a", "ana", "taught", ("x",)),
            ("a", "bor", "", ()),
            ("b", "another program", "", ()),
        ]
        assert (await bus.call(ReadHistory(kind="record", name="a"), to="store")).changes == tuple(told[:2])
        deleted = await bus.call(DeleteEntry(kind="record", name="b", by="eva", expected_revision=1), to="store")
        assert (deleted.deleted, deleted.by, deleted.revision) == (True, "eva", 2)


async def test_what_an_entry_was_is_read_over_the_bus(tmp_path: Path) -> None:
    """After each of its changes but a deletion, which left nothing."""
    async with SqliteStore.open(tmp_path / "s.db") as store, SkillBus(LoopClock()) as bus:
        register_store(bus, store)
        for n in (1, 2):
            await bus.call(WriteEntry(kind="record", name="a", value={"n": n}, tags=(f"t{n}",)), to="store")
        await bus.call(DeleteEntry(kind="record", name="a"), to="store")
        was = await bus.call(ReadRevision(kind="record", name="a", revision=1), to="store")
        assert (was.value, was.revision, was.tags) == ({"n": 1}, 1, ("t1",))
        for revision, why in ((3, "was deleted by"), (7, "has no")):
            with pytest.raises(EntryNotFound, match=f"record a {why} revision {revision}"):
                await bus.call(ReadRevision(kind="record", name="a", revision=revision), to="store")
