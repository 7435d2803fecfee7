"""Entries move from one kind of store to the other with all that is known about them."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import EntryConflict, StoreError
from engine.store import EntryChange, SqliteStore, Store, migrate
from tests.engine.store.stores import DURABLE_KINDS, Opener, opener_of


@pytest.fixture(params=[kind for kind in DURABLE_KINDS if kind.startswith("mongodb")])
def mongo(request: pytest.FixtureRequest) -> Opener:
    """MongoDB with and without a replica set."""
    return opener_of(request.param, request)


async def _fill(store: Store) -> None:
    for n in range(230):
        await store.put("record", f"e{n:03}", {"n": n})
    await store.put("record", "e001", {"n": -1}, by="ana", reason="better", tags=["x"])
    await store.undo("record", "e001")
    await store.delete("record", "e002")


async def _all(store: Store) -> list[tuple[EntryChange, ...]]:
    return [await store.history(kind, name) for kind, name in await store.all_names()]


async def test_there_and_back_again_nothing_is_lost(mongo: Opener, tmp_path: Path) -> None:
    """From a file to a server, which takes batches of 200, and on to another file."""
    async with (
        SqliteStore.open(tmp_path / "here.db") as here,
        mongo(tmp_path) as there,
        SqliteStore.open(tmp_path / "back.db") as back,
    ):
        await _fill(here)
        first = await migrate(here, there)
        second = await migrate(there, back)
        assert (first.entries, first.changes, first.new_changes) == (230, 233, 233)
        assert first.digest == second.digest
        assert await _all(here) == await _all(there) == await _all(back)
        assert await here.list() == await there.list() == await back.list()
        assert await there.list(tags=["x"]) == await here.list(tags=["x"])


async def test_migrating_again_adds_what_came_since(mongo: Opener, tmp_path: Path) -> None:
    """It may break off and be repeated."""
    async with SqliteStore.open(tmp_path / "here.db") as here, mongo(tmp_path) as there:
        await here.put("record", "a", {"n": 1})
        await migrate(here, there)
        await here.put("record", "a", {"n": 2})
        await here.put("record", "b", {})
        assert (await migrate(here, there)).new_changes == 2
        assert (await migrate(here, there)).new_changes == 0


async def test_an_entry_that_was_changed_on_both_sides_stops_the_migration(mongo: Opener, tmp_path: Path) -> None:
    """Neither side is overwritten."""
    async with SqliteStore.open(tmp_path / "here.db") as here, mongo(tmp_path) as there:
        await here.put("record", "a", {"n": 1})
        await migrate(here, there)
        await here.put("record", "a", {"here": 2})
        await there.put("record", "a", {"there": 2})
        with pytest.raises(EntryConflict, match="record a: the target has another history: revision 2 differs"):
            await migrate(here, there)
        assert (await there.get("record", "a")).value == {"there": 2}


async def test_a_target_that_does_not_keep_what_it_takes_is_found_out(tmp_path: Path) -> None:
    """The verification reads everything back."""

    class Forgetful(SqliteStore):
        async def history(self, kind: str, name: str) -> tuple[EntryChange, ...]:
            return (await super().history(kind, name))[:-1]

    async with SqliteStore.open(tmp_path / "here.db") as here:
        await here.put("record", "a", {"n": 1})
        async with Forgetful.open(tmp_path / "there.db") as there:
            with pytest.raises(StoreError, match="record a: the revisions differ: 0 in the target, 1 in the source"):
                await migrate(here, there)
