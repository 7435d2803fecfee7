"""Runs again and again: `python -P -m benchmarks.soak [--minutes N]`; exit code 1 where something has grown.

The demo cell with journal, recordings and dashboard. Each round a page connects (live stream and 3D view), starts the
behavior that moves both arms, stops it after a moment, and goes. After each round, when its recording is finished too
(which takes a process of its own), are counted: the memory, file descriptors and threads of the server and of all its
processes, and the tasks of its event loop. The first rounds warm up: a session keeps its last 200 runs, and the 3D view
what its last 200 pages chose. Of the rounds after that the first half is compared with the second.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import random
import statistics
import sys
import tempfile
import time
from contextlib import AsyncExitStack
from dataclasses import dataclass, fields
from pathlib import Path

import httpx
import viser
import websockets.asyncio.client
from websockets.typing import Subprotocol

from benchmarks.process_cpu import descendants, memory_mb, threads
from benchmarks.viewers import BEHAVIOR, copied_behavior
from editor_web.server import Dashboard, dashboard
from engine.cell.open_cell import OpenCell
from engine.cli.inputs import read_behavior, read_cell
from engine.journal import Journal
from engine.project.session import Session
from engine.project.session_recordings import SessionRecordings
from engine.registry import load_states

_LONGEST_RUN_S = 6.0
# The server closes what was idle for some seconds; an order that is sent at that very moment would be lost.
_ONE_USE = httpx.Limits(max_keepalive_connections=0)
_RECORDINGS_KEPT = 5
_REPORT_S = 60.0
_WARM_ROUNDS = 200
_FEWEST_ROUNDS = 40
_MB_MORE = 4.0
_COUNTS_MORE = 1.0


@dataclass(frozen=True, kw_only=True)
class Count:
    """What there is at rest after a round; of the server and its processes together, tasks of the server alone."""

    memory_mb: float
    descriptors: int
    threads: int
    tasks: int


def main() -> int:
    """Go on for so long, print a line a minute, and compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    counts = asyncio.run(_soak(options.minutes * 60.0, random.Random(options.seed)))
    return 0 if _is_flat(counts) else 1


async def _soak(seconds: float, chance: random.Random) -> list[Count]:
    counts: list[Count] = []
    with tempfile.TemporaryDirectory() as folder_name:
        folder = Path(folder_name)
        catalogue = load_states()
        behavior, _ = read_behavior(copied_behavior(folder / "behaviors"), catalogue)
        recordings = SessionRecordings(folder / "recordings", kept=_RECORDINGS_KEPT)
        with Journal.open(folder) as journal:
            async with (
                OpenCell(read_cell(None, behavior), store_path=str(folder / "store.db")) as cell,
                Session(cell, project=folder, catalogue=catalogue, journal=journal, recordings=recordings) as session,
                dashboard(session, token_file=folder / "tokens", shadows=False) as page,
            ):
                print(f"{'min':>5}{'rounds':>8}{'MB':>8}{'descriptors':>13}{'threads':>9}{'tasks':>7}", flush=True)
                started_s = reported_s = time.monotonic()
                while (now_s := time.monotonic()) < started_s + seconds:
                    await _round(page, session, run_s=chance.uniform(0.0, _LONGEST_RUN_S))
                    await recordings.finished()
                    counts.append(_count())
                    if now_s - reported_s >= _REPORT_S:
                        reported_s = now_s
                        _print((now_s - started_s) / 60.0, len(counts), counts[-1])
    return counts


async def _round(page: Dashboard, session: Session, *, run_s: float) -> None:
    token = {"Authorization": f"Bearer {page.token}"}
    socket = page.url.replace("http", "ws", 1)
    async with (
        httpx.AsyncClient(base_url=page.url, headers=token, trust_env=False, timeout=60.0, limits=_ONE_USE) as http,
        AsyncExitStack() as open_sockets,
    ):
        for path, protocols in (("api/v1/live", None), ("cell/soak/", [Subprotocol(f"viser-v{viser.__version__}")])):
            connection = websockets.asyncio.client.connect(
                f"{socket}{path}",
                additional_headers=token,
                subprotocols=protocols,
                max_size=None,
                # A page that is closed says nothing more either.
                close_timeout=0.1,
                proxy=None,
            )
            await open_sockets.enter_async_context(connection)
        body: dict[str, object] = {"behavior": f"behaviors/{BEHAVIOR.name}", "parameters": {}, "seed": 1}
        run = str((await http.post("/api/v1/runs", json=body)).raise_for_status().json()["run"])
        await asyncio.sleep(run_s)
        (await http.post("/api/v1/cell/stop", json={"reason": "the round is over"})).raise_for_status()
        (await http.post("/api/v1/cell/stop/release", json={})).raise_for_status()
        await session.wait(run)


def _count() -> Count:
    gc.collect()
    processes = descendants(os.getpid())
    return Count(
        memory_mb=memory_mb(*processes),
        descriptors=sum(len(_entries(Path(f"/proc/{pid}/fd"))) for pid in processes),
        threads=threads(*processes),
        tasks=len(asyncio.all_tasks()),
    )


def _entries(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except FileNotFoundError:
        return []


def _print(minutes: float, rounds: int, count: Count) -> None:
    print(
        f"{minutes:5.1f}{rounds:8}{count.memory_mb:8.1f}{count.descriptors:13}{count.threads:9}{count.tasks:7}",
        flush=True,
    )


def _is_flat(counts: list[Count]) -> bool:
    warm = counts[_WARM_ROUNDS:]
    if len(warm) < _FEWEST_ROUNDS:
        print(f"{len(counts)} rounds: too few to compare, {_WARM_ROUNDS + _FEWEST_ROUNDS} are needed")
        return False
    half = len(warm) // 2
    before, after = warm[:half], warm[half:]
    is_flat = True
    print(f"{len(counts)} rounds; medians of rounds {_WARM_ROUNDS} to {_WARM_ROUNDS + half} and of those after:")
    for each in fields(Count):
        first, last = (statistics.median(getattr(count, each.name) for count in part) for part in (before, after))
        is_kept = last - first <= (_MB_MORE if each.name == "memory_mb" else _COUNTS_MORE)
        print(f"  {each.name:12} {first:8.1f} → {last:8.1f}  {'flat' if is_kept else 'GROWS'}")
        is_flat = is_flat and is_kept
    return is_flat


if __name__ == "__main__":
    sys.exit(main())
