"""Depth cameras and the map that is made of them: `perception.py [--looks N] [--postures N] [--seconds N]`.

How long from a depth image to the map, on the IRB 4600 cell with a person's arm in view; whether the robot leaves
voxels of its own; how much of a person's arm is seen; and whether the control loop and the engine keep their time
meanwhile. Run it with `python -P`.
"""

from __future__ import annotations

import argparse
import asyncio
import math
import os
import platform
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.perception_scene import Stage, document, inside, perception_setup, scene_with
from benchmarks.process_cpu import cpu_s
from benchmarks.realtime import Reactions
from benchmarks.swinging_arms import CELL as SWINGING_CELL
from benchmarks.swinging_arms import swing_for_ever
from benchmarks.timing_jitter import watch
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages.sensing import OccupancyState
from robots.port import Array
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from robots.vision.camera_process import CameraProcess
from robots.vision.camera_rig import CameraRig
from robots.vision.cameras.depth_renderer import VARIABLE
from robots.vision.known_geometry import ArmConfiguration
from robots.vision.occupancy.arm_body import ArmBody
from robots.vision.occupancy.occupancy_kernels import INSIDE, NEAR, stamp_balls
from robots.vision.perception_messages import PerceptionResult
from robots.vision.real_time_perception import RealTimePerception
from robots.vision.voxel_box import VoxelBox, occupied_centres

_WARM_UP_LOOKS = 10
_WARM_UP_S = 12.0
_CAMERAS = """
cameras:
  front: {at: [1.9, 0.0, 1.9], look_at: [0.3, 0.0, 0.3]}
  back: {at: [-1.4, 0.0, 2.0], look_at: [0.3, 0.0, 0.3]}
occupancy: {center_m: [0.3, 0.0, 0.62], size_m: [1.6, 2.0, 1.2]}
"""


async def times(cameras: int, looks: int, kind: str) -> str:
    """Return a row: images made and mapped in the camera process, all along the wire."""
    os.environ[VARIABLE] = kind
    cell = document(cameras=cameras)
    scene = scene_with(cell, person=True)
    stage, process = Stage(scene, tuple(cell.cameras)), CameraProcess()
    random = np.random.default_rng(0)
    render: list[float] = []
    mapping: list[float] = []
    whole: list[float] = []
    await process.start(perception_setup(cell, scene))
    try:
        pid, used_s = process.pid, 0.0
        for number in range(looks + _WARM_UP_LOOKS):
            if number == _WARM_UP_LOOKS:
                used_s = cpu_s(pid)
            stage.put_arm(random.uniform(stage.lower, stage.upper) * 0.4)
            stage.put_hand(number // 10)
            order, started_s = stage.look(), time.perf_counter()
            seen: PerceptionResult = await process.look(order)
            if number >= _WARM_UP_LOOKS:
                whole.append(time.perf_counter() - started_s)
                render.append(seen.render_s)
                mapping.append(seen.map_s)
        cpu_ms = 1e3 * (cpu_s(pid) - used_s) / looks
    finally:
        process.end()
        del os.environ[VARIABLE]
    return f"| {kind}, {cameras} | {_quantiles(mapping)} | {_quantiles(render)} | {_quantiles(whole)} | {cpu_ms:.1f} |"


def robot_voxels(postures: int) -> str:
    """Return how many voxels the robot leaves behind in random configurations, and what the margin covers."""
    cell = document(cameras=2)
    scene = scene_with(cell, person=False)
    setup = perception_setup(cell, scene)
    stage, eye = Stage(scene, tuple(cell.cameras)), CameraRig(setup, repeatable=False)
    body, shells = ArmBody(scene.arms[0]), list[tuple[float, float]]()
    random = np.random.default_rng(1)
    left = [0] * postures
    for number in range(postures):
        joints = random.uniform(stage.lower, stage.upper)
        stage.put_arm(joints)
        seen = eye.look(stage.look())
        assert setup.box is not None
        assert seen.grid is not None
        shells.append(_shell_l(setup.box, body, joints))
        left[number] = len(occupied_centres(seen.grid))
    own, near = np.mean(shells, axis=0)
    return (
        f"robot voxels left in {postures} random configurations, two cameras: {sum(left)} in all, "
        f"in {sum(count > 0 for count in left)} configurations; of the map's box the arm takes {own:.0f} l, "
        f"its margin another {near:.0f} l in which nothing is seen"
    )


def arm_seen(cameras: int, postures: int) -> str:
    """Return a row: the share of a person's arm's surface that is in the map or in a voxel beside it, by one image."""
    cell = document(cameras=cameras)
    scene = scene_with(cell, person=True)
    setup = perception_setup(cell, scene)
    stage, eye = Stage(scene, tuple(cell.cameras)), CameraRig(setup, repeatable=False)
    random = np.random.default_rng(2)
    shares: list[float] = []
    extra: list[float] = []
    for number in range(postures):
        stage.put_arm(random.uniform(stage.lower, stage.upper) * 0.4)
        assert setup.box is not None
        points = inside(setup.box, stage.put_hand(number))
        seen = eye.look(stage.look(forget=True))
        assert seen.grid is not None
        found = occupied_centres(seen.grid)
        nearest = _nearest(points, found)
        shares.append(float((nearest <= 1.5 * setup.box.voxel_m).mean()))
        extra.append(float(_nearest(found, points).max()) if len(found) else 0.0)
    return f"| {cameras} | {100 * np.mean(shares):.0f} % | {100 * min(shares):.0f} % | {1e3 * max(extra):.0f} |"


async def jitter(seconds: float, *, cameras: bool) -> str:
    """Return a row: both Pandas swing in real time, with cameras that map at 10 Hz or without."""
    text = SWINGING_CELL.read_text(encoding="utf-8").replace("../entries", str(SWINGING_CELL.parents[1] / "entries"))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cell.yaml"
        file.write_text(text + (_CAMERAS if cameras else ""), encoding="utf-8")
        async with OpenCell(load_cell(file), store_path=str(Path(folder) / "store.db")) as cell:
            world = cell.world
            assert isinstance(world, SimWorld)
            assert isinstance(world.host, ProcessHost)
            for device in world.devices():
                if isinstance(device, RealTimePerception):
                    device.require()
            swinging = [asyncio.create_task(swing_for_ever(world, name)) for name in world.arm_names()]
            await asyncio.sleep(_WARM_UP_S)
            states = cell.bus.topic("cell/occupancy_state", OccupancyState)
            before = states.latest if cameras else None
            reactions = Reactions(cell.bus)
            try:
                found = (await watch(world.host, seconds)).whole
            finally:
                reactions.close()
            for task in swinging:
                task.cancel()
            await asyncio.wait(swinging)
            state = states.latest if cameras else None
    overruns = f"{100 * found.overruns / max(found.steps, 1):.2f} %"
    looks = "–" if state is None or before is None else f"{(state.looks - before.looks) / seconds:.1f}"
    latencies = reactions.latencies_s
    return (
        f"| {'two cameras' if cameras else 'no cameras'} | {found.late_p50_s * 1e3:.3f} | {found.late_p99_s * 1e3:.3f} "
        f"| {overruns} | {_quantiles(latencies, (0.5, 0.99))} | {looks} |"
    )


def _shell_l(box: VoxelBox, body: ArmBody, joints: Array) -> tuple[float, float]:
    """Return how many litres of voxels an arm takes itself, and how many more its margin does."""
    taken = np.zeros(math.prod(box.shape), dtype=np.uint8)
    corner, shape = np.array(box.corner_m), np.array(box.shape, dtype=np.int32)
    balls = body.balls(ArmConfiguration(joints=tuple(joints.tolist())))
    stamp_balls(balls, max(box.robot_margin_m, box.reach_m), corner, box.voxel_m, shape, taken)
    litres = 1e3 * box.voxel_m**3
    return litres * int((taken == INSIDE).sum()), litres * int((taken == NEAR).sum())


def _nearest(points: Array, others: Array) -> Array:
    if not len(others):
        return np.full(len(points), np.inf)
    return np.concatenate(
        [np.linalg.norm(some[:, None] - others[None], axis=2).min(axis=1) for some in np.array_split(points, 40)]
    )


def _quantiles(values_s: Sequence[float], levels: tuple[float, ...] = (0.5, 0.95, 0.99)) -> str:
    return " / ".join(f"{1e3 * value:.1f}" for value in np.quantile(values_s, levels))


async def _tables(looks: int, postures: int, seconds: float) -> None:
    print("| images, cameras | image → map ms p50 / p95 / p99 | making images | state → map, all | CPU ms |")
    print("|---|---:|---:|---:|---:|")
    for kind in ("egl", "rays"):
        for cameras in (1, 2):
            print(await times(cameras, looks, kind), flush=True)
    print(f"\n{robot_voxels(postures)}\n")
    print("| cameras | of a person's arm in the map, mean | least | farthest voxel from it, mm |")
    print("|---|---:|---:|---:|")
    for cameras in (1, 2):
        print(arm_seen(cameras, max(1, postures // 10)), flush=True)
    if seconds:
        print("\n| | late p50 ms | p99 | overruns | reaction p50 / p99 ms | looks a second |")
        print("|---|---:|---:|---:|---:|---:|")
        for cameras in (False, True):
            print(await jitter(seconds, cameras=cameras), flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--looks", type=int, default=300, help="images of each camera in each row (default 300)")
    parser.add_argument("--postures", type=int, default=500, help="random configurations of the arm (default 500)")
    parser.add_argument("--seconds", type=float, default=20.0, help="real time of each row of the last table")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    print(f"{platform.machine()}, {os.cpu_count()} cores, load {load:.1f} before, Python {platform.python_version()}\n")
    asyncio.run(_tables(options.looks, options.postures, options.seconds))


if __name__ == "__main__":
    main()
