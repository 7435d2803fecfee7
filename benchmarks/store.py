"""Both stores side by side with 100 000 entries: reading, writing, pages and searches.

    python -P benchmarks/store.py [--entries 100000]

The MongoDB server is the one of the tests: a replica set of one, writes confirmed on disk.
"""

from __future__ import annotations

import argparse
import asyncio
import tempfile
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

from engine.errors import EntryNotFound
from engine.skills.entries import EntryRecord
from engine.store import SqliteStore, Store
from engine.store.mongo.mongo_store import MongoStore
from tests.engine.store.mongod import Mongod

BATCH = 2000
PLACES = ("left", "right", "tray", "press", "tester")
STEPS = ("home", "above_pick", "pick", "carry", "above_place", "place", "wait")
PAGE = 50

Work = Callable[[], Awaitable[object]]


def new_entries(count: int) -> list[EntryRecord]:
    """Joint configurations named by place, step and number, such as `left_above_pick_00042`."""
    return [
        EntryRecord(
            kind="joints",
            name=f"{PLACES[n % len(PLACES)]}_{STEPS[n % len(STEPS)]}_{n:05}",
            value={"joints": [0.001 * n, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8], "names": []},
            revision=0,
        )
        for n in range(count)
    ]


async def measured(store: Store, count: int) -> dict[str, str]:
    """Fill a store and return what each thing took."""
    entries = new_entries(count)
    started_s = time.perf_counter()
    for at in range(0, count, BATCH):
        await store.seed(entries[at : at + BATCH])
    took = {f"write {count} entries in batches": f"{time.perf_counter() - started_s:.1f} s"}
    middle = (await store.list(limit=count // 2))[-1]
    name = entries[count // 3].name

    async def write() -> None:
        await store.put("joints", "bench", {"joints": [0.0]})

    works: dict[str, Work] = {
        "get one": lambda: store.get("joints", name),
        "write one": write,
        "first page": lambda: store.list(limit=PAGE),
        "page in the middle": lambda: store.list(after=middle, limit=PAGE),
        "page under a prefix": lambda: store.list(kind="joints", prefix="tray_pl", limit=PAGE),
        "search a word of a fifth of all": lambda: store.list(text="tray", limit=PAGE),
        "search two frequent words": lambda: store.list(text="press above", limit=PAGE),
        "search one of all": lambda: store.list(text=name.rpartition("_")[2], limit=PAGE),
        "search what is not there": lambda: store.list(text="nowhere", limit=PAGE),
        "a mistyped name, with suggestions": lambda: _missed(store, name),
    }
    for title, work in works.items():
        took[title] = await _timed(work)
    return took


async def _missed(store: Store, name: str) -> None:
    try:
        await store.get("joints", name[:-1] + "x")
    except EntryNotFound:
        # The refusal is what is measured.
        return


async def _timed(work: Work) -> str:
    times: list[float] = []
    for _ in range(30):
        started_s = time.perf_counter()
        await work()
        times.append(time.perf_counter() - started_s)
    times.sort()
    return f"{times[len(times) // 2] * 1e3:.1f} ms ({times[-1] * 1e3:.1f})"


async def main(count: int) -> None:
    """Print the figures of both stores."""
    with tempfile.TemporaryDirectory() as folder:
        async with SqliteStore.open(Path(folder) / "store.db") as store:
            sqlite = await measured(store, count)
        server = Mongod(replicated=True)
        server.start()
        try:
            async with MongoStore.open(server.uri, patience_s=120.0) as store:
                mongo = await measured(store, count)
        finally:
            server.remove()
    print(f"| {count} entries, median (worst of 30) | SQLite | MongoDB |\n|---|---|---|")
    for title, value in sqlite.items():
        print(f"| {title} | {value} | {mongo[title]} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--entries", type=int, default=100_000)
    asyncio.run(main(parser.parse_args().entries))
