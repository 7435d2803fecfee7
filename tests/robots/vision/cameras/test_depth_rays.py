"""Casting only the rays that pass something that can move gives the same bits as casting all of them."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from engine.document.cell_perception import DepthCamera
from engine.messages import Pose
from robots.port import Array
from robots.scene.sim_scene import PartBody, SimScene
from robots.sim.physics.physics import mujoco
from robots.vision.cameras.camera import CameraSpec, Image
from robots.vision.cameras.depth_rays import (
    RayDepthRenderer,
    _Rays,  # pyright: ignore[reportPrivateUsage]
    first_hits,
)
from robots.vision.cameras.physics_copy import PhysicsCopy
from tests.robots.vision.watched_cell import BOX, FRONT, PANDA, SIDE, block, cameras, scene

# Within the reach of the arm, so that parts of it are beside and behind the camera.
AMONG = DepthCamera(at=(0.2, 0.35, 0.6), look_at=(0.4, -0.2, 0.3), size_px=(160, 120))
PART = PartBody(name="ball", shape="sphere", size_m=(0.2,), mass_kg=0.1, pose=Pose(xyz=(0.6, 0.3, 0.4)))

# Long enough to pass beside a camera among the bodies, from before it to behind it.
BEAM = PartBody(name="beam", shape="box", size_m=(3.0, 0.1, 0.1), mass_kg=0.1, pose=Pose(xyz=(0.3, 0.1, 0.5)))


def _renderer(what: SimScene, *seen_by: CameraSpec) -> tuple[PhysicsCopy, RayDepthRenderer]:
    cell = PhysicsCopy(what)
    return cell, RayDepthRenderer(cell, seen_by, voxel_m=BOX.voxel_m, middle_m=BOX.middle_m)


def _move(cell: PhysicsCopy, random: np.random.Generator) -> None:
    """Put everything that can move somewhere else."""
    cell.data.qpos[:] += random.uniform(-1.0, 1.0, cell.model.nq)
    mujoco.mj_kinematics(cell.model, cell.data)


def _cast_all(cell: PhysicsCopy, renderer: RayDepthRenderer, camera: CameraSpec) -> Image:
    lens = renderer.intrinsics(camera)
    step = renderer._rays[camera.name].step  # pyright: ignore[reportPrivateUsage]
    rays = _Rays(camera, step)
    flat: Array = rays.units.ravel()
    hit, distance = first_hits(cell, rays.start, flat, reach_m=2.0 * camera.range_m[1])
    depth = np.where(hit >= 0, distance * rays.along, np.inf).astype(np.float32)
    return depth.reshape(lens.height_px, lens.width_px)


@pytest.mark.parametrize("where", [FRONT, SIDE, AMONG])
def test_images_while_everything_moves_are_those_of_all_rays(where: DepthCamera) -> None:
    (camera,) = cameras(front=where)
    what = scene(block((0.5, 0.0, 0.2), (0.2, 0.2, 0.4)), arms=(PANDA,), parts=(PART, BEAM))
    cell, renderer = _renderer(what, camera)
    random, seen = np.random.default_rng(7), set[bytes]()
    for _ in range(30):
        _move(cell, random)
        image = renderer.exact(camera)
        assert image.tobytes() == _cast_all(cell, renderer, camera).tobytes()
        seen.add(image.tobytes())
    assert len(seen) > 10


def test_most_rays_are_not_cast_again() -> None:
    (camera,) = cameras(front=FRONT)
    cell, renderer = _renderer(scene(arms=(PANDA,), parts=(PART,)), camera)
    moving, rays = renderer._moving, renderer._rays["front"]  # pyright: ignore[reportPrivateUsage]
    _move(cell, np.random.default_rng(1))
    assert 0.0 < float(moving.passed_by(rays).mean()) < 0.6


def test_a_camera_that_is_displaced_looks_at_its_own_surroundings() -> None:
    (camera,) = cameras(front=FRONT)
    cell, renderer = _renderer(scene(block((0.5, 0.0, 0.2), (0.2, 0.2, 0.4))), camera)
    pose = msgspec.structs.replace(camera.pose, xyz=(1.6, 0.2, 1.4))
    displaced = msgspec.structs.replace(camera, pose=pose)
    at_first = renderer.exact(camera)
    for _ in range(2):
        assert renderer.exact(displaced).tobytes() == _cast_all(cell, renderer, displaced).tobytes()
        assert renderer.exact(camera).tobytes() == at_first.tobytes()
