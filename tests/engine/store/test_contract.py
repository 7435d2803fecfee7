"""What every store does; a new implementation adds itself to `OPENERS` and passes the same tests."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager
from pathlib import Path

import pytest

from engine.errors import EntryNotFound, StoreError
from engine.messages import Pose
from engine.skills.entries import EntryRecord
from engine.store import EntryChange, EntryKey, Joints, SqliteStore, Store

Opener = Callable[[Path], AbstractAsyncContextManager[Store]]


def _sqlite_inline(place: Path) -> SqliteStore:
    return SqliteStore.open(place / "store.db", inline=True)


def _sqlite_threaded(place: Path) -> SqliteStore:
    return SqliteStore.open(place / "store.db")


OPENERS: dict[str, Opener] = {"sqlite inline": _sqlite_inline, "sqlite threaded": _sqlite_threaded}
HOME: dict[str, object] = {"joints": [0.0, -0.5, 1.0], "names": []}


@pytest.fixture(params=OPENERS, name="opener")
def chosen_opener(request: pytest.FixtureRequest) -> Opener:
    """Give each implementation in turn."""
    return OPENERS[request.param]


async def test_what_was_put_is_got_with_its_revision(opener: Opener, tmp_path: Path) -> None:
    """A round trip fills in defaults and counts from 1."""
    async with opener(tmp_path) as store:
        written = await store.put("joints", "home", {"joints": [0, -0.5, 1]})
        assert written == EntryRecord(kind="joints", name="home", value=HOME, revision=1)
        assert await store.get("joints", "home") == written


async def test_messages_are_stored_by_their_fields(opener: Opener, tmp_path: Path) -> None:
    """A pose given as a message and as fields is the same entry."""
    async with opener(tmp_path) as store:
        by_message = await store.put("pose", "pick", Pose(xyz=(0.1, 0.2, 0.3)))
        by_fields = await store.put("pose", "pick", {"xyz": [0.1, 0.2, 0.3], "xyzw": [0, 0, 0, 1], "frame": "world"})
        assert (by_fields.value, by_fields.revision) == (by_message.value, 2)


async def test_entries_outlive_the_store_that_wrote_them(opener: Opener, tmp_path: Path) -> None:
    """Opened again, the entry is there."""
    async with opener(tmp_path) as store:
        written = await store.put("joints", "home", HOME)
    async with opener(tmp_path) as store:
        assert await store.get("joints", "home") == written


async def test_a_missing_entry_is_answered_with_the_near_names(opener: Opener, tmp_path: Path) -> None:
    """A typo in a behavior is explained."""
    async with opener(tmp_path) as store:
        await store.put("joints", "left_above", HOME)
        with pytest.raises(EntryNotFound, match=r"no joints entry called left_abov \(did you mean left_above\?\)"):
            await store.get("joints", "left_abov")


async def test_a_name_of_another_kind_is_pointed_out(opener: Opener, tmp_path: Path) -> None:
    """Asking for a pose where joints are stored says so."""
    async with opener(tmp_path) as store:
        await store.put("joints", "home", HOME)
        with pytest.raises(EntryNotFound, match="there is a joints of this name"):
            await store.get("pose", "home")


async def test_a_write_on_a_stale_revision_says_which_is_there(opener: Opener, tmp_path: Path) -> None:
    """Compare-and-set refuses and changes nothing."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {"n": 1})
        await store.put("record", "state", {"n": 2}, expected_revision=1)
        with pytest.raises(StoreError, match="record state: revision 2 is there, revision 1 was expected"):
            await store.put("record", "state", {"n": 3}, expected_revision=1)
        assert (await store.get("record", "state")).value == {"n": 2}


async def test_revision_zero_means_that_there_must_be_none(opener: Opener, tmp_path: Path) -> None:
    """Creating twice is refused; updating what is not there as well."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {}, expected_revision=0)
        with pytest.raises(StoreError, match="revision 1 is there, none was expected"):
            await store.put("record", "state", {}, expected_revision=0)
        with pytest.raises(StoreError, match="there is no such entry, revision 4 was expected"):
            await store.put("record", "other", {}, expected_revision=4)


async def test_of_many_writers_with_one_revision_exactly_one_wins(opener: Opener, tmp_path: Path) -> None:
    """Counting with compare-and-set from two stores on one database loses no count."""
    async with opener(tmp_path) as one, opener(tmp_path) as other:
        await one.put("record", "counter", {"n": 0})

        async def increment(store: Store) -> None:
            while True:
                seen = await store.get("record", "counter")
                count = seen.value["n"]
                assert isinstance(count, int)
                with contextlib.suppress(StoreError):
                    await store.put("record", "counter", {"n": count + 1}, expected_revision=seen.revision)
                    return

        await asyncio.gather(*(increment(store) for store in (one, other) * 5))
        assert await one.get("record", "counter") == EntryRecord(
            kind="record", name="counter", value={"n": 10}, revision=11
        )


async def test_listing_filters_by_kind_and_prefix_and_sorts(opener: Opener, tmp_path: Path) -> None:
    """`_` and `.` in a prefix mean themselves."""
    async with opener(tmp_path) as store:
        for name in ("left_b", "left_a", "leftxa", "right"):
            await store.put("joints", name, HOME)
        await store.put("record", "left_z", {})
        assert await store.list(kind="joints", prefix="left_") == (
            EntryKey(kind="joints", name="left_a", revision=1),
            EntryKey(kind="joints", name="left_b", revision=1),
        )
        assert [key.name for key in await store.list(prefix="left_")] == ["left_a", "left_b", "left_z"]
        assert len(await store.list()) == 5


async def test_a_deleted_entry_is_gone_and_its_revisions_never_come_again(opener: Opener, tmp_path: Path) -> None:
    """Whoever held the old revision cannot overwrite the new entry."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {"n": 1})
        await store.delete("record", "state", expected_revision=1)
        with pytest.raises(EntryNotFound):
            await store.get("record", "state")
        with pytest.raises(EntryNotFound):
            await store.delete("record", "state")
        assert (await store.put("record", "state", {"n": 2})).revision == 3


async def test_deleting_a_stale_revision_is_refused(opener: Opener, tmp_path: Path) -> None:
    """A deletion compares as a write does."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {"n": 1})
        with pytest.raises(StoreError, match="revision 1 is there, revision 7 was expected"):
            await store.delete("record", "state", expected_revision=7)
        assert (await store.get("record", "state")).revision == 1


async def test_the_history_tells_every_change(opener: Opener, tmp_path: Path) -> None:
    """Writing, overwriting and deleting are three changes."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {"n": 1})
        await store.put("record", "state", {"n": 2})
        await store.delete("record", "state")
        values: list[dict[str, object] | None] = [{"n": 1}, {"n": 2}, None]
        assert await store.history("record", "state") == tuple(
            EntryChange(kind="record", name="state", revision=n, value=value) for n, value in enumerate(values, 1)
        )
        assert await store.history("record", "never") == ()


async def test_seeding_writes_only_what_is_missing(opener: Opener, tmp_path: Path) -> None:
    """A cell that starts again keeps what was taught in the meantime."""
    entries = [EntryRecord(kind="record", name=name, value={"from": "seed"}, revision=0) for name in ("a", "b")]
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"from": "teaching"})
        assert await store.seed(entries) == (EntryKey(kind="record", name="b", revision=1),)
        assert (await store.get("record", "a")).value == {"from": "teaching"}


async def test_overwriting_seed_replaces_what_differs_and_leaves_the_rest(opener: Opener, tmp_path: Path) -> None:
    """An import that changes nothing makes no revision."""
    entries = [EntryRecord(kind="record", name=name, value={"from": "seed"}, revision=0) for name in ("a", "b")]
    async with opener(tmp_path) as store:
        await store.seed(entries)
        await store.put("record", "a", {"from": "teaching"})
        assert await store.seed(entries, overwrite=True) == (EntryKey(kind="record", name="a", revision=3),)


async def test_a_seed_with_one_bad_entry_writes_none(opener: Opener, tmp_path: Path) -> None:
    """All or nothing."""
    good = EntryRecord(kind="record", name="good", value={}, revision=0)
    bad = EntryRecord(kind="joints", name="bad", value={"joints": ["x"]}, revision=0)
    async with opener(tmp_path) as store:
        with pytest.raises(StoreError, match="joints bad: this is no joints"):
            await store.seed([good, bad])
        assert await store.list() == ()


async def test_what_one_store_exports_another_takes(opener: Opener, tmp_path: Path) -> None:
    """Export and seed are each other's inverse."""
    async with opener(tmp_path / "one") as one, opener(tmp_path / "two") as two:
        await one.put("joints", "home", Joints(joints=(1.0, 2.0)))
        await one.put("pose", "pick", Pose(xyz=(0.1, 0.2, 0.3)))
        await one.put("record", "note", {"nested": {"list": [1, 2.5, None, "ü"]}})
        exported = await one.export()
        await two.seed(exported)
        assert [record.name for record in exported] == ["home", "pick", "note"]
        assert await two.export() == exported
        assert await two.export(kind="pose", prefix="pi") == exported[1:2]


async def test_a_watcher_hears_each_change_until_it_is_ended(opener: Opener, tmp_path: Path) -> None:
    """Writes, deletions and seeds are told in order; refused writes are not."""
    heard: list[EntryChange] = []
    async with opener(tmp_path) as store:
        end = store.watch(heard.append)
        await store.put("record", "a", {"n": 1})
        with pytest.raises(StoreError):
            await store.put("record", "a", {"n": 2}, expected_revision=9)
        await store.seed([EntryRecord(kind="record", name="b", value={}, revision=0)])
        await store.delete("record", "a")
        end()
        await store.put("record", "c", {})
    assert [(change.name, change.revision, change.value) for change in heard] == [
        ("a", 1, {"n": 1}),
        ("b", 1, {}),
        ("a", 2, None),
    ]


@pytest.mark.parametrize("name", ["", "Home", "1st", "a b", "a\x00b", "../etc", "a" * 129, "é", "a\n", "$a"])
async def test_names_outside_the_pattern_are_refused(opener: Opener, tmp_path: Path, name: str) -> None:
    """No database sees a strange name."""
    async with opener(tmp_path) as store:
        with pytest.raises(StoreError, match="cannot be the name of an entry"):
            await store.put("record", name, {})
        with pytest.raises(StoreError, match="cannot be the name of an entry"):
            await store.get("record", name)


async def test_the_longest_name_and_a_large_value_are_kept_whole(opener: Opener, tmp_path: Path) -> None:
    """Limits are inclusive: 128 characters, and megabytes of a trajectory."""
    value: dict[str, object] = {"samples": [[0.001 * n, -0.002 * n] for n in range(50_000)], "$a": {"a.b": 1}}
    async with opener(tmp_path) as store:
        await store.put("record", "a" * 128, value)
        assert (await store.get("record", "a" * 128)).value == value


async def test_an_unknown_kind_is_answered_with_the_known_ones(opener: Opener, tmp_path: Path) -> None:
    """A mistyped kind is explained."""
    async with opener(tmp_path) as store:
        with pytest.raises(StoreError, match=r"no kind of entry called 'joint' \(did you mean joints\?\)"):
            await store.put("joint", "home", HOME)


async def test_a_closed_store_says_so_and_closes_again(opener: Opener, tmp_path: Path) -> None:
    """Use after closing is an error, closing twice is none."""
    store = opener(tmp_path)
    async with store as opened:
        pass
    await opened.close()
    with pytest.raises(StoreError, match="the store is closed"):
        await opened.get("record", "a")
