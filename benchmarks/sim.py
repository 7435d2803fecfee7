"""How fast the dual-arm cell is simulated, where the time goes, and how punctual real time is.

`python -P benchmarks/sim.py --seconds 10` prints a table; both arms swing to and fro all the time.
`--controller cartesian_impedance` measures the other control law, `--parts 20 --step-ms 2` a full table.
`--virtual` prints how fast virtual time passes with either law, with and without 20 more parts.
Without -P the neighbour `benchmarks/engine.py` would shadow the package `engine`.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import get_args

from msgspec.structs import replace

from benchmarks.step_cost import step_cost
from benchmarks.swinging_arms import CELL, Swinging, swing_for_ever
from engine.document.cell import load_cell
from engine.messages import FramePoses, PartPoses, Pose
from engine.skills.arm_control import ControllerName, ControlSettings
from robots.control.commanding.arm_commands import ConfigureArm
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import PartBody, SimScene
from robots.sim.host.loop_timing import LoopTiming
from robots.sim.host.process_host import ProcessHost
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.physics import Physics
from robots.sim.physics.scene_description import describe_scene
from robots.sim.world.sim_world import SimWorld

_SHAPES = (("box", (0.05, 0.03, 0.04), 0.1), ("cylinder", (0.03, 0.04), 0.05))


def filled(scene: SimScene, parts: int, step_s: float) -> SimScene:
    """Return the scene with another step and so many more parts on the table, boxes and cylinders in rows."""
    more: list[PartBody] = []
    for number in range(parts):
        shape, size_m, mass_kg = _SHAPES[number % len(_SHAPES)]
        xyz = (0.07 * (number % 5) - 0.14, 0.42 + 0.04 * (number // 5 % 4), 0.021 + 0.045 * (number // 20))
        more.append(PartBody(name=f"more_{number}", shape=shape, size_m=size_m, mass_kg=mass_kg, pose=Pose(xyz=xyz)))
    return replace(scene, step_s=step_s, parts=(*scene.parts, *more))


def timed(work: Callable[[], object], count: int) -> tuple[float, float]:
    """Return wall and CPU seconds of one call, over `count` calls."""
    wall, cpu = time.perf_counter(), time.process_time()
    for _ in range(count):
        work()
    return (time.perf_counter() - wall) / count, (time.process_time() - cpu) / count


def lockstep(scene: SimScene, seconds: float, settings: ControlSettings) -> None:
    """Measure stepping in this process."""
    start = time.perf_counter()
    cell = build_cell(scene)
    simulation = Simulation(cell)
    row("build and compile", f"{time.perf_counter() - start:.3f} s")
    start = time.perf_counter()
    describe_scene(scene)
    row("scene description", f"{time.perf_counter() - start:.3f} s")

    for arm in simulation.summary.arms:
        simulation.apply(ConfigureArm(arm=arm.name, settings=settings))
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
        xyz, xyzw = SimSnapshot(simulation.layout, values).frames()
        FramePoses(time_s=0.0, names=simulation.summary.frames, xyz=xyz, xyzw=xyzw)
        PartPoses(time_s=0.0, poses={})

    _, messages_cpu = timed(messages, 1000)
    row("real-time factor, both arms moving", f"{simulation.step_s / wall:.1f} wall, {simulation.step_s / cpu:.1f} CPU")
    row("one step", f"{cpu * 1e6:.1f} us CPU")
    row("  physics", f"{physics_cpu * 1e6:.1f} us")
    row("  set points and control", f"{(cpu - physics_cpu) * 1e6:.1f} us")
    row("one snapshot", f"{snapshot_cpu * 1e6:.1f} us")
    row("one frame message (30 Hz)", f"{messages_cpu * 1e6:.1f} us")


async def real_time(scene: SimScene, seconds: float, settings: ControlSettings) -> None:
    """Measure the world's own process beside a parent that is busy with JSON all the time."""
    start = time.perf_counter()
    host = ProcessHost(scene)
    async with SimWorld(scene, host=host) as world:
        row("world process ready after", f"{time.perf_counter() - start:.3f} s")
        for name in world.arm_names():
            world.arm(name).configure(settings)
        swingers = [asyncio.create_task(swing_for_ever(world, name)) for name in world.arm_names()]
        text = json.dumps({str(n): list(range(20)) for n in range(400)})
        before, end = host.timing(), time.perf_counter() + seconds
        while time.perf_counter() < end:
            json.loads(text)
            await asyncio.sleep(0)
        _print_timing(host.timing().since(before), fifo=host.fifo)
        for task in swingers:
            task.cancel()
        await asyncio.wait(swingers)


def _print_timing(timing: LoopTiming, *, fifo: bool) -> None:
    steps, overruns = timing.steps, timing.overruns
    row("real-time schedule (SCHED_FIFO)", "yes" if fifo else "not permitted")
    late = (timing.late_p50_s, timing.late_p99_s, timing.late_max_s)
    row("late p50 / p99 / max", " / ".join(f"{value * 1e3:.3f}" for value in late) + " ms")
    row("overruns", f"{overruns} of {steps} steps ({100 * overruns / max(steps, 1):.2f} %)")
    row("world time given up", f"{timing.slipped_s:.3f} s")


def virtual_time(scene: SimScene, seconds: float) -> None:
    """Print a Markdown table of how fast virtual time passes."""
    print("| | CPU × | wall × | µs CPU a step | physics | set points | law | rest | contacts |")
    print("|---|" + "---:|" * 8)
    for parts, step_s in ((0, 0.001), (20, 0.001), (20, 0.002)):
        for controller in get_args(ControllerName):
            cost = step_cost(filled(scene, parts, step_s), controller, seconds)
            what = f"{controller.replace('_', ' ')}, {parts or 'no'} more parts, {step_s * 1e3:g} ms"
            costs = (cost.cpu_s, cost.physics_s, cost.set_points_s, cost.laws_s, cost.rest_s)
            microseconds = " | ".join(f"{part_s * 1e6:.0f}" for part_s in costs)
            factors = f"{cost.cpu_factor:.1f} | {cost.wall_factor:.1f}"
            print(f"| {what} | {factors} | {microseconds} | {cost.contacts} |", flush=True)


def row(what: str, value: str) -> None:
    """Print one line of the table."""
    print(f"{what:<38} {value}")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="simulated, then real, seconds (default 10)")
    parser.add_argument("--cell", type=Path, default=CELL, help="cell document")
    parser.add_argument("--controller", choices=get_args(ControllerName), default="joint_impedance")
    parser.add_argument("--parts", type=int, default=0, help="free parts beside those of the cell (default 0)")
    parser.add_argument("--step-ms", type=float, default=1.0, help="step of the physics (default 1)")
    parser.add_argument("--virtual", action="store_true", help="print how fast virtual time passes, nothing else")
    options = parser.parse_args()
    drawn = build_scene(load_cell(options.cell).document, seed=0)
    if options.virtual:
        print(f"{platform.machine()}, load {os.getloadavg()[0]:.1f} before, Python {platform.python_version()}\n")
        virtual_time(drawn, options.seconds)
        return
    scene = filled(drawn, options.parts, options.step_ms / 1000.0)
    settings = ControlSettings(controller=options.controller)
    row("machine", f"{platform.machine()}, Python {platform.python_version()}")
    lockstep(scene, options.seconds, settings)
    asyncio.run(real_time(scene, options.seconds, settings))


if __name__ == "__main__":
    main()
