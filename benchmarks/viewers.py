"""Many people who watch: `python -P benchmarks/viewers.py [--viewers N] [--seconds S] [--no-record]`.

The demo cell with a behavior that moves both arms, journal, recording and dashboard, first without and then with so
many viewers, in a process of their own: each has the live stream of the run and the 3D view open, as a page has.
One of them reads nothing. Printed are the server's memory as it goes, its CPU, and how soon its loop takes what is
posted to it from elsewhere.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import sys
import tempfile
import time
from asyncio.subprocess import PIPE, Process
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import viser
import websockets.asyncio.client
from websockets.typing import Subprotocol

from benchmarks.process_cpu import cpu_s, memory_mb
from benchmarks.realtime import Reactions
from editor_web.server import dashboard
from engine.cell.open_cell import OpenCell
from engine.cli.inputs import read_behavior, read_cell
from engine.journal import Journal
from engine.project.session import Session
from engine.project.session_recordings import SessionRecordings
from engine.registry import load_states

BEHAVIOR = Path(__file__).with_name("two_arms_for_ever.yaml")
_ROOT = Path(__file__).parents[1]
_WARM_UP_S = 5.0
_SAMPLE_S = 1.0
_ALONE_S = 60.0


@dataclass(kw_only=True)
class ViewerLoad:
    """What was measured while so many watched."""

    viewers: int
    memory_mb: list[float] = field(default_factory=list[float])
    reactions_s: list[float] = field(default_factory=list[float])
    cpu: float = 0.0
    got: dict[str, int] = field(default_factory=dict[str, int])


def main() -> None:
    """Measure and print; or, for ourselves, watch."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--viewers", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--no-record", action="store_true", help="do not record the run")
    for name in ("url", "token", "run"):
        parser.add_argument(f"--{name}", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.url:
        watching = _watch(options.url, options.token, options.run, viewers=options.viewers)
        print(json.dumps(asyncio.run(watching)))
        return
    asyncio.run(_measure(options.viewers, options.seconds, records=not options.no_record))


async def _measure(viewers: int, seconds: float, *, records: bool) -> None:
    with tempfile.TemporaryDirectory() as folder_name:
        folder = Path(folder_name)
        catalogue = load_states()
        behavior, _ = read_behavior(copied_behavior(folder / "behaviors"), catalogue)
        with Journal.open(folder) as journal:
            async with (
                OpenCell(read_cell(None, behavior), store_path=str(folder / "store.db")) as cell,
                Session(
                    cell,
                    project=folder,
                    catalogue=catalogue,
                    journal=journal,
                    recordings=SessionRecordings(folder / "recordings") if records else None,
                ) as session,
                dashboard(session, token_file=folder / "tokens", shadows=False) as page,
            ):
                run = await session.start(f"behaviors/{BEHAVIOR.name}", parameters={}, seed=1)
                await asyncio.sleep(_WARM_UP_S)
                _print(await _while_watched(cell, 0, min(seconds, _ALONE_S), None))
                if viewers > 0:
                    watching = await _watchers(page.url, page.token, run, viewers)
                    await asyncio.sleep(_WARM_UP_S)
                    _print(await _while_watched(cell, viewers, seconds, watching))
                await session.stop(run, reason="it was long enough")
                await session.wait(run)


def copied_behavior(folder: Path) -> Path:
    """Put the behavior into the folder where a project has them, with the cell where it is, and return its file."""
    folder.mkdir()
    copy = folder / BEHAVIOR.name
    cells = (_ROOT / "behaviors" / "cells").as_posix()
    copy.write_text(BEHAVIOR.read_text(encoding="utf-8").replace("../behaviors/cells", cells), encoding="utf-8")
    return copy


async def _while_watched(cell: OpenCell, viewers: int, seconds: float, watching: Process | None) -> ViewerLoad:
    row = ViewerLoad(viewers=viewers)
    reactions = Reactions(cell.bus)
    started_s, started_cpu_s = time.monotonic(), cpu_s(os.getpid())
    while time.monotonic() < started_s + seconds:
        await asyncio.sleep(_SAMPLE_S)
        row.memory_mb.append(memory_mb(os.getpid()))
    row.cpu = (cpu_s(os.getpid()) - started_cpu_s) / (time.monotonic() - started_s)
    reactions.close()
    row.reactions_s = reactions.latencies_s
    if watching is not None:
        out, _ = await watching.communicate(b"")
        row.got = json.loads(out.splitlines()[-1])
    return row


async def _watchers(url: str, token: str, run: str, viewers: int) -> Process:
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-P", "-m", "benchmarks.viewers", f"--viewers={viewers}",
        f"--url={url}", f"--token={token}", f"--run={run}",
        stdin=PIPE, stdout=PIPE, cwd=_ROOT, env={**os.environ, "PYTHONPATH": str(_ROOT)},
    )  # fmt: skip
    assert process.stdout is not None
    if await process.stdout.readline() != b"ready\n":
        raise RuntimeError("the viewers did not start; see above")
    return process


async def _watch(url: str, token: str, run: str, *, viewers: int) -> dict[str, int]:
    """Watch as so many pages until the input is closed; the first one reads nothing."""
    got = {"messages": 0, "bytes": 0, "lost": 0}
    ready = asyncio.Barrier(2 * viewers + 1)
    tasks = [
        asyncio.create_task(watch)
        for number in range(viewers)
        for watch in (
            _one(f"{url.replace('http', 'ws', 1)}api/v1/live", token, got, ready, reads=number > 0, run=run),
            _one(f"{url.replace('http', 'ws', 1)}cell/page{number}/", token, got, ready, reads=number > 0),
        )
    ]
    await ready.wait()
    print("ready", flush=True)
    await asyncio.to_thread(sys.stdin.read)
    for task in tasks:
        task.cancel()
    await asyncio.wait(tasks)
    return got


async def _one(
    url: str, token: str, got: dict[str, int], ready: asyncio.Barrier, *, reads: bool, run: str = ""
) -> None:
    connection = websockets.asyncio.client.connect(
        url,
        subprotocols=None if run else [Subprotocol(f"viser-v{viser.__version__}")],
        additional_headers={"Authorization": f"Bearer {token}"},
        max_size=None,
        max_queue=1,
        compression=None,
        close_timeout=0.1,
        proxy=None,
    )
    async with connection as socket:
        if run:
            await socket.send(json.dumps({"k": "watch", "run": run}))
        await ready.wait()
        if not reads:
            await asyncio.Event().wait()
        try:
            async for message in socket:
                got["messages"] += 1
                got["bytes"] += len(message)
                if run and '"k":"ping"' in str(message)[:20]:
                    await socket.send('{"k":"pong"}')
        finally:
            got["lost"] += socket.close_code is not None


def _print(row: ViewerLoad) -> None:
    memory, reactions = row.memory_mb, np.array(row.reactions_s) * 1e3
    print(f"{row.viewers} viewers, {len(memory) * _SAMPLE_S:.0f} s", flush=True)
    tenth = max(1, len(memory) // 10)
    print(
        f"  memory {np.mean(memory[:tenth]):.0f} MB at first, {np.mean(memory[-tenth:]):.0f} MB in the end,"
        f" {max(memory):.0f} MB at most"
    )
    print(f"  {row.cpu:.0%} of a core, all threads of the server")
    print(
        f"  reaction {np.quantile(reactions, 0.5):.2f} ms, 99th percentile {np.quantile(reactions, 0.99):.2f} ms,"
        f" at most {reactions.max():.1f} ms"
    )
    if row.got:
        print(
            f"  they got {row.got['messages']} messages, {row.got['bytes'] / 1e6:.1f} MB; {row.got['lost']} were lost"
        )


if __name__ == "__main__":
    main()
