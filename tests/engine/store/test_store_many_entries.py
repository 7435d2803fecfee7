"""With thousands of entries a page and a search still come at once; benchmarks/store.py has the figures of 100 000."""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from engine.skills.entries import EntryRecord
from engine.store import EntryKey
from tests.engine.store.stores import DURABLE_KINDS, opener_of

COUNT = 4000
LIMIT_S = 0.1


@pytest.mark.parametrize("kind", DURABLE_KINDS)
async def test_pages_and_searches_take_less_than_a_tenth_of_a_second(
    kind: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """The quickest of some, as the machine may be busy; those looked for are the last in order."""
    entries = [
        EntryRecord(kind="record", name=f"{'tray' if n % 5 == 0 else 'left'}_{n:05}", value={"n": n}, revision=0)
        for n in range(COUNT)
    ]
    async with opener_of(kind, request)(tmp_path) as store:
        await store.seed(entries)
        middle = EntryKey(kind="record", name="left_02001", revision=1)
        works: dict[str, Callable[[], Awaitable[tuple[EntryKey, ...]]]] = {
            "first page": lambda: store.list(limit=50),
            "middle page": lambda: store.list(after=middle, limit=50),
            "frequent word": lambda: store.list(text="tray", limit=50),
            "one entry": lambda: store.list(text="tray 03995", limit=50),
        }
        took_s: dict[str, float] = {}
        found: dict[str, int] = {}
        for title, work in works.items():
            times: list[float] = []
            # Of many, until one was left alone by the rest of the machine.
            while len(times) < 50 and min(times, default=LIMIT_S) >= LIMIT_S:
                started_s = time.perf_counter()
                found[title] = len(await work())
                times.append(time.perf_counter() - started_s)
            took_s[title] = min(times)
    assert found == {"first page": 50, "middle page": 50, "frequent word": 50, "one entry": 1}
    assert {title: s for title, s in took_s.items() if s >= LIMIT_S} == {}
