"""Creates the cameras of a cell document on its simulated world."""

from __future__ import annotations

from engine.document import CellDocument
from engine.errors import CellError
from engine.wording import did_you_mean
from robots.scene.sim_scene import SimScene
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.world.sim_world import SimWorld
from robots.vision.cameras.camera import camera_of
from robots.vision.cameras.depth_renderer import check_depth_setting
from robots.vision.lockstep_perception import LockstepPerception
from robots.vision.perception_messages import PerceptionSetup
from robots.vision.real_time_perception import RealTimePerception
from robots.vision.voxel_box import voxel_box


def cell_cameras(
    document: CellDocument, *, scene: SimScene, world: SimWorld, seed: int | None
) -> LockstepPerception | RealTimePerception | None:
    """Return the perception device of a cell, None without cameras or without a task for them.

    Raises:
        CellError: a camera, the box of the map or `FLEXCELL_DEPTH` is invalid.
    """
    detects = any(camera.detect is not None for camera in document.cameras.values())
    if not document.cameras or (document.occupancy is None and not detects):
        return None
    _check_labels(document)
    check_depth_setting()
    setup = PerceptionSetup(
        scene=scene,
        cameras=tuple(camera_of(name, camera) for name, camera in document.cameras.items()),
        box=voxel_box(document.occupancy) if document.occupancy is not None else None,
        observes=document.occupancy is not None and document.occupancy.unknown_space_policy != "accept",
        seed=seed or 0,
        fixtures=world.modules.scene.fixtures,
    )
    if isinstance(world.host, LockstepHost):
        return LockstepPerception(setup, world=world)
    return RealTimePerception(setup, world=world)


def _check_labels(document: CellDocument) -> None:
    for name, camera in document.cameras.items():
        for part in camera.detect.labels if camera.detect is not None else ():
            if part not in document.parts:
                raise CellError(
                    f"the detector of {name} has a label for {part}, which is not a part of the cell",
                    where=f"camera {name}",
                    hint=did_you_mean(part, document.parts),
                )
