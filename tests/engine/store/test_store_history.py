"""What every store keeps of the past: histories, undo, and entries taken over from another store."""

from __future__ import annotations

import time
from pathlib import Path

import msgspec
import pytest

from engine.errors import EntryConflict, EntryNotFound, StoreError
from engine.skills.entries import EntryRecord
from engine.store import EntryChange
from tests.engine.store.stores import KINDS, Opener, opener_of


@pytest.fixture(params=KINDS, name="opener")
def chosen_opener(request: pytest.FixtureRequest) -> Opener:
    """Give each implementation in turn."""
    return opener_of(request.param, request)


def without_times(changes: tuple[EntryChange, ...]) -> tuple[EntryChange, ...]:
    """The same changes as if all had happened at once."""
    return tuple(msgspec.structs.replace(change, changed_unix_ms=0) for change in changes)


async def test_the_history_tells_every_change(opener: Opener, tmp_path: Path) -> None:
    """Writing, overwriting and deleting are three changes."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {"n": 1})
        await store.put("record", "state", {"n": 2})
        await store.delete("record", "state")
        values: list[dict[str, object] | None] = [{"n": 1}, {"n": 2}, None]
        assert without_times(await store.history("record", "state")) == tuple(
            EntryChange(kind="record", name="state", revision=n, value=value) for n, value in enumerate(values, 1)
        )
        assert await store.history("record", "never") == ()


async def test_each_change_says_who_when_and_why(opener: Opener, tmp_path: Path) -> None:
    """The history of an entry is its story; the list shows the last chapter."""
    before_ms = time.time_ns() // 1_000_000
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"n": 1}, by="ana", reason="taught by hand")
        await store.put("record", "a", {"n": 2}, by="bor")
        await store.delete("record", "a", by="eva", reason="not needed")
        told = await store.history("record", "a")
        assert [(c.by, c.reason) for c in told] == [("ana", "taught by hand"), ("bor", ""), ("eva", "not needed")]
        assert before_ms <= told[0].changed_unix_ms <= told[-1].changed_unix_ms <= time.time_ns() // 1_000_000
        await store.put("record", "b", {}, by="ana")
        assert [(key.by, key.changed_unix_ms >= before_ms) for key in await store.list()] == [("ana", True)]


async def test_undo_goes_back_one_change_at_a_time_to_before_the_first(opener: Opener, tmp_path: Path) -> None:
    """Values and tags come back as new revisions; nothing of the history is lost."""
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"n": 1}, tags=["one"])
        await store.put("record", "a", {"n": 2}, tags=["two"])
        await store.put("record", "a", {"n": 3})
        undone = [await store.undo("record", "a", by="ana", reason="no") for _ in range(3)]
        with pytest.raises(StoreError, match="record a: there is no change left to undo"):
            await store.undo("record", "a")
        assert [(c.revision, c.value, c.tags, c.restores) for c in undone] == [
            (4, {"n": 2}, ("two",), 2),
            (5, {"n": 1}, ("one",), 1),
            (6, None, (), 0),
        ]
        assert await store.list() == ()
        assert without_times(await store.history("record", "a"))[3:] == without_times(tuple(undone))


async def test_undoing_a_deletion_brings_the_entry_back(opener: Opener, tmp_path: Path) -> None:
    """A slip of the finger costs nothing."""
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"n": 1}, tags=["kept"])
        await store.delete("record", "a")
        await store.undo("record", "a")
        there = EntryRecord(kind="record", name="a", value={"n": 1}, revision=3)
        assert await store.get("record", "a") == there
        assert (await store.list(tags=["kept"]))[0].name == "a"


async def test_undo_refuses_a_stale_revision_and_an_entry_that_never_was(opener: Opener, tmp_path: Path) -> None:
    """It compares as a write does."""
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"n": 1})
        with pytest.raises(EntryConflict, match="revision 1 is stored, revision 9 was expected"):
            await store.undo("record", "a", expected_revision=9)
        with pytest.raises(EntryNotFound):
            await store.undo("record", "b")


async def test_an_entry_is_adopted_with_its_whole_history_once(opener: Opener, tmp_path: Path) -> None:
    """Revisions, times, reasons and deletions stay; again it changes nothing, and what came since is added."""
    async with opener(tmp_path / "one") as one, opener(tmp_path / "two") as two:
        await one.put("record", "a", {"n": 1}, by="ana", reason="x", tags=["t"])
        await one.put("record", "a", {"n": 2})
        await one.put("record", "gone", {})
        await one.delete("record", "gone")
        assert await one.all_names() == (("record", "a"), ("record", "gone"))
        assert await two.import_histories([await one.history(*key) for key in await one.all_names()]) == 4
        assert await two.import_histories([await one.history("record", "a")]) == 0
        await one.undo("record", "a")
        assert await two.import_histories([await one.history("record", "a")]) == 1
        assert [await two.history(*key) for key in await two.all_names()] == [
            await one.history(*key) for key in await one.all_names()
        ]
        assert await two.list() == await one.list()
        assert (await two.list(tags=["t"]))[0].name == "a"


async def test_an_entry_with_another_history_is_not_adopted(opener: Opener, tmp_path: Path) -> None:
    """Nothing is overwritten, and nothing else of that call is taken."""
    async with opener(tmp_path / "one") as one, opener(tmp_path / "two") as two:
        for store, n in ((one, 1), (two, 2)):
            await store.put("record", "b", {"n": n})
        await one.put("record", "a", {})
        with pytest.raises(EntryConflict, match="record b: the target has another history: revision 1 differs"):
            await two.import_histories([await one.history(*key) for key in await one.all_names()])
        assert [key.name for key in await two.list()] == ["b"]
