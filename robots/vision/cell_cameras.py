"""The cameras of a cell document on the world that simulates it."""

from __future__ import annotations

from engine.document.cell import CellDocument
from robots.sim.lockstep_host import LockstepHost
from robots.sim.scene import Scene
from robots.sim.world import SimWorld
from robots.vision.camera import camera_of
from robots.vision.depth import check_choice
from robots.vision.lockstep_watch import LockstepWatch
from robots.vision.real_time_watch import RealTimeWatch
from robots.vision.sight import Sight
from robots.vision.voxel_box import voxel_box


def cell_cameras(
    document: CellDocument, *, scene: Scene, world: SimWorld, seed: int | None
) -> LockstepWatch | RealTimeWatch | None:
    """Return what watches the cell, None where it has no occupancy map or no camera to fill it.

    Raises:
        CellError: a camera or the box of the map makes no sense, or the environment's wish for images.
    """
    if document.occupancy is None or not document.cameras:
        return None
    check_choice()
    sight = Sight(
        scene=scene,
        cameras=tuple(camera_of(name, camera) for name, camera in document.cameras.items()),
        box=voxel_box(document.occupancy),
        seed=seed or 0,
    )
    if isinstance(world.host, LockstepHost):
        return LockstepWatch(sight, world=world)
    return RealTimeWatch(sight, world=world)
