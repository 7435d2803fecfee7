"""What the data tabs of a page cost the server: `python -P benchmarks/data_stream.py [--topics N] [--seconds S]`.

The CPU time of each look by itself, on a bus of so many topics of seven joints; then the server's CPU with one page
that has 32 curves, one that has the bus in front, and one that reads nothing, while two topics are published at 500
a second.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import websockets.asyncio.client

from benchmarks.process_cpu import cpu_s, memory_mb
from editor_web.security.authentication import load_access_tokens
from editor_web.server import Dashboard, dashboard
from editor_web.telemetry.data_frames import DataSubscription
from editor_web.telemetry.page_subscriptions import PageSubscriptions
from engine.bus import Topic
from engine.cell.open_cell import OpenCell
from engine.journal import Journal
from engine.messages import JointState
from engine.project.session import Session
from engine.registry import load_states

CURVES = 32
_REPEATS = 200
_ROW = tuple(f"joint{number}" for number in range(7))
_PERIOD_S = 0.002


def joints(value: float) -> JointState:
    """The state of a seven-joint arm."""
    row = (value,) * 7
    return JointState(time_s=value, names=_ROW, position_rad=row, velocity_rad_s=row, effort_nm=row)


def fields() -> tuple[str, ...]:
    """The curves that are looked at: of two arms, three rows each."""
    names = ("position_rad", "velocity_rad_s", "effort_nm")
    every = [f"arm{arm}/joint_state:{name}.{n}" for arm in range(2) for name in names for n in range(7)]
    return tuple(every[:CURVES])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--topics", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=10.0)
    options = parser.parse_args()
    asyncio.run(_measure(options.topics, options.seconds))


async def _measure(topics: int, seconds: float) -> None:
    with tempfile.TemporaryDirectory() as folder, Journal.open(Path(folder)) as journal:
        async with OpenCell(None) as cell:
            made = [cell.bus.topic(f"arm{number}/joint_state", JointState) for number in range(topics)]
            for topic in made:
                topic.publish(joints(0.0))
            session = Session(cell, project=Path(folder), catalogue=load_states(), journal=journal)
            _print_looks(session, topics)
            async with dashboard(
                session, token_file=Path(folder) / "tokens", cell_view=False, shadows=False
            ) as running:
                await _print_pages(running, load_access_tokens(Path(folder) / "tokens").operator, made[:2], seconds)


def _print_looks(session: Session, topics: int) -> None:
    page = PageSubscriptions(session)
    page.look(DataSubscription(number=1, fields=fields()))
    print(f"a sample of {CURVES} curves     {_mean_us(page.sample):8.0f} us, 20 a second")
    print(f"its frame                 {_mean_us(lambda: (page.sample(), page.due())):8.0f} us")

    def traffic() -> None:
        page.look(DataSubscription(traffic=True))
        page.due()

    def message() -> None:
        page.look(DataSubscription(topic="arm0/joint_state"))
        page.due()

    print(f"traffic of {topics} topics     {_mean_us(traffic):8.0f} us, 1 a second")
    print(f"one message               {_mean_us(message):8.0f} us, at most 5 a second")


def _mean_us(work: Callable[[], object]) -> float:
    started_s = time.process_time()
    for _ in range(_REPEATS):
        work()
    return (time.process_time() - started_s) / _REPEATS * 1e6


async def _print_pages(running: Dashboard, token: str, topics: list[Topic[JointState]], seconds: float) -> None:
    publishing = asyncio.create_task(_publish(topics))
    looks: dict[str, dict[str, Any] | None] = {
        "nobody looks": None,
        f"{CURVES} curves": {"number": 1, "fields": fields()},
        "the bus in front": {"traffic": True, "topic": "arm0/joint_state"},
        f"{CURVES} curves, unread": {"number": 1, "fields": fields(), "unread": True},
    }
    for what, look in looks.items():
        watching = asyncio.create_task(_watch(running.url, token, dict(look))) if look is not None else None
        await asyncio.sleep(1.0)
        started_s, before_s = time.perf_counter(), cpu_s(os.getpid())
        await asyncio.sleep(seconds)
        share = (cpu_s(os.getpid()) - before_s) / (time.perf_counter() - started_s)
        print(f"{what:24}  {share:8.1%} CPU (with its reader), {memory_mb(os.getpid()):.0f} MB")
        if watching is not None:
            watching.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await watching
    publishing.cancel()


async def _publish(topics: list[Topic[JointState]]) -> None:
    at_s = 0.0
    while True:
        for topic in topics:
            topic.publish(joints(at_s))
        at_s += _PERIOD_S
        await asyncio.sleep(_PERIOD_S)


async def _watch(url: str, token: str, look: dict[str, Any]) -> None:
    is_read = not look.pop("unread", False)
    async with websockets.asyncio.client.connect(
        f"{url.rstrip('/').replace('http', 'ws', 1)}/api/v1/data",
        additional_headers={"Authorization": f"Bearer {token}"},
        compression=None,
        proxy=None,
        max_queue=1,
    ) as socket:
        await socket.send(json.dumps({"k": "look", **look}))
        while is_read:
            await socket.recv()
        await asyncio.Event().wait()


if __name__ == "__main__":
    main()
