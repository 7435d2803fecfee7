"""Computes how much of a cell its cameras see, with all arms at home and nobody in it."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.cell import CameraCoverage, RegionCoverage
from engine.document import Cell, cell_at_start
from engine.errors import CellError
from engine.messages import Vector3
from engine.messages.sensing import DepthImage, ObservedSpace
from robots.planning.scene.cell_planning_scene import known_obstacles
from robots.planning.swept_space import CoverRegion
from robots.planning.unknown_voxels import region_voxels
from robots.scene.scene_builder import build_scene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell
from robots.vision.cameras.camera import camera_of
from robots.vision.cameras.depth_renderer import new_depth_renderer
from robots.vision.cameras.physics_copy import PhysicsCopy
from robots.vision.cameras.simulated_cameras import SimulatedCameras
from robots.vision.known_geometry import KnownGeometry, MeasuredState
from robots.vision.occupancy.occupancy_mapper import OccupancyMapper
from robots.vision.voxel_box import voxel_box

WHOLE = "whole map"
Flags = NDArray[np.bool_]


def camera_coverage(cell: Cell) -> CameraCoverage:
    """Return the coverage of a cell, computed by ray casting.

    Raises:
        CellError: the cell has no cameras or no map, cannot be simulated, or a camera is invalid.
        DocumentError: a model folder or a calibration file is invalid.
    """
    document = cell_at_start(cell)
    if document.occupancy is None or not document.cameras:
        raise CellError(
            "the cell has no cameras with an occupancy map", where=document.cell, hint="add `cameras:` and `occupancy:`"
        )
    # Persons move and unknown bodies are unknown: the coverage is that of the cell as it is designed.
    scene = msgspec.structs.replace(
        build_scene(document, resolve=cell.resolve), people=(), unknown_fixtures=(), unknown_parts=()
    )
    cameras = tuple(camera_of(name, camera) for name, camera in document.cameras.items())
    box = voxel_box(document.occupancy)
    copy, simulation = PhysicsCopy(scene), Simulation(build_cell(scene))
    state = np.zeros(simulation.image_layout.size)
    simulation.write_image(state)
    copy.go_to(state)
    moment = copy.moment(0.0)
    mapper = OccupancyMapper(box, scene.arms, far_m={camera.name: camera.range_m[1] for camera in cameras})
    mapper.know(KnownGeometry(obstacles=known_obstacles(scene)))
    depth = new_depth_renderer(copy, cameras, box=box, repeatable=True)
    port = SimulatedCameras(depth, seed=0)
    space = _observed(mapper, moment, ())
    known = _seen(space)
    seen: dict[str, Flags] = {}
    for camera in cameras:
        image = port.image(camera, time_s=0.0, faults={})
        seen[camera.name] = _seen(_observed(mapper, moment, (image,) if image is not None else ()))
    depth.close()
    whole = CoverRegion(name=WHOLE, center_m=document.occupancy.center_m, size_m=document.occupancy.size_m)
    regions = tuple(
        CoverRegion(name=name, center_m=region.center_m, size_m=region.size_m)
        for name, region in document.occupancy.must_cover.items()
    )
    return CameraCoverage(
        regions=tuple(_coverage(region, space, known, seen) for region in regions),
        whole=_coverage(whole, space, known, seen),
    )


def _observed(mapper: OccupancyMapper, moment: MeasuredState, images: tuple[DepthImage, ...]) -> ObservedSpace:
    mapper.forget()
    mapper.update(images, moment)
    return mapper.observe(images, time_s=0.0)


def _seen(space: ObservedSpace) -> Flags:
    return (np.frombuffer(space.ages, dtype=np.uint8) == 0).reshape(space.shape)


def _coverage(region: CoverRegion, space: ObservedSpace, known: Flags, seen: dict[str, Flags]) -> RegionCoverage:
    where = region_voxels(space, region)
    asked = ~known[where]
    by_camera = {name: flags[where] & asked for name, flags in seen.items()}
    together = np.zeros_like(asked)
    for flags in by_camera.values():
        together |= flags
    total = max(1, int(asked.sum()))
    missing = np.argwhere(asked & ~together)
    low = high = None
    if len(missing):
        first = np.array([each.start for each in where])
        low = _corner(space, missing.min(axis=0) + first)
        high = _corner(space, missing.max(axis=0) + first + 1)
    return RegionCoverage(
        name=region.name,
        seen=1.0 - len(missing) / total,
        by_camera={name: int(flags.sum()) / total for name, flags in by_camera.items()},
        unseen_low_m=low,
        unseen_high_m=high,
    )


def _corner(space: ObservedSpace, index: NDArray[np.int64]) -> Vector3:
    x, y, z = (np.array(space.corner_m) + space.voxel_m * index).round(4).tolist()
    return (x, y, z)
