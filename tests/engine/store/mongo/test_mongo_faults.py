"""What a store on MongoDB does when its server, its network or its own process fails."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pymongo
import pytest

from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store import EntryChange, Store
from engine.store.mongo.mongo_store import MongoStore
from tests.engine.store.mongod import RUNS_HERE, Mongod
from tests.engine.store.proxy import Proxy
from tests.engine.store.stores import DURABLE_KINDS, database_of, opener_of

ROOT = Path(__file__).parents[4]
# Writes entries one after the other, and says of each when it is acknowledged.
WRITER = """
import asyncio, sys
from engine.store import open_store
async def main():
    async with await open_store(sys.argv[1], database=sys.argv[2]) as store:
        for n in range(1_000_000):
            await store.put("record", f"e{n % 5}", {"n": n})
            print(n, flush=True)
asyncio.run(main())
"""


@pytest.fixture(params=[True, False], ids=["replicated", "standalone"])
def own_mongod(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Mongod]:
    """A server of the test's own, which it may kill."""
    if not RUNS_HERE:
        pytest.skip("the MongoDB server of the tests runs on Linux x86-64 only")
    server = Mongod(replicated=request.param, folder=tmp_path)
    server.start()
    yield server
    server.remove()


async def test_a_server_killed_amid_writes_loses_nothing_that_was_acknowledged(own_mongod: Mongod) -> None:
    """Four stores go on writing over kill -9 and restart, and see no error at all."""
    stores = [MongoStore.open(own_mongod.uri, patience_s=60.0) for _ in range(4)]
    acknowledged: dict[str, int] = {}
    enough = asyncio.Event()
    restarted = asyncio.Event()

    async def write(writer: int, store: Store) -> None:
        n = 0
        after = 0
        while after < 3:
            record = await store.put("record", f"w{writer}_{n}", {"n": n})
            acknowledged[record.name] = n
            n += 1
            after += restarted.is_set()
            if len(acknowledged) >= 40:
                enough.set()

    async def fail() -> None:
        await enough.wait()
        own_mongod.kill()
        await asyncio.to_thread(own_mongod.start)
        restarted.set()

    try:
        await asyncio.gather(fail(), *(write(number, store) for number, store in enumerate(stores)))
        there = {record.name: (record.value["n"], record.revision) for record in await stores[0].export()}
    finally:
        for store in stores:
            await store.close()
    assert {name: there.get(name) for name in acknowledged} == {name: (n, 1) for name, n in acknowledged.items()}


@pytest.mark.parametrize("kind", DURABLE_KINDS)
async def test_a_writing_process_that_is_killed_loses_nothing_that_was_acknowledged(
    kind: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """Entries, their histories and what a search finds agree afterwards, at whatever point it died."""
    opener = opener_of(kind, request)
    async with opener(tmp_path) as store:
        address = store.address if kind.startswith("sqlite") else store.address.rpartition("/")[0]
    command = [sys.executable, "-c", WRITER, address, database_of(tmp_path)]
    said = -1
    process = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.PIPE, cwd=ROOT)
    assert process.stdout is not None
    async for line in process.stdout:
        said = int(line)
        if said == 40:
            process.send_signal(signal.SIGKILL)
    assert await process.wait() == -signal.SIGKILL
    async with opener(tmp_path) as store:
        histories = {name: await store.history(kind, name) for kind, name in await store.all_names()}
        shown = {record.name: record for record in await store.export()}
        found = [key.name for key in await store.list(text="e")]
    written = sorted(n for history in histories.values() for change in history if (n := _count(change)) is not None)
    assert written[: said + 1] == list(range(said + 1))
    assert len(written) - said - 1 <= 1, "at most one write was under way"
    assert {name: record.revision for name, record in shown.items()} == {n: len(h) for n, h in histories.items()}
    assert found == sorted(histories)


def _count(change: EntryChange) -> int | None:
    n = change.value["n"] if change.value is not None else None
    return n if isinstance(n, int) else None


@pytest.mark.parametrize("mode", ["replicated", "standalone"])
@pytest.mark.parametrize("lost", ["change", "entry"])
async def test_a_write_whose_answer_is_lost_is_made_once(
    mode: str, lost: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """The network breaks between the write and its answer; back again, the store finds its own write."""
    server: Mongod = request.getfixturevalue(f"{mode}_mongo")
    request_name = b"insert" if lost == "change" else b"update"
    async with Proxy(server.port) as proxy:
        opening = MongoStore.open
        async with await asyncio.to_thread(
            opening, proxy.uri, database=database_of(tmp_path), patience_s=60.0
        ) as store:
            await store.put("record", "a", {"n": 1})
            proxy.swallow_answer_to(request_name + b"\x00" + _length_of(lost) + lost.encode())
            writing = asyncio.create_task(store.put("record", "a", {"n": 2}, expected_revision=1))
            await asyncio.wait_for(proxy.swallowed.wait(), 60)
            proxy.restore()
            assert (await asyncio.wait_for(writing, 60)).revision == 2
            assert [change.value for change in await store.history("record", "a")] == [{"n": 1}, {"n": 2}]


def _length_of(text: str) -> bytes:
    """The length of a text as it stands before it in BSON."""
    return (len(text) + 1).to_bytes(4, "little")


@pytest.mark.parametrize("mode", ["replicated", "standalone"])
async def test_a_writer_that_is_late_shows_nothing_older_than_what_is_there(
    mode: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """It made revision 2 and is held up; another makes revision 3, which stays."""
    server: Mongod = request.getfixturevalue(f"{mode}_mongo")
    database = database_of(tmp_path)
    async with Proxy(server.port) as proxy, MongoStore.open(server.uri, database=database) as quick:
        late = await asyncio.to_thread(MongoStore.open, proxy.uri, database=database)
        async with late:
            await late.put("record", "a", {"n": 1})
            proxy.hold_request(b"update\x00" + _length_of("entry") + b"entry")
            writing = asyncio.create_task(late.put("record", "a", {"n": 2}))
            await asyncio.wait_for(proxy.held.wait(), 60)
            assert (await quick.put("record", "a", {"n": 3})).revision == 3
            proxy.released.set()
            assert (await asyncio.wait_for(writing, 60)).revision == 2
            shown = await quick.get("record", "a")
    assert (shown.value, shown.revision) == ({"n": 3}, 3)


async def test_a_network_that_stays_cut_is_reported_and_reading_goes_on_afterwards(
    replicated_mongo: Mongod, tmp_path: Path
) -> None:
    """The message has the address, what to check, and that the write may have arrived."""
    async with Proxy(replicated_mongo.port) as proxy:
        store = await asyncio.to_thread(MongoStore.open, proxy.uri, database=database_of(tmp_path), patience_s=3.0)
        async with store:
            await store.put("record", "a", {"n": 1})
            proxy.cut()
            with pytest.raises(
                StoreError,
                match=rf"127\.0\.0\.1:{proxy.port}/t.* cannot be written: the server cannot be reached: .*"
                r"\(check that mongod runs there.*; the interrupted write may have taken effect",
            ):
                await store.put("record", "a", {"n": 2})
            with pytest.raises(StoreError, match="cannot be read: the server cannot be reached"):
                await store.get("record", "a")
            proxy.restore()
            value: object = None
            while value is None:
                try:
                    value = (await store.get("record", "a")).value
                except StoreError:
                    continue
    assert value in ({"n": 1}, {"n": 2})


async def test_a_follower_misses_nothing_over_a_broken_network(replicated_mongo: Mongod, tmp_path: Path) -> None:
    """The stream goes on where it broke off."""
    heard: asyncio.Queue[EntryChange] = asyncio.Queue()
    database = database_of(tmp_path)
    async with Proxy(replicated_mongo.port) as proxy:
        following = await asyncio.to_thread(MongoStore.open, proxy.uri, database=database, patience_s=60.0)
        async with following, MongoStore.open(replicated_mongo.uri, database=database) as writing:
            await following.follow(heard.put_nowait)
            await writing.put("record", "a", {"n": 1})
            assert (await asyncio.wait_for(heard.get(), 60)).value == {"n": 1}
            proxy.cut()
            await writing.put("record", "a", {"n": 2})
            await writing.put("record", "a", {"n": 3})
            proxy.restore()
            assert [(await asyncio.wait_for(heard.get(), 60)).value for _ in range(2)] == [{"n": 2}, {"n": 3}]


async def test_a_change_that_nobody_showed_is_shown_by_the_next_who_comes(
    standalone_mongo: Mongod, tmp_path: Path
) -> None:
    """A writer died between the revision and the entry: its history, and any write, heal that."""
    async with MongoStore.open(standalone_mongo.uri, database=database_of(tmp_path), inline=True) as store:
        await store.put("record", "a", {"n": 1})
        client: pymongo.MongoClient[dict[str, object]] = pymongo.MongoClient(standalone_mongo.uri)
        with client:
            entries = client[database_of(tmp_path)]["entry"]
            before = entries.find_one({"_id": "record a"})
            await store.put("record", "a", {"n": 2})
            assert before is not None
            entries.replace_one({"_id": "record a"}, before)
            assert (await store.get("record", "a")).revision == 1
            assert (await store.put("record", "a", {"n": 3})).revision == 3
            entries.replace_one({"_id": "record a"}, before)
            assert len(await store.history("record", "a")) == 3
            assert (await store.get("record", "a")).value == {"n": 3}
            entries.replace_one({"_id": "record a"}, before)
            assert (
                len(
                    await store.seed([EntryRecord(kind="record", name="a", value={"n": 9}, revision=0)], overwrite=True)
                )
                == 1
            )
            assert (await store.get("record", "a")).revision == 4
