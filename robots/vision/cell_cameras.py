"""The cameras of a cell document on the world that simulates it."""

from __future__ import annotations

from engine.document.cell import CellDocument
from engine.errors import CellError
from engine.nearness import near_names
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
    """Return what watches the cell, None where it has no camera, or nothing to do for those that it has.

    Raises:
        CellError: a camera or the box of the map makes no sense, or the environment's wish for images.
    """
    detects = any(camera.detect is not None for camera in document.cameras.values())
    if not document.cameras or (document.occupancy is None and not detects):
        return None
    _check_labels(document)
    check_choice()
    sight = Sight(
        scene=scene,
        cameras=tuple(camera_of(name, camera) for name, camera in document.cameras.items()),
        box=voxel_box(document.occupancy) if document.occupancy is not None else None,
        seed=seed or 0,
    )
    if isinstance(world.host, LockstepHost):
        return LockstepWatch(sight, world=world)
    return RealTimeWatch(sight, world=world)


def _check_labels(document: CellDocument) -> None:
    for name, camera in document.cameras.items():
        for part in camera.detect.labels if camera.detect is not None else ():
            if part not in document.parts:
                raise CellError(
                    f"the detector of {name} has a label for {part}, which is no part of the cell",
                    where=f"camera {name}",
                    hint=near_names(part, document.parts),
                )
