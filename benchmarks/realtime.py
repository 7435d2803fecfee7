"""Whether the control loop keeps its time while everything else runs: `realtime.py [--seconds N] [--browser]`.

Both arms of the demo cell are held by each of the two control laws, first with nothing else going
on, then with everything: a behavior that moves both arms, journal, recorder, dashboard, and a viewer
of the 3D view. Run it with `python -P`: without it the neighbour `engine.py` would shadow the package.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import platform
import random
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import get_args

import numpy as np

from benchmarks.busy_cell import busy_cell
from benchmarks.process_cpu import cpu_s, descendants
from benchmarks.swinging_arms import CELL, swing_for_ever
from benchmarks.timing_jitter import Punctuality, watch
from engine.bus import SkillBus
from engine.document.cell import load_cell
from engine.skills.arm_control import ControllerName, ControlSettings
from robots.scene.scene_builder import build_scene
from robots.sim.host.loop_timing import LoopTiming
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld

# Models are compiled and caches filled at first; that is no part of the work of every day.
_WARM_UP_S = 4.0


@dataclass(kw_only=True)
class Row:
    """One line of the table. CPU is in shares of a core; what did not run has none."""

    name: str
    fifo: bool = False
    punctuality: Punctuality | None = None
    world_cpu: float = 0.0
    engine_cpu: float | None = None
    viewer_cpu: float | None = None
    reactions_s: list[float] = field(default_factory=list[float])
    remark: str = ""


class Reactions:
    """Posts to a bus from a thread at random times, and times how soon its loop takes what was posted."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._post, name="reactions")
        self.latencies_s: list[float] = []
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._ending.set()
        self._thread.join()

    def _post(self) -> None:
        random_times = random.Random(1)
        while not self._ending.wait(0.005 + 0.01 * random_times.random()):
            posted_s = time.perf_counter()
            self._bus.post(lambda posted_s=posted_s: self.latencies_s.append(time.perf_counter() - posted_s))


async def measure(row: Row, host: ProcessHost, seconds: float, *, viewer: int | None = None) -> None:
    """Let it run for a while, and note how punctual the world was and what each process used."""
    await asyncio.sleep(_WARM_UP_S)
    watchers = descendants(viewer) if viewer is not None else ()
    started_s = time.perf_counter()
    world, own, watching = cpu_s(host.pid), cpu_s(os.getpid()), cpu_s(*watchers)
    row.fifo, row.punctuality = host.fifo, await watch(host, seconds)
    wall_s = time.perf_counter() - started_s
    row.world_cpu = (cpu_s(host.pid) - world) / wall_s
    row.engine_cpu = (cpu_s(os.getpid()) - own) / wall_s
    if watchers:
        row.viewer_cpu = (cpu_s(*watchers) - watching) / wall_s


async def alone(controller: ControllerName, seconds: float) -> Row:
    """The world with both arms swinging, commanded directly."""
    row = Row(name=f"{_words(controller)}, nothing else")
    scene = build_scene(load_cell(CELL).document)
    host = ProcessHost(scene)
    async with SimWorld(scene, host=host) as world:
        for name in world.arm_names():
            world.arm(name).configure(ControlSettings(controller=controller))
        swinging = [asyncio.create_task(swing_for_ever(world, name)) for name in world.arm_names()]
        await measure(row, host, seconds)
        for task in swinging:
            task.cancel()
        await asyncio.wait(swinging)
    return row


async def everything(controller: ControllerName, seconds: float, *, browser: bool) -> Row:
    """The same with all that a cell has."""
    row = Row(name=f"{_words(controller)}, everything on")
    with tempfile.TemporaryDirectory() as name:
        async with busy_cell(controller, folder=Path(name), browser=browser) as busy:
            reactions = Reactions(busy.cell.bus)
            try:
                await measure(row, busy.host, seconds, viewer=busy.viewer_pid)
            finally:
                reactions.close()
            row.reactions_s = reactions.latencies_s
        size = busy.recording.stat().st_size
        row.remark = (
            f"{busy.events} events, recording {size / 1e6:.1f} MB, "
            f"the viewer got {busy.seen['messages']} messages, {busy.seen['bytes'] / 1e6:.1f} MB"
        )
    return row


_COLUMNS: dict[str, Callable[[Row, Punctuality], str]] = {
    "late p50 ms": lambda _, p: f"{p.whole.late_p50_s * 1e3:.3f}",
    "p99": lambda _, p: f"{p.whole.late_p99_s * 1e3:.3f}",
    "max": lambda _, p: f"{p.whole.late_max_s * 1e3:.2f}",
    "overruns": lambda _, p: _overruns(p.whole),
    "given up s": lambda _, p: f"{p.whole.slipped_s:.3f}",
    "empty loop p99": lambda _, p: f"{p.empty_p99_s * 1e3:.3f}",
    "max ": lambda _, p: f"{p.empty_max_s * 1e3:.2f}",
    "quiet time": lambda _, p: _percent(p.quiet_share),
    "late p99 then": lambda _, p: "–" if p.quiet is None else f"{p.quiet.late_p99_s * 1e3:.3f}",
    "overruns then": lambda _, p: "–" if p.quiet is None else _overruns(p.quiet),
    "CPU world": lambda r, _: _percent(r.world_cpu),
    "engine": lambda r, _: _percent(r.engine_cpu),
    "viewer": lambda r, _: _percent(r.viewer_cpu),
    "reaction p50 / p99 ms": lambda r, _: _quantiles(r.reactions_s),
}


def table(rows: list[Row]) -> str:
    """Return the rows as Markdown, and below what else there is to say of them."""
    lines = [f"| | {' | '.join(_COLUMNS)} |", "|---" + "|---:" * len(_COLUMNS) + "|"]
    for row in rows:
        if row.punctuality is not None:
            cells = (cell(row, row.punctuality) for cell in _COLUMNS.values())
            lines.append(f"| {row.name} | {' | '.join(cells)} |")
    return "\n".join([*lines, "", *(f"- {row.name}: {row.remark}" for row in rows if row.remark), *_ratios(rows)])


def _ratios(rows: list[Row]) -> list[str]:
    lines: list[str] = []
    for alone_, busy in zip(rows[::2], rows[1::2], strict=True):
        before = alone_.punctuality.quiet if alone_.punctuality is not None else None
        after = busy.punctuality.quiet if busy.punctuality is not None else None
        if before is not None and after is not None:
            p50, p99 = after.late_p50_s / before.late_p50_s, after.late_p99_s / before.late_p99_s
            lines.append(f"- {busy.name}: late p50 × {p50:.2f}, p99 × {p99:.2f} of {alone_.name}, in quiet time")
    return lines


def _overruns(timing: LoopTiming) -> str:
    return f"{100 * timing.overruns / max(timing.steps, 1):.2f} % of {timing.steps}"


def _words(controller: ControllerName) -> str:
    return controller.replace("_", " ")


def _percent(share: float | None) -> str:
    return "–" if share is None else f"{100 * share:.0f} %"


def _quantiles(latencies_s: list[float]) -> str:
    if not latencies_s:
        return "–"
    p50, p99 = np.quantile(latencies_s, (0.5, 0.99)) * 1e3
    return f"{p50:.2f} / {p99:.2f}"


async def measured(seconds: float, *, browser: bool) -> list[Row]:
    """Return two rows for each control law."""
    rows: list[Row] = []
    for controller in get_args(ControllerName):
        rows.append(await alone(controller, seconds))
        rows.append(await everything(controller, seconds, browser=browser))
    return rows


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0, help="measured time of each row (default 20)")
    parser.add_argument("--browser", action="store_true", help="draw the 3D view in Chromium, in software")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    rows = asyncio.run(measured(options.seconds, browser=options.browser))
    fifo = "yes" if all(row.fifo for row in rows) else "not permitted"
    print(f"{platform.machine()}, {os.cpu_count()} cores, load {load:.1f} before, Python {platform.python_version()}")
    print(f"SCHED_FIFO: {fifo}\n\n{table(rows)}")


if __name__ == "__main__":
    main()
