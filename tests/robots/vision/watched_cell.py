"""A small cell that cameras watch, for tests: an arm between a pillar and a box that can be put anywhere."""

from __future__ import annotations

import msgspec
import numpy as np

from engine.document.cell_perception import DepthCamera, OccupancyMap
from engine.messages import Pose, Vector3
from engine.messages.sensing import DepthImage, OccupancyGrid
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell
from robots.vision.cameras.camera import CameraSpec, camera_of, depths, directions
from robots.vision.perception_messages import PerceptionRequest, PerceptionSetup
from robots.vision.voxel_box import VoxelBox, occupied_centres, voxel_box

FLOOR = FixtureBody(name="floor", shape="box", size_m=(4.0, 4.0, 0.04), pose=Pose(xyz=(0.0, 0.0, -0.02)))
PANDA = ArmPlacement(name="arm", model="panda", base=Pose(xyz=(0.0, 0.0, 0.0)))
BOX = voxel_box(OccupancyMap(center_m=(0.5, 0.0, 0.5), size_m=(1.0, 1.2, 1.0)))
FRONT = DepthCamera(at=(2.0, 0.0, 1.6), look_at=(0.4, 0.0, 0.3))
SIDE = DepthCamera(at=(0.5, 2.0, 1.6), look_at=(0.4, 0.0, 0.3))


def cameras(**named: DepthCamera) -> tuple[CameraSpec, ...]:
    """Return the numbers of cameras."""
    return tuple(camera_of(name, camera) for name, camera in named.items())


def block(centre: Vector3, size_m: Vector3 = (0.1, 0.1, 0.1), *, name: str = "block") -> FixtureBody:
    """Return a block for the physics that nobody has told the map of."""
    return FixtureBody(name=name, shape="box", size_m=size_m, pose=Pose(xyz=centre))


def scene(*unknown: FixtureBody, arms: tuple[ArmPlacement, ...] = (), parts: tuple[PartBody, ...] = ()) -> SimScene:
    """Return a floor, arms, parts and blocks, without weight."""
    return SimScene(step_s=0.002, gravity=False, arms=arms, fixtures=(FLOOR, *unknown), parts=parts)


def perception_setup(what: SimScene, *seen_by: CameraSpec, box: VoxelBox = BOX) -> PerceptionSetup:
    """Return what is looked at."""
    return PerceptionSetup(scene=what, cameras=seen_by or cameras(front=FRONT), box=box)


def look(what: SimScene, names: tuple[str, ...] = ("front",), *, joints: Array | None = None) -> PerceptionRequest:
    """Return the order to look at a scene as it begins, the first arm's joints changed."""
    cell = build_cell(what)
    simulation = Simulation(cell)
    if joints is not None:
        simulation._qpos[cell.arms[0].qpos] = joints  # pyright: ignore[reportPrivateUsage]
    image = np.zeros(simulation.image_layout.size)
    simulation.write_image(image)
    return PerceptionRequest(time_s=0.0, state=image, cameras=names, returned=names)


def voxels(grid: OccupancyGrid | None) -> Array:
    """Return the centres of the occupied voxels of a map, which must be there."""
    assert grid is not None
    return occupied_centres(grid)


def renamed(what: SimScene, **changes: object) -> SimScene:
    """Return a scene with some fields changed."""
    return msgspec.structs.replace(what, **changes)


def points_seen(image: DepthImage) -> Array:
    """Return the measured points of an image in the world, (k, 3)."""
    depth = depths(image).astype(np.float64).ravel()
    measured = np.isfinite(depth) & (depth > 0.0)
    pose = RigidTransform.from_pose(image.pose)
    return (directions(image.intrinsics)[measured] * depth[measured, None]) @ pose.rotation.T + pose.xyz
