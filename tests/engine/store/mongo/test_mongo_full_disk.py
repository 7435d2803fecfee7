"""A MongoDB server whose disk is full: refused in words, nothing lost, and it goes on when there is room again."""

from __future__ import annotations

import asyncio
import os
import random
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.errors import StoreError
from engine.store import Store
from engine.store.mongo.mongo_store import MongoStore
from tests.engine.store.mongod import RUNS_HERE, Mongod

# A server takes 301 MB of it for its journal.
SMALL, LARGE = "340m", "800m"
ENTRY_CHARACTERS = 1_000_000
MOST_ENTRIES = 400


@dataclass(frozen=True)
class Disk:
    """A file system in memory of a size that can be changed."""

    folder: Path

    def grow(self) -> None:
        subprocess.run(["mount", "-o", f"remount,size={LARGE}", self.folder], check=True, capture_output=True)


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Disk]:
    """A small disk, which needs the right to mount one."""
    if not RUNS_HERE or os.geteuid() != 0:
        pytest.skip("a disk of its own for the MongoDB server is mounted by root on Linux x86-64 only")
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={SMALL}", "tmpfs", folder], check=False, capture_output=True, text=True
    )
    if mounted.returncode != 0:
        pytest.skip(f"no disk can be mounted here: {mounted.stderr.strip()}")
    yield Disk(folder)
    subprocess.run(["umount", "--lazy", folder], check=True, capture_output=True)


async def write_on(server: Mongod, store: Store) -> None:
    """Write, after starting the server again where it only now ends itself over what it could not write."""
    try:
        await store.put("record", "after", {"n": 1})
    except StoreError:
        assert await asyncio.to_thread(server.ends_itself, within_s=30.0)
        server.start()
        await store.put("record", "after", {"n": 1})


@pytest.mark.parametrize("replicated", [True, False], ids=["replicated", "standalone"])
async def test_a_full_disk_is_reported_and_nothing_that_was_acknowledged_is_lost(disk: Disk, replicated: bool) -> None:
    """The server says so, or ends itself, which it is told by then; each way the entries are there afterwards."""
    server = Mongod(replicated=replicated, folder=disk.folder)
    server.start()
    noise = random.Random(1)
    written: dict[str, str] = {}

    async def fill(store: Store) -> None:
        for number in range(MOST_ENTRIES):
            # What does not compress, so that it takes its room.
            text = f"{noise.getrandbits(4 * ENTRY_CHARACTERS):x}"
            await store.put("record", f"e{number}", {"text": text})
            written[f"e{number}"] = text

    full = r"cannot be written: (the disk of the server is full|.*reached.*its disk has room)"
    try:
        async with MongoStore.open(server.uri, patience_s=2.0) as store:
            with pytest.raises(StoreError, match=full):
                await fill(store)
            assert len(written) < MOST_ENTRIES
            disk.grow()
            if server.ends_itself(within_s=0):
                server.start()
            await write_on(server, store)
            there = {record.name: record.value.get("text") for record in await store.export(prefix="e")}
            assert (await store.get("record", "after")).value == {"n": 1}
            unfinished = there.keys() - written.keys()
            histories = [await store.history("record", name) for name in there]
    finally:
        server.remove()
    assert {name: there.get(name) for name in written} == written
    assert len(unfinished) <= 1, "at most the write that was refused"
    assert [len(history) for history in histories] == [1] * len(there)
