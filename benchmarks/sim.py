"""How fast the dual-arm cell is simulated, where the time goes, and how punctual real time is.

`python -P benchmarks/sim.py --seconds 10` prints a table; both arms swing to and fro all the time.
Without -P the neighbour `benchmarks/engine.py` would shadow the package `engine`.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import platform
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from engine.document.cell import load_cell
from engine.messages import FramePoses, PartPoses
from robots.control.motion_event import MotionFinished
from robots.model.registry import model_by_name
from robots.port import Array, JointTrajectory, Tolerance
from robots.sim.cell_model import build_cell
from robots.sim.cell_scene import scene_of
from robots.sim.commands import Follow
from robots.sim.physics import Physics
from robots.sim.process_host import ProcessHost
from robots.sim.scene import Scene
from robots.sim.scene_description import describe_scene
from robots.sim.simulation import Simulation
from robots.sim.snapshot import Snapshot
from robots.sim.timing import Timing
from robots.sim.world import SimWorld

CELL = Path(__file__).parents[1] / "behaviors" / "cells" / "dual_panda.yaml"
SWING_S = 1.5


def swing(start: Array, goal: Array) -> JointTrajectory:
    """Return a minimum-jerk motion between two configurations."""
    u = np.linspace(0.0, 1.0, round(SWING_S / 0.001) + 1)[:, None]
    return JointTrajectory(
        dt_s=0.001,
        position_rad=start + (goal - start) * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=(goal - start) * (30 * u**2 - 60 * u**3 + 30 * u**4) / SWING_S,
    )


class Swinging:
    """Keeps every arm of a simulation moving."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        home = np.array(model_by_name("panda").home_rad)
        there = home + np.array([0.4, 0.2, -0.3, 0.3, 0.3, -0.3, 0.5])
        self._ways = (swing(home, there), swing(there, home))
        self._arms: dict[int, tuple[str, int]] = {}
        self._number = 0
        for arm in simulation.summary.arms:
            self._start(arm.name, 0)

    def _start(self, arm: str, way: int) -> None:
        self._number += 1
        self._arms[self._number] = (arm, way)
        self._simulation.apply(Follow.of(arm, self._number, self._ways[way], Tolerance()))

    def step(self) -> None:
        """Let one step pass and start the next swing where one has ended."""
        for event in self._simulation.step():
            if isinstance(event, MotionFinished):
                arm, way = self._arms.pop(event.motion)
                self._start(arm, 1 - way)


def timed(work: Callable[[], object], count: int) -> tuple[float, float]:
    """Return wall and CPU seconds of one call, over `count` calls."""
    wall, cpu = time.perf_counter(), time.process_time()
    for _ in range(count):
        work()
    return (time.perf_counter() - wall) / count, (time.process_time() - cpu) / count


def lockstep(scene: Scene, seconds: float) -> None:
    """Measure stepping in this process."""
    start = time.perf_counter()
    cell = build_cell(scene)
    simulation = Simulation(cell)
    row("build and compile", f"{time.perf_counter() - start:.3f} s")
    start = time.perf_counter()
    describe_scene(scene)
    row("scene description", f"{time.perf_counter() - start:.3f} s")

    moving = Swinging(simulation)
    count = round(seconds / simulation.step_s)
    wall, cpu = timed(moving.step, count)
    physics = Physics(cell.model)
    physics.refresh()

    def bare() -> None:
        physics.start_step()
        physics.finish_step()

    _, physics_cpu = timed(bare, count)
    values = simulation.layout.new_array()

    def snapshot() -> None:
        simulation.write_snapshot(values)

    _, snapshot_cpu = timed(snapshot, 2000)

    def messages() -> None:
        xyz, xyzw = Snapshot(simulation.layout, values).frames()
        FramePoses(time_s=0.0, names=simulation.summary.frames, xyz=xyz, xyzw=xyzw)
        PartPoses(time_s=0.0, poses={})

    _, messages_cpu = timed(messages, 1000)
    row("real-time factor, both arms moving", f"{simulation.step_s / wall:.1f} wall, {simulation.step_s / cpu:.1f} CPU")
    row("one step", f"{cpu * 1e6:.1f} us CPU")
    row("  physics", f"{physics_cpu * 1e6:.1f} us")
    row("  set points and control", f"{(cpu - physics_cpu) * 1e6:.1f} us")
    row("one snapshot", f"{snapshot_cpu * 1e6:.1f} us")
    row("one frame message (30 Hz)", f"{messages_cpu * 1e6:.1f} us")


async def real_time(scene: Scene, seconds: float) -> None:
    """Measure the world's own process beside a parent that is busy with JSON all the time."""
    start = time.perf_counter()
    host = ProcessHost(scene)
    async with SimWorld(scene, host=host) as world:
        row("world process ready after", f"{time.perf_counter() - start:.3f} s")
        home = np.array(model_by_name("panda").home_rad)
        swingers = [asyncio.create_task(_swing_for_ever(world, name, home)) for name in world.arm_names()]
        text = json.dumps({str(n): list(range(20)) for n in range(400)})
        before, end = host.timing(), time.perf_counter() + seconds
        while time.perf_counter() < end:
            json.loads(text)
            await asyncio.sleep(0)
        _print_timing(before, host.timing(), fifo=host.fifo)
        for task in swingers:
            task.cancel()
        await asyncio.wait(swingers)


async def _swing_for_ever(world: SimWorld, name: str, home: Array) -> None:
    there = home + np.array([0.4, 0.2, -0.3, 0.3, 0.3, -0.3, 0.5])
    while True:
        for way in (swing(home, there), swing(there, home)):
            await world.arm(name).follow(way, tolerance=Tolerance()).report()


def _print_timing(before: Timing, after: Timing, *, fifo: bool) -> None:
    steps, overruns = after.steps - before.steps, after.overruns - before.overruns
    row("real-time schedule (SCHED_FIFO)", "yes" if fifo else "not permitted")
    late = (after.late_p50_s, after.late_p99_s, after.late_max_s)
    row("late p50 / p99 / max", " / ".join(f"{value * 1e3:.3f}" for value in late) + " ms")
    row("overruns", f"{overruns} of {steps} steps ({100 * overruns / max(steps, 1):.2f} %)")
    row("world time given up", f"{after.slipped_s - before.slipped_s:.3f} s")


def row(what: str, value: str) -> None:
    """Print one line of the table."""
    print(f"{what:<38} {value}")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="simulated, then real, seconds (default 10)")
    parser.add_argument("--cell", type=Path, default=CELL, help="cell document")
    options = parser.parse_args()
    scene = scene_of(load_cell(options.cell).document, seed=0)
    row("machine", f"{platform.machine()}, Python {platform.python_version()}")
    lockstep(scene, options.seconds)
    asyncio.run(real_time(scene, options.seconds))


if __name__ == "__main__":
    main()
