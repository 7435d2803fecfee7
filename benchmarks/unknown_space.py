"""What it costs to know what is not seen: `unknown_space.py [--repeats N]`.

On the shared IRB 4600 cell: one update of the occupancy map, one of the map of observed space and one assessment of
camera health with two images, and one query of the unknown space on a trajectory. Run it with `python -P`.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from engine.document.cell import load_cell
from engine.messages.sensing import NEVER_SEEN, ObservedSpace
from robots.planning.scene.cell_planning_scene import known_obstacles, planning_scene
from robots.planning.swept_space import SweptSpaceRequest
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import JointTrajectory
from robots.scene.scene_builder import build_scene
from robots.vision.cameras.camera import camera_of
from robots.vision.cameras.depth_renderer import new_depth_renderer
from robots.vision.cameras.physics_copy import PhysicsCopy
from robots.vision.cameras.simulated_cameras import SimulatedCameras
from robots.vision.health.camera_health import CameraHealth
from robots.vision.health.expected_view import ExpectedView
from robots.vision.known_geometry import KnownGeometry
from robots.vision.occupancy.arm_body import ArmBody
from robots.vision.occupancy.occupancy_mapper import OccupancyMapper
from robots.vision.voxel_box import voxel_box

CELL = Path(__file__).parent / "cells" / "irb4600_near.yaml"


def median_ms(work: Callable[[], object], repeats: int) -> float:
    """Return the median processor time of `work`, milliseconds."""
    work()
    times: list[float] = []
    for _ in range(repeats):
        started_s = time.process_time()
        work()
        times.append(1e3 * (time.process_time() - started_s))
    return float(np.median(times))


def costs(repeats: int) -> dict[str, float]:
    """Return the median processor times of the steps, milliseconds."""
    cell = load_cell(CELL)
    occupancy = cell.document.occupancy
    assert occupancy is not None
    scene, box = build_scene(cell.document, resolve=cell.resolve), voxel_box(occupancy)
    cameras = tuple(camera_of(name, camera) for name, camera in cell.document.cameras.items())
    copy = PhysicsCopy(scene)
    depth = new_depth_renderer(copy, cameras, box=box, repeatable=True)
    port = SimulatedCameras(depth, seed=0)
    taken = [port.image(camera, time_s=0.0, faults={}) for camera in cameras]
    images = [image for image in taken if image is not None]
    moment = copy.moment(0.0)
    mapper = OccupancyMapper(box, scene.arms)
    mapper.know(KnownGeometry(obstacles=known_obstacles(scene)))
    fixtures = [one for one in known_obstacles(scene) if one.name in {each.name for each in scene.fixtures}]
    balls = np.vstack([ArmBody(arm).balls(moment.arms[arm.name]) for arm in scene.arms])
    health = [CameraHealth(one, ExpectedView(one, depth.intrinsics(one), fixtures)) for one in cameras]

    def judge() -> None:
        for one, image in zip(health, images, strict=True):
            one.judge(image, balls, now_s=0.0)

    planner, arm = ScenePlanner(), scene.arms[0]
    home = np.array(arm.robot().home_rad)
    rows = home + np.linspace(0.0, 1.0, 400)[:, None] * np.array([1.5, *np.zeros(len(home) - 1)])
    request = SweptSpaceRequest(
        scene=planning_scene(scene),
        arm=arm.name,
        trajectory=JointTrajectory(dt_s=0.01, position_rad=rows, velocity_rad_s=np.zeros_like(rows)),
        observed=ObservedSpace(
            time_s=0.0,
            corner_m=box.corner_m,
            voxel_m=box.voxel_m,
            shape=box.shape,
            limit_s=5.0,
            ages=bytes((NEVER_SEEN,)) * int(np.prod(box.shape)),
        ),
    )
    return {
        "update of the occupancy map": median_ms(lambda: mapper.update(images, moment), repeats),
        "update of the observed space": median_ms(lambda: mapper.observe(images, time_s=0.0), repeats),
        "assessment of two cameras": median_ms(judge, repeats),
        "query of the unknown space on a path": median_ms(lambda: planner.swept_space(request), repeats),
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=30)
    options = parser.parse_args(arguments)
    print("| step | CPU ms |\n|---|---|")
    for step, cost_ms in costs(options.repeats).items():
        print(f"| {step} | {cost_ms:.2f} |")


if __name__ == "__main__":
    main()
