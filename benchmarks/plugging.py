"""How soon a module is usable after it was asked for, and what it costs the control loop: `plugging.py [--plugs N]`.

The trolley of the shipped cell comes and goes in real time, with the arm moving. A request is answered when physics,
planning scene, frames, parts and drawing have the module. Run it with `python -P`: without it the neighbour `engine.py`
would shadow the package.
"""

from __future__ import annotations

import argparse
import asyncio
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import JointState, PartPoses
from engine.skills.modules import PlugModule, UnplugModule
from engine.skills.motion import JointTrapVel
from engine.skills.planning_scene import ReadPlanningScene
from robots.sim.host.loop_timing import LoopTiming
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld

CELL = Path(__file__).parents[1] / "behaviors" / "cells" / "trolley.yaml"
MODULE, PART = "trolley", "trolley/block_1"
_TARGET_S = 0.5
# The planning scene is made, and caches are filled, at first.
_WARM_UP_S = 3.0
_PAUSE_S = 0.2


@dataclass(kw_only=True)
class PlugFigures:
    """What was measured; memories are those of the world's process after the first and the last plug, MB."""

    plug_s: list[float] = field(default_factory=list[float])
    unplug_s: list[float] = field(default_factory=list[float])
    alone: LoopTiming | None = None
    plugging: LoopTiming | None = None
    memories_mb: tuple[float, float] = (0.0, 0.0)


async def measure(plugs: int) -> PlugFigures:
    """Plug and unplug the trolley so many times."""
    figures = PlugFigures()
    async with OpenCell(load_cell(CELL)) as cell:
        world = cell.world
        assert isinstance(world, SimWorld)
        assert isinstance(world.host, ProcessHost)
        await cell.bus.call(ReadPlanningScene(), to="cell")
        swinging = asyncio.create_task(_swing(cell.bus))
        await asyncio.sleep(_WARM_UP_S)
        start = world.host.timing()
        await asyncio.sleep(2 * plugs * _PAUSE_S)
        figures.alone = world.host.timing().since(start)
        start = world.host.timing()
        for number in range(plugs):
            figures.plug_s.append(await _timed(cell.bus, PlugModule(), is_there=True))
            if number == 0:
                figures.memories_mb = (_memory_mb(world.host.pid), 0.0)
            await asyncio.sleep(_PAUSE_S)
            figures.unplug_s.append(await _timed(cell.bus, UnplugModule(), is_there=False))
            await asyncio.sleep(_PAUSE_S)
        figures.plugging = world.host.timing().since(start)
        figures.memories_mb = (figures.memories_mb[0], _memory_mb(world.host.pid))
        swinging.cancel()
        await asyncio.wait((swinging,))
    return figures


async def _timed(bus: SkillBus, request: PlugModule | UnplugModule, *, is_there: bool) -> float:
    """Return how long it takes until the request is answered; everybody knows then."""
    asked_s = time.perf_counter()
    await bus.call(request, to=MODULE)
    took_s = time.perf_counter() - asked_s
    parts = bus.topic("cell/parts", PartPoses).latest
    scene = await bus.call(ReadPlanningScene(), to="cell")
    assert parts is not None
    assert (PART in parts.poses) == (PART in {one.name for one in scene.obstacles}) == is_there
    return took_s


async def _swing(bus: SkillBus) -> None:
    """Move the arm to and fro, far from the connectors."""
    start = bus.topic("arm/joint_state", JointState).latest
    assert start is not None
    sign = 1.0
    while True:
        goal = tuple(joint + (0.2 * sign if index > 3 else 0.0) for index, joint in enumerate(start.position_rad))
        await bus.send_goal(JointTrapVel(joints=goal, speed=0.2), to="arm").result()
        sign = -sign


def _memory_mb(pid: int) -> float:
    fields = Path(f"/proc/{pid}/status").read_text(encoding="utf-8").splitlines()
    return next(int(line.split()[1]) for line in fields if line.startswith("VmRSS")) / 1024


_LOOP_COLUMNS: dict[str, Callable[[LoopTiming], str]] = {
    "steps": lambda loop: f"{loop.steps}",
    "late p99 ms": lambda loop: f"{loop.late_p99_s * 1e3:.2f}",
    "late max": lambda loop: f"{loop.late_max_s * 1e3:.2f}",
    "overruns": lambda loop: f"{loop.overruns}",
    "given up s": lambda loop: f"{loop.slipped_s:.3f}",
}


def report(figures: PlugFigures) -> str:
    """Return the figures as Markdown."""
    lines = ["| | median ms | p95 | largest |", "|---|---:|---:|---:|"]
    for name, times_s in (("plug", figures.plug_s), ("unplug", figures.unplug_s)):
        p50, p95, most = np.quantile(times_s, (0.5, 0.95, 1.0)) * 1e3
        lines.append(f"| {name}, {len(times_s)} times | {p50:.1f} | {p95:.1f} | {most:.1f} |")
    lines += ["", f"| control loop | {' | '.join(_LOOP_COLUMNS)} |", "|---" + "|---:" * len(_LOOP_COLUMNS) + "|"]
    for name, loop in (("nothing is plugged", figures.alone), ("plugged and unplugged", figures.plugging)):
        if loop is not None:
            lines.append(f"| {name} | {' | '.join(column(loop) for column in _LOOP_COLUMNS.values())} |")
    before, after = figures.memories_mb
    lines += ["", f"Memory of the world's process: {before:.1f} MB after the first plug, {after:.1f} MB at the end."]
    lines.append(f"Target: usable within {_TARGET_S:g} s; {sum(t > _TARGET_S for t in figures.plug_s)} took longer.")
    return "\n".join(lines)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="time plugs of a module in real time")
    parser.add_argument("--plugs", type=int, default=100, help="how often it is plugged, and unplugged")
    options = parser.parse_args()
    print(report(asyncio.run(measure(options.plugs))))


if __name__ == "__main__":
    main()
