"""How soon an arm answers to what cameras see in its path: `replanning.py [--rounds N]`.

A Panda of the demo cell moves to and fro in real time; physics and planners run in processes of their own. Ten times
a second comes an occupancy map of 64 x 90 x 60 voxels of 2 cm, such as `robots.vision` makes of depth images of
640 x 480, with some thousand voxels about the cell that are others each time. At a random moment of each motion
an arm of a person is in it, across the rest of the path. Cameras themselves are measured by `perception.py`.
Run it with `python -P`.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import tempfile
import time
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.realtime import Reactions
from benchmarks.timing_jitter import Punctuality, watch
from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.messages import Vector3
from engine.messages.sensing import CameraStatus, ObservedSpace, OccupancyGrid
from engine.skills.planning import FreeMotionFeedback, MotionTarget, MoveFree, PathPreview, PlanOptions
from robots.arm.arm_server import ArmServer
from robots.planning.request import PathCheck, PathCheckRequest, PlanAnswer, PlanRequest
from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.planning_scene import PlanningScene
from robots.scene.scene_builder import build_scene
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimRobot, SimWorld
from robots.workspace.live_scene import LiveScene
from robots.workspace.planning_services import PlanningServices
from robots.workspace.workspace import Workspace
from robots.workspace.world_snapshot import WorldPoseReader

CELL = Path(__file__).parents[1] / "behaviors" / "cells" / "dual_panda.yaml"
THERE = (1.1, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)
ACROSS = (-1.1, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)
SHAPE, VOXEL_M, CORNER_M = (64, 90, 60), 0.02, (-0.64, -0.9, 0.06)
_RATE_S = 0.1
_SCATTER = 3000
_QUIET_S = 12.0


@dataclass
class Round:
    """One intrusion, seconds from its map: the check answered, the arm at rest, another path confirmed, and begun."""

    answered_s: float | None = None
    rest_s: float | None = None
    confirmed_s: float | None = None
    moving_s: float | None = None
    kept: bool = False


@dataclass
class Cameras:
    """An `OccupancySource` that makes maps of nothing but chance, and of what is put into them."""

    latest: OccupancyGrid | None = None
    stale_reason: str = ""
    starting: bool = False
    observed: ObservedSpace | None = None
    camera_statuses: tuple[CameraStatus, ...] = ()
    intruder: np.ndarray | None = None
    notified_s: float = 0.0
    _random: np.random.Generator = field(default_factory=lambda: np.random.default_rng(1))
    _subscribers: list[Callable[[], None]] = field(default_factory=list[Callable[[], None]])

    def subscribe(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Report every map."""
        self._subscribers.append(callback)
        return lambda: self._subscribers.remove(callback)

    def require(self) -> None:
        """They see always."""

    def release(self) -> None:
        """They see always."""

    def forget(self) -> None:
        """They remember nothing."""

    def know(self, scene: PlanningScene) -> None:
        """They know nothing."""

    def see(self) -> None:
        """Make the next map and report it."""
        taken = np.zeros(SHAPE, dtype=bool)
        # About the edges of the box, where no arm comes.
        x, y = self._random.integers(0, SHAPE[0], _SCATTER), self._random.integers(0, 6, _SCATTER)
        taken[x, y, self._random.integers(0, SHAPE[2], _SCATTER)] = True
        if self.intruder is not None:
            taken |= self.intruder
        revision = self.latest.revision + 1 if self.latest is not None else 1
        self.latest = OccupancyGrid(
            time_s=time.monotonic(),
            revision=revision,
            corner_m=CORNER_M,
            voxel_m=VOXEL_M,
            shape=SHAPE,
            occupied=np.packbits(taken.reshape(-1)).tobytes(),
        )
        self.notified_s = time.perf_counter()
        for notify in tuple(self._subscribers):
            notify()


class TimedPlanners(PlanningServices):
    """Notes when answers came: of checks, and of paths that were confirmed."""

    checked: list[tuple[float, float]]
    planned: list[tuple[float, float]]

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where a path is blocked."""
        started_s = time.perf_counter()
        answer = await super().check_path(request)
        self.checked.append((started_s, time.perf_counter()))
        return answer

    async def confirm_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where a new path is blocked."""
        started_s = time.perf_counter()
        answer = await super().confirm_path(request)
        self.checked.append((started_s, time.perf_counter()))
        return answer

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a path."""
        started_s = time.perf_counter()
        answer = await super().plan(request)
        self.planned.append((started_s, time.perf_counter()))
        return answer


@dataclass
class ReplanningRig:
    """The open cell and what is measured in it."""

    bus: SkillBus
    host: ProcessHost
    cameras: Cameras
    planners: TimedPlanners
    rounds: list[Round] = field(default_factory=list[Round])

    async def move(self, joints: tuple[float, ...], *, intrude_after_s: float | None) -> Round | None:
        """Move, with an intrusion or without; returns what it took."""
        handle = self.bus.send_goal(
            MoveFree(target=MotionTarget(joints=joints), options=PlanOptions(speed=0.4)), to="left"
        )
        phases: list[tuple[float, str, str]] = []
        handle.on_feedback(lambda m: _note(phases, m))
        await handle.accepted()
        found: Round | None = None
        if intrude_after_s is not None:
            await asyncio.sleep(intrude_after_s)
            found = await self._intrude(phases)
            await asyncio.sleep(0.6)
            self.cameras.intruder = None
        end = await handle.result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        return found

    async def _intrude(self, phases: list[tuple[float, str, str]]) -> Round:
        preview = self.bus.topic("left/planned_path", PathPreview).latest
        assert preview is not None
        self.cameras.intruder = _arm_across(preview.tool_path[int(0.55 * (len(preview.tool_path) - 1))])
        self.cameras.see()
        notified_s, checks = self.cameras.notified_s, len(self.planners.checked)
        await asyncio.sleep(0.6)
        found = Round()
        answers = [end for begin, end in self.planners.checked[checks:] if begin >= notified_s]
        found.answered_s = answers[0] - notified_s if answers else None
        after = [(at - notified_s, phase) for at, phase, _ in phases if at > notified_s]
        rest = [at for at, phase in after if phase in ("planning", "waiting")]
        moving = [at for at, phase in after if phase == "moving" and rest and at > rest[0]]
        plans = [end - notified_s for begin, end in self.planners.planned if begin >= notified_s]
        found.kept = any("moves within" in reason for at, _, reason in phases if at > notified_s)
        if rest and moving and plans:
            found.rest_s, found.moving_s = rest[0], moving[0]
            confirming = [end - notified_s for _, end in self.planners.checked if end - notified_s > plans[0]]
            found.confirmed_s = confirming[0] if confirming else None
        return found


def _note(phases: list[tuple[float, str, str]], message: FreeMotionFeedback) -> None:
    if not phases or phases[-1][1:] != (message.phase, message.reason):
        phases.append((time.perf_counter(), message.phase, message.reason))


def _arm_across(point: Vector3) -> np.ndarray:
    """Return the voxels of a forearm that comes from above to a point, 10 cm thick."""
    taken = np.zeros(SHAPE, dtype=bool)
    low = ((np.subtract(point, (0.05, 0.05, 0.1)) - CORNER_M) / VOXEL_M).astype(int).clip(0)
    high = ((np.add(point, (0.05, 0.05, 0.4)) - CORNER_M) / VOXEL_M).astype(int)
    taken[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = True
    return taken


async def measured(rounds: int) -> tuple[list[Round], list[tuple[str, Punctuality, list[float]]]]:
    """Measure the rounds, and how punctual the world and the engine are without maps and meanwhile."""
    scene = build_scene(load_cell(CELL).document)
    clock, cameras, host = new_clock(), Cameras(), ProcessHost(scene)
    planners = TimedPlanners(clock)
    planners.checked, planners.planned = [], []

    def make_robots(world: SimWorld) -> tuple[SimRobot, ...]:
        def live() -> LiveScene:
            return LiveScene(
                planning_scene(scene), parts=[p.name for p in scene.parts], look=WorldPoseReader(world, scene)
            )

        workspace = Workspace(live, planners=planners, clock=clock, occupancy=cameras)
        arms = tuple(
            ArmServer(
                name=one.name,
                model=one.robot(),
                base=one.base,
                port=world.arm(one.name),
                clock=clock,
                workspace=workspace,
            )
            for one in scene.arms
        )
        return (workspace, *arms)

    async with AsyncExitStack() as stack:
        bus = await stack.enter_async_context(SkillBus(clock))
        with tempfile.TemporaryDirectory() as folder:
            world = await stack.enter_async_context(
                SimWorld(scene, host=host, make_robots=make_robots, cache=Path(folder))
            )
            world.register(bus)
        for robot in world.robots():
            await stack.enter_async_context(robot)
            robot.register(bus)
        cell = ReplanningRig(bus, host, cameras, planners)
        cameras.see()
        await cell.move(THERE, intrude_after_s=None)
        rows = [await _watched("to and fro, no maps", cell, partial(_to_and_fro, cell, _QUIET_S))]
        seeing = asyncio.create_task(_see_on(cameras), name="cameras")
        try:
            rows.append(await _watched("to and fro, maps and intrusions", cell, partial(_intrusions, cell, rounds)))
        finally:
            seeing.cancel()
            await asyncio.wait((seeing,))
        return cell.rounds, rows


async def _see_on(cameras: Cameras) -> None:
    while True:
        await asyncio.sleep(_RATE_S)
        cameras.see()


async def _to_and_fro(cell: ReplanningRig, seconds: float) -> None:
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        await cell.move(ACROSS, intrude_after_s=None)
        await cell.move(THERE, intrude_after_s=None)


async def _intrusions(cell: ReplanningRig, rounds: int) -> None:
    random_times = random.Random(7)
    for number in range(rounds):
        goal = ACROSS if number % 2 == 0 else THERE
        found = await cell.move(goal, intrude_after_s=random_times.uniform(0.1, 0.45))
        if found is not None:
            cell.rounds.append(found)


async def _watched(name: str, cell: ReplanningRig, work: Callable[[], object]) -> tuple[str, Punctuality, list[float]]:
    reactions = Reactions(cell.bus)
    try:
        working = asyncio.ensure_future(work())  # type: ignore[arg-type]
        punctual = await watch(cell.host, _QUIET_S - 2.0)
        await working
    finally:
        reactions.close()
    return name, punctual, reactions.latencies_s


def table(rounds: list[Round], rows: list[tuple[str, Punctuality, list[float]]]) -> str:
    """Return the figures as Markdown."""
    around = [one for one in rounds if one.moving_s is not None and one.rest_s is not None and not one.kept]
    figures = {
        "map → check answered": [r.answered_s for r in rounds if r.answered_s is not None],
        "arm at rest → new verified trajectory": [
            r.confirmed_s - r.rest_s for r in around if r.confirmed_s is not None and r.rest_s is not None
        ],
        "map → new verified trajectory, without braking": [
            r.answered_s + r.confirmed_s - r.rest_s
            for r in around
            if r.confirmed_s is not None and r.answered_s is not None and r.rest_s is not None
        ],
        "map → arm at rest": [r.rest_s for r in around if r.rest_s is not None],
        "map → arm moves again": [r.moving_s for r in around if r.moving_s is not None],
    }
    lines = ["| ms | n | p50 | p95 | p99 | max |", "|---|---:|---:|---:|---:|---:|"]
    for name, values in figures.items():
        ms = np.array(values) * 1e3
        if len(ms):
            p50, p95, p99 = np.percentile(ms, (50, 95, 99))
            lines.append(f"| {name} | {len(ms)} | {p50:.1f} | {p95:.1f} | {p99:.1f} | {ms.max():.1f} |")
    kept = sum(one.kept for one in rounds)
    load = os.getloadavg()[0]
    lines += [
        "",
        f"{len(rounds)} intrusions, {len(around)} gone around at once, {kept} kept the arm at rest for a while.",
        f"Load at the end {load:.1f} on {os.cpu_count()} cores.",
        "",
    ]
    lines += [
        "| | control late p50 ms | p99 | max | overruns | empty loop p99 | engine reaction p50 | p99 |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, p, latencies in rows:
        slow, late = np.array(latencies) * 1e3, p.whole
        lines.append(
            f"| {name} | {late.late_p50_s * 1e3:.3f} | {late.late_p99_s * 1e3:.3f} | {late.late_max_s * 1e3:.2f} "
            f"| {p.whole.overruns} of {p.whole.steps} | {p.empty_p99_s * 1e3:.3f} "
            f"| {np.percentile(slow, 50):.2f} | {np.percentile(slow, 99):.2f} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=100)
    arguments = parser.parse_args()
    print(table(*asyncio.run(measured(arguments.rounds))))


if __name__ == "__main__":
    main()
