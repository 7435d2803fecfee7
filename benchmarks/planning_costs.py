"""What planning costs besides the search: prepared scenes, trajectories, what cameras see, checks of paths."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import msgspec
import numpy as np

from benchmarks.planning_scenes import ARM, box, cases
from engine.messages import Pose
from engine.messages.sensing import OccupancyGrid
from engine.messages.shapes import Cylinder, Obstacle
from robots.planning.request import CollisionRequest, PathCheckRequest, PathPlan, PlanRequest
from robots.planning.scene.planning_scene import PlanningScene, SceneArm
from robots.planning.scene.voxels import voxels_of
from robots.planning.worker.scene_planner import ScenePlanner
from robots.scene.sim_scene import ArmPlacement

_T = TypeVar("_T")
_SHAPE, _VOXEL_M = (64, 90, 60), 0.02
_CORNER_M = (-0.4, -0.9, 0.0)


def other_costs(runs: int) -> dict[str, tuple[float, float]]:
    """Return CPU milliseconds, p50 and p95, of everything besides the search (a Panda before its shelf by default)."""
    shelf = msgspec.structs.replace(cases()[-1].request, speed=1.0)
    planner = ScenePlanner()
    two = two_pandas(0)
    planner.prepared(two, ARM)
    path = _planned(planner, shelf)
    shorter = _planned(planner, cases()[-2].request)
    look = CollisionRequest(scene=shelf.scene, arm=ARM, joints_rad=shelf.start_rad)
    grids = [scatter(seed) for seed in range(runs)]

    def seeing(seed: int) -> PathCheckRequest:
        return msgspec.structs.replace(path, occupancy=grids[seed])

    def replan(seed: int) -> PlanRequest:
        return msgspec.structs.replace(shelf, occupancy=grids[seed], seed=seed)

    return {
        "arm and scene, both new to the planner": _spent(runs, lambda _: ScenePlanner(), _prepare(two)),
        "two Pandas, 20 parts: one part moved": _spent(runs, two_pandas, lambda s: planner.prepared(s, ARM)),
        "two Pandas, 20 parts: the other arm moved": _spent(
            runs,
            lambda k: two.with_joints("other", [0.01 * k, -0.8, 0.0, -2.3, 0.0, 1.6, 0.8]),
            lambda s: planner.prepared(s, ARM),
        ),
        "answer with trajectory": _spent(runs, lambda k: msgspec.structs.replace(shelf, seed=k), planner.plan),
        "new voxels, 64 x 90 x 60: distances": _spent(runs, lambda k: grids[k], lambda g: voxels_of(g).field),
        "new voxels: octree": _spent(runs, lambda k: voxels_of(grids[k]), lambda v: v.octree),
        "check of a path, scene and path known": _spent(runs, lambda _: path, planner.check_path),
        "check of a path, new voxels, distances among it": _spent(runs, seeing, planner.check_path),
        "check of a path, voxels known": _spent(runs, lambda k: _known(planner, seeing(k)), planner.check_path),
        "check of a path, UR10 around a box, voxels known": _spent(
            runs, lambda k: _known(planner, msgspec.structs.replace(shorter, occupancy=grids[k])), planner.check_path
        ),
        "first check of a path that was not planned here": _spent(
            runs, lambda k: _other_path(path, k), planner.check_path
        ),
        "answer with trajectory, new voxels, all of it": _spent(runs, replan, planner.plan),
        "look": _spent(runs, lambda _: look, planner.look),
    }


def two_pandas(moved: int) -> PlanningScene:
    """Return two Pandas at a table with 20 parts, the first of which is a millimetre on for each `moved`."""
    placements = (
        ArmPlacement(name=name, model="panda", base=Pose(xyz=(x, 0.0, 0.0)))
        for name, x in ((ARM, -0.5), ("other", 0.5))
    )
    scene = PlanningScene(arms=tuple(SceneArm(placement=placement) for placement in placements))
    parts = [
        box(f"part_{k}", (0.04, 0.04, 0.1), (0.1 * k - 0.5, 0.4 + (0.001 * moved if k == 0 else 0.0), 0.05))
        if k % 2
        else Obstacle.of(
            f"part_{k}",
            Cylinder(radius_m=0.03, length_m=0.1),
            Pose(xyz=(0.1 * k - 0.5, -0.4 - (0.001 * moved if k == 0 else 0.0), 0.05)),
        )
        for k in range(20)
    ]
    return scene.with_obstacles(box("table", (2.4, 1.6, 0.04), (0.0, 0.0, -0.05)), *parts)


def scatter(seed: int) -> OccupancyGrid:
    """Return a map with some thousand voxels taken in clumps at the sides of a cell, none where the path leads."""
    random = np.random.default_rng(seed)
    taken = np.zeros(_SHAPE, dtype=np.uint8)
    for _ in range(40):
        x, y, z = (int(random.integers(0, side - 5)) for side in _SHAPE)
        if y < 8 or y > 76 or x < 3:
            taken[x : x + 5, y : y + 5, z : z + 5] = 1
    taken[0, 0, 0] = 1
    return OccupancyGrid(
        time_s=float(seed),
        revision=seed,
        corner_m=_CORNER_M,
        voxel_m=_VOXEL_M,
        shape=_SHAPE,
        occupied=np.packbits(taken).tobytes(),
    )


def costs_table(costs: dict[str, tuple[float, float]]) -> str:
    """Return costs as Markdown."""
    rows = [f"| {what} | {p50:.2f} | {p95:.2f} |" for what, (p50, p95) in costs.items()]
    return "\n".join(["### Besides the search", "", "| | CPU ms, p50 | p95 |", "|---|---:|---:|", *rows])


def _planned(planner: ScenePlanner, request: PlanRequest) -> PathCheckRequest:
    answer = planner.plan(msgspec.structs.replace(request, speed=1.0))
    assert isinstance(answer, PathPlan)
    assert answer.timed is not None
    return PathCheckRequest(scene=request.scene, arm=ARM, trajectory=answer.timed, from_s=0.0)


def _prepare(scene: PlanningScene) -> Callable[[ScenePlanner], object]:
    return lambda planner: planner.prepared(scene, ARM)


def _known(planner: ScenePlanner, request: PathCheckRequest) -> PathCheckRequest:
    planner.check_path(request)
    return request


def _other_path(request: PathCheckRequest, number: int) -> PathCheckRequest:
    rows = request.trajectory.position_rad + 1e-9 * (number + 1)
    return msgspec.structs.replace(request, trajectory=replace(request.trajectory, position_rad=rows))


def _spent(runs: int, prepare: Callable[[int], _T], work: Callable[[_T], object]) -> tuple[float, float]:
    # What the first one loads or compiles is none of its cost.
    work(prepare(0))
    spent: list[float] = []
    for k in range(runs):
        given = prepare(k)
        start = time.process_time_ns()
        work(given)
        spent.append((time.process_time_ns() - start) / 1e6)
    p50, p95 = np.percentile(spent, [50, 95]).tolist()
    return p50, p95
