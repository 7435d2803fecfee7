"""The geometries of `cell/scene` in viser, and their bounding boxes."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.transforms import Matrix, WorldPose, rotation, wxyz
from engine.errors import FlexcellError
from engine.messages import Vector3, VisualGeometry

_SWELL = 1.02
# A body of several geometries has `name/0`, `name/1`.
_NUMBER = re.compile(r"/\d+$")
Rgb = tuple[int, int, int]
GeometryHandle = viser.MeshHandle | viser.BoxHandle | viser.CylinderHandle | viser.IcosphereHandle


def body_name(geometry: VisualGeometry) -> str:
    """Return the name of the body that a geometry belongs to: `table` for `table/3`, `vice/jaws` for `vice/jaws/0`."""
    return _NUMBER.sub("", geometry.name)


def add_geometry(
    server: Canvas,
    name: str,
    geometry: VisualGeometry,
    *,
    tint: Rgb | None = None,
    opacity: float | None = None,
) -> GeometryHandle:
    """Draw one geometry at the node `name`; `tint` and `opacity` draw it as a ghost.

    Raises:
        FlexcellError: its kind is unknown.
        ValueError: its dimensions are not valid.
    """
    alpha = geometry.rgba[3]
    # The options are the same for every kind of shape; viser types them separately.
    common: dict[str, Any] = {
        "color": colour_of(geometry) if tint is None else tint,
        "opacity": opacity if opacity is not None else None if alpha >= 1.0 else alpha,
        # A ghost at the pose of the body must not flicker against it.
        "scale": 1.0 if opacity is None else _SWELL,
        "cast_shadow": opacity is None,
        "receive_shadow": opacity is None,
        "wxyz": wxyz(geometry.xyzw),
        "position": geometry.xyz,
    }
    match geometry.kind:
        case "box":
            x_m, y_m, z_m = geometry.size_m
            return server.scene.add_box(name, dimensions=(x_m, y_m, z_m), **common)
        case "cylinder":
            return server.scene.add_cylinder(name, radius=geometry.size_m[0], height=geometry.size_m[1], **common)
        case "sphere":
            return server.scene.add_icosphere(name, radius=geometry.size_m[0], **common)
        case "mesh":
            faces = np.frombuffer(geometry.faces, dtype=np.uint32).reshape(-1, 3)
            return server.scene.add_mesh_simple(name, vertices=_vertices(geometry), faces=faces, **common)
        case _:
            raise FlexcellError(
                f"the scene has a geometry of unknown kind {geometry.kind!r}",
                where=geometry.name,
                hint="use box, cylinder, sphere or mesh",
            )


def colour_of(geometry: VisualGeometry) -> Rgb:
    """Return its own colour."""
    red, green, blue, _ = geometry.rgba
    return (round(red * 255), round(green * 255), round(blue * 255))


def corners(geometry: VisualGeometry, pose: WorldPose | None) -> Matrix:
    """Return the eight corners (8 x 3, world, metres) of a geometry's box; none of an empty mesh."""
    if geometry.kind == "mesh":
        local = _vertices(geometry).astype(np.float64)
        if local.size == 0:
            return np.zeros((0, 3))
        low, high = local.min(axis=0), local.max(axis=0)
    else:
        half = np.asarray(_half_size(geometry), dtype=np.float64)
        low, high = -half, half
    grid = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    inside = grid @ rotation(geometry.xyzw).T + np.asarray(geometry.xyz)
    if pose is None:
        return inside
    return inside @ rotation(pose.xyzw).T + np.asarray(pose.xyz)


def _vertices(geometry: VisualGeometry) -> NDArray[np.float32]:
    return np.frombuffer(geometry.vertices, dtype=np.float32).reshape(-1, 3)


def _half_size(geometry: VisualGeometry) -> Vector3:
    size = geometry.size_m
    if geometry.kind == "box":
        return (size[0] / 2, size[1] / 2, size[2] / 2)
    if geometry.kind == "cylinder":
        return (size[0], size[0], size[1] / 2)
    return (size[0], size[0], size[0])
