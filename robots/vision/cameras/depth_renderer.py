"""Selects the rendering of depth images on this machine at the start: OpenGL if available, else ray casting.

Virtual time uses ray casting, which is bit-identical on every machine, so that runs are repeatable. The environment
variable `FLEXCELL_DEPTH` (`egl`, `osmesa` or `rays`) overrides the selection.
"""

from __future__ import annotations

import os
from ctypes.util import find_library
from functools import partial
from typing import Protocol

from engine.errors import CellError
from engine.messages.sensing import CameraIntrinsics
from robots.vision.cameras.camera import CameraSpec, Image
from robots.vision.cameras.depth_gl import GlDepthRenderer, GlKind, GraphicsUnavailable
from robots.vision.cameras.depth_rays import RayDepthRenderer
from robots.vision.cameras.physics_copy import PhysicsCopy
from robots.vision.voxel_box import VoxelBox

VARIABLE = "FLEXCELL_DEPTH"
# Resolution of ray-cast images without a map: as for such voxels in the middle of the cell.
_PITCH_M = 0.02
_MIDDLE_M = (0.0, 0.0, 0.0)


class DepthRenderer(Protocol):
    """Renders exact depth images of the present state of its copy of the cell."""

    @property
    def words(self) -> str:
        """Human-readable name of the rendering method."""
        ...

    def intrinsics(self, camera: CameraSpec) -> CameraIntrinsics:
        """Return the intrinsics of the rendered images of a camera."""
        ...

    def exact(self, camera: CameraSpec) -> Image:
        """Return the exact depths, (height, width), infinite where nothing is hit."""
        ...

    def close(self) -> None:
        """Release its resources."""
        ...


def check_depth_setting() -> None:
    """Raise CellError if `FLEXCELL_DEPTH` has an invalid value."""
    if (choice := os.environ.get(VARIABLE, "")) not in ("", "egl", "osmesa", "rays"):
        raise CellError(f"{VARIABLE} is {choice}", where="cameras", hint="set it to egl, osmesa or rays")


def new_depth_renderer(
    cell: PhysicsCopy, cameras: tuple[CameraSpec, ...], *, box: VoxelBox | None, repeatable: bool
) -> DepthRenderer:
    """Return the renderer of `cameras`; `repeatable` requires bit-identical images on every machine.

    Raises:
        CellError: the method requested by `FLEXCELL_DEPTH` is unavailable.
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
    # Once the bindings are loaded for one of the two, the process cannot switch to the other.
    kind: GlKind | None = "egl" if find_library("EGL") else "osmesa" if find_library("OSMesa") else None
    if kind is None:
        return None
    try:
        return GlDepthRenderer(cell, cameras, kind=kind)
    except GraphicsUnavailable:
        return None
