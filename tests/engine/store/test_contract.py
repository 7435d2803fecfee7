"""What every store does, shown on each: SQLite, and MongoDB with and without a replica set."""

from __future__ import annotations

import asyncio
from pathlib import Path

import msgspec
import pytest

from engine.errors import EntryConflict, EntryNotFound, StoreError
from engine.messages import Pose
from engine.skills.entries import EntryRecord
from engine.store import EntryChange, EntryKey, Joints, Store
from tests.engine.store.stores import KINDS, Opener, opener_of

HOME: dict[str, object] = {"joints": [0.0, -0.5, 1.0], "names": [], "model": ""}


@pytest.fixture(params=KINDS, name="opener")
def chosen_opener(request: pytest.FixtureRequest) -> Opener:
    """Give each implementation in turn."""
    return opener_of(request.param, request)


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
        with pytest.raises(StoreError, match="record state: revision 2 is stored, revision 1 was expected"):
            await store.put("record", "state", {"n": 3}, expected_revision=1)
        assert (await store.get("record", "state")).value == {"n": 2}


async def test_revision_zero_means_that_there_must_be_none(opener: Opener, tmp_path: Path) -> None:
    """Creating twice is refused; updating what is not there as well."""
    async with opener(tmp_path) as store:
        await store.put("record", "state", {}, expected_revision=0)
        with pytest.raises(StoreError, match="revision 1 is stored, no entry was expected"):
            await store.put("record", "state", {}, expected_revision=0)
        with pytest.raises(StoreError, match="there is no such entry, revision 4 was expected"):
            await store.put("record", "other", {}, expected_revision=4)


async def test_eight_writers_at_once_lose_no_update_and_hear_of_each_conflict(opener: Opener, tmp_path: Path) -> None:
    """Eight stores count in one entry by compare-and-set; whoever comes too late is told, and tries again."""
    stores = [opener(tmp_path) for _ in range(8)]
    conflicts: list[EntryConflict] = []

    async def count_up(store: Store) -> None:
        done = 0
        while done < 5:
            seen = await store.get("record", "counter")
            count = seen.value["n"]
            assert isinstance(count, int)
            try:
                await store.put("record", "counter", {"n": count + 1}, expected_revision=seen.revision)
                done += 1
            except EntryConflict as conflict:
                conflicts.append(conflict)

    try:
        await stores[0].put("record", "counter", {"n": 0})
        await asyncio.gather(*(count_up(store) for store in stores))
        counted = await stores[0].get("record", "counter")
        history = await stores[0].history("record", "counter")
    finally:
        for store in stores:
            await store.close()
    assert counted == EntryRecord(kind="record", name="counter", value={"n": 40}, revision=41)
    assert [change.value for change in history] == [{"n": n} for n in range(41)]
    assert all("is stored, revision" in str(conflict) for conflict in conflicts)


async def test_eight_writers_that_expect_nothing_all_leave_their_mark(opener: Opener, tmp_path: Path) -> None:
    """Without an expected revision the last one wins, and the history has every write once."""
    stores = [opener(tmp_path) for _ in range(8)]
    try:
        await asyncio.gather(*(store.put("record", "x", {"by": n}) for n, store in enumerate(stores)))
        history = await stores[0].history("record", "x")
        shown = await stores[0].get("record", "x")
    finally:
        for store in stores:
            await store.close()
    assert sorted(str(change.value) for change in history) == sorted(str({"by": n}) for n in range(8))
    assert (shown.value, shown.revision) == (history[-1].value, 8)


async def test_listing_filters_by_kind_and_prefix_and_sorts(opener: Opener, tmp_path: Path) -> None:
    """`_` and `.` in a prefix mean themselves."""
    async with opener(tmp_path) as store:
        for name in ("left_b", "left_a", "leftxa", "right"):
            await store.put("joints", name, HOME)
        await store.put("record", "left_z", {})
        found = await store.list(kind="joints", prefix="left_")
        assert [(key.kind, key.name, key.revision) for key in found] == [
            ("joints", "left_a", 1),
            ("joints", "left_b", 1),
        ]
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
        with pytest.raises(StoreError, match="revision 1 is stored, revision 7 was expected"):
            await store.delete("record", "state", expected_revision=7)
        assert (await store.get("record", "state")).revision == 1


async def test_seeding_writes_only_what_is_missing(opener: Opener, tmp_path: Path) -> None:
    """A cell that starts again keeps what was taught in the meantime."""
    entries = [EntryRecord(kind="record", name=name, value={"from": "seed"}, revision=0) for name in ("a", "b")]
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"from": "teaching"})
        assert [(key.name, key.revision) for key in await store.seed(entries)] == [("b", 1)]
        assert (await store.get("record", "a")).value == {"from": "teaching"}


async def test_overwriting_seed_replaces_what_differs_and_leaves_the_rest(opener: Opener, tmp_path: Path) -> None:
    """An import that changes nothing makes no revision."""
    entries = [EntryRecord(kind="record", name=name, value={"from": "seed"}, revision=0) for name in ("a", "b")]
    async with opener(tmp_path) as store:
        await store.seed(entries)
        await store.put("record", "a", {"from": "teaching"})
        assert [(key.name, key.revision) for key in await store.seed(entries, overwrite=True)] == [("a", 3)]


async def test_tags_go_along_with_what_is_exported_and_seeded(opener: Opener, tmp_path: Path) -> None:
    """Entries without any word of tags keep those they have."""
    async with opener(tmp_path / "here") as here, opener(tmp_path / "there") as there:
        await here.put("record", "a", {"n": 1}, tags=["tested", "fast"])
        await here.put("record", "b", {"n": 1})
        await there.put("record", "a", {"n": 1}, tags=["old"])
        await there.put("record", "b", {"n": 0}, tags=["old"])
        exported = await here.export()
        assert [record.tags for record in exported] == [("fast", "tested"), ()]
        assert await there.seed(exported) == ()
        silent = [msgspec.structs.replace(record, tags=None) for record in exported]
        assert [(key.name, key.tags) for key in await there.seed(silent, overwrite=True)] == [("b", ("old",))]
        written = await there.seed(exported, overwrite=True)
        assert [(key.name, key.tags) for key in written] == [("a", ("fast", "tested")), ("b", ())]
        assert [key.name for key in await there.list(tags=["tested"])] == ["a"]


async def test_a_seed_with_one_bad_entry_writes_none(opener: Opener, tmp_path: Path) -> None:
    """All or nothing."""
    good = EntryRecord(kind="record", name="good", value={}, revision=0)
    bad = EntryRecord(kind="joints", name="bad", value={"joints": ["x"]}, revision=0)
    async with opener(tmp_path) as store:
        with pytest.raises(StoreError, match="joints bad: invalid joints entry"):
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
    async with store:
        pass
    await store.close()
    with pytest.raises(StoreError, match="the store is closed"):
        await store.get("record", "a")


async def test_tags_stay_until_they_are_replaced(opener: Opener, tmp_path: Path) -> None:
    """Overwriting a value keeps them; an empty list takes them away."""
    async with opener(tmp_path) as store:
        await store.put("record", "a", {"n": 1}, tags=["tested", "bench-2", "tested"])
        await store.put("record", "a", {"n": 2})
        assert (await store.list())[0].tags == ("bench-2", "tested")
        assert await store.list(tags=["tested", "bench-2"]) == await store.list()
        assert await store.list(tags=["test"]) == ()
        await store.put("record", "a", {"n": 3}, tags=[])
        assert (await store.list())[0].tags == ()
        assert await store.list(tags=["tested"]) == ()


@pytest.mark.parametrize("tag", ["", "Two Words", "ä", "x" * 65])
async def test_tags_outside_the_pattern_are_refused(opener: Opener, tmp_path: Path, tag: str) -> None:
    """As names are."""
    async with opener(tmp_path) as store:
        with pytest.raises(StoreError, match=r"record a: .* cannot be a tag"):
            await store.put("record", "a", {}, tags=[tag])


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("left", ["left_above_pick", "left_home", "old_left"]),
        ("pick LE", ["left_above_pick"]),
        ("home", ["left_home", "right_home"]),
        ("eft", []),
        ("slow", ["right_home"]),
        ("home slow-", ["right_home"]),
        ("", ["left_above_pick", "left_home", "old_left", "right_home"]),
        ("!", []),
        ("$where", []),
    ],
)
async def test_search_finds_beginnings_of_words_of_names_and_tags(
    opener: Opener, tmp_path: Path, text: str, found: list[str]
) -> None:
    """Each word that is typed must begin some word."""
    async with opener(tmp_path) as store:
        for name in ("left_home", "left_above_pick", "old_left"):
            await store.put("record", name, {})
        await store.put("record", "right_home", {}, tags=["slow-motion"])
        await store.put("record", "gone_left", {})
        await store.delete("record", "gone_left")
        assert [key.name for key in await store.list(text=text)] == found


async def test_pages_follow_one_another_without_gap_or_overlap(opener: Opener, tmp_path: Path) -> None:
    """The last entry of a page is where the next begins."""
    async with opener(tmp_path) as store:
        for kind in ("record", "joints"):
            for n in range(4):
                await store.put(kind, f"e{n}", HOME)
        pages: list[EntryKey] = []
        page: tuple[EntryKey, ...] = ()
        while page := await store.list(limit=3, after=page[-1] if page else None, text="e"):
            pages += page
        assert tuple(pages) == await store.list()
        assert len(pages) == 8


async def test_a_follower_hears_what_another_store_commits(opener: Opener, tmp_path: Path) -> None:
    """Changes by others and its own, each once; an inline store, which nobody shares, hears its own."""
    heard: asyncio.Queue[EntryChange] = asyncio.Queue()
    async with opener(tmp_path) as mine, opener(tmp_path) as theirs:
        end = await mine.follow(heard.put_nowait)
        await mine.put("record", "mine", {"n": 1})
        first = await asyncio.wait_for(heard.get(), 60)
        await theirs.put("record", "theirs", {"n": 2}, by="them")
        if await _is_inline(mine):
            end()
            return
        second = await asyncio.wait_for(heard.get(), 60)
        await mine.put("record", "mine", {"n": 3})
        third = await asyncio.wait_for(heard.get(), 60)
        end()
        assert [(c.name, c.value, c.by) for c in (first, second, third)] == [
            ("mine", {"n": 1}, ""),
            ("theirs", {"n": 2}, "them"),
            ("mine", {"n": 3}, ""),
        ]


async def _is_inline(store: Store) -> bool:
    """Whether the store works on the calling thread: then an answer is there without the loop turning once."""
    asking = asyncio.ensure_future(store.list())
    await asyncio.sleep(0)
    done = asking.done()
    await asking
    return done


async def test_a_value_of_more_than_eight_megabytes_is_refused_in_words(opener: Opener, tmp_path: Path) -> None:
    """A document of 16 MB, and one just above the limit."""
    async with opener(tmp_path) as store:
        for size in (16 * 1024 * 1024, 8 * 1024 * 1024):
            with pytest.raises(
                StoreError,
                match=r"record big: the value takes .* MB, more than 8\.4 MB \(split it into several entries\)",
            ):
                await store.put("record", "big", {"text": "x" * size})
        assert await store.list() == ()


@pytest.mark.parametrize(
    "value",
    [
        {"$ref": "a", "$id": 1},
        {"nested": [{"$oid": "650000000000000000000000"}, {"$date": 1}]},
        {"a\x00b": 1},
        {"": {"$set": {"a.b": None}}},
        {"low": -(2**63), "high": 2**63 - 1, "small": 3, "tiny": 5e-324, "minus": -0.0, "one": 1.0},
        {"many": [0] * 1_200_000},
    ],
    ids=["reference", "extended json", "zero byte", "operators", "numbers", "larger as BSON than as JSON"],
)
async def test_any_value_comes_back_as_it_was(opener: Opener, tmp_path: Path, value: dict[str, object]) -> None:
    """Keys and numbers that a database could take for something else."""
    async with opener(tmp_path) as store:
        await store.put("record", "a", value)
        got = await store.get("record", "a")
        assert msgspec.json.encode(got.value, order="deterministic") == msgspec.json.encode(
            value, order="deterministic"
        )
