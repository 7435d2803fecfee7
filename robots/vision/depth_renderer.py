"""How depth images are made on this machine: with OpenGL where there is some, else by rays; decided at the start.

In virtual time it is rays, which give the same bits on every machine, so that runs repeat. The environment
variable `FLEXCELL_DEPTH` (`egl`, `osmesa` or `rays`) decides otherwise.
"""

from __future__ import annotations

import os
from ctypes.util import find_library
from functools import partial
from typing import Protocol

from engine.errors import CellError
from engine.messages.sensing import CameraIntrinsics
from robots.vision.camera import CameraSpec, Image
from robots.vision.depth_gl import GlDepthRenderer, GlKind, GraphicsUnavailable
from robots.vision.depth_rays import RayDepthRenderer
from robots.vision.physics_copy import PhysicsCopy
from robots.vision.voxel_box import VoxelBox

VARIABLE = "FLEXCELL_DEPTH"
# How fine images by rays are where nothing is mapped: as for such voxels in the middle of the cell.
_PITCH_M = 0.02
_MIDDLE_M = (0.0, 0.0, 0.0)


class DepthRenderer(Protocol):
    """Makes exact depth images of the state that its copy of the cell is in."""

    @property
    def words(self) -> str:
        """How it makes them, for people."""
        ...

    def intrinsics(self, camera: CameraSpec) -> CameraIntrinsics:
        """Return the lens of the images that it makes for a camera."""
        ...

    def exact(self, camera: CameraSpec) -> Image:
        """Return the exact depths, (height, width), infinite where nothing is hit."""
        ...

    def close(self) -> None:
        """Release its resources."""
        ...


def check_depth_setting() -> None:
    """Raise CellError when `FLEXCELL_DEPTH` is none of its values."""
    if (choice := os.environ.get(VARIABLE, "")) not in ("", "egl", "osmesa", "rays"):
        raise CellError(f"{VARIABLE} is {choice}", where="cameras", hint="set it to egl, osmesa or rays")


def new_depth_renderer(
    cell: PhysicsCopy, cameras: tuple[CameraSpec, ...], *, box: VoxelBox | None, repeatable: bool
) -> DepthRenderer:
    """Return who makes the images of `cameras`; `repeatable` asks for the same bits on every machine.

    Raises:
        CellError: `FLEXCELL_DEPTH` asks for what there is not.
    """
    check_depth_setting()
    rays = partial(
        RayDepthRenderer,
        cell,
        cameras,
        voxel_m=box.voxel_m if box is not None else _PITCH_M,
        middle_m=box.middle_m if box is not None else _MIDDLE_M,
    )
    match os.environ.get(VARIABLE, ""):
        case "rays":
            return rays()
        case "egl" | "osmesa" as kind:
            try:
                return GlDepthRenderer(cell, cameras, kind=kind)
            except GraphicsUnavailable as error:
                raise CellError(
                    f"{VARIABLE} requests {kind}, which does not work: {error}",
                    where="cameras",
                    hint=f"install it, or set {VARIABLE}=rays",
                ) from error
        case _:
            graphics = None if repeatable else _graphics(cell, cameras)
            return graphics or rays()


def _graphics(cell: PhysicsCopy, cameras: tuple[CameraSpec, ...]) -> GlDepthRenderer | None:
    # Once the bindings have been loaded for one of the two, the process cannot go over to the other.
    kind: GlKind | None = "egl" if find_library("EGL") else "osmesa" if find_library("OSMesa") else None
    if kind is None:
        return None
    try:
        return GlDepthRenderer(cell, cameras, kind=kind)
    except GraphicsUnavailable:
        return None
