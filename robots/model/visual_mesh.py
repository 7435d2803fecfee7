"""The visual meshes of a robot's links: read from its URDF's DAE files, split by colour, thinned out."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from importlib import import_module
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.errors import CellError
from engine.messages import Quaternion, Vector3
from robots.model.description import resolve_uri
from robots.model.mesh_cache import cache_dir, content_key, read_cached, write_cached
from robots.model.robot_model import RobotModel

Rgba = tuple[float, float, float, float]

# A tenth of the faces draws a Panda in 14 thousand triangles and looks the same.
_KEEP = 0.1
_LEAST_FACES = 150
_RECIPE = f"visual mesh 1, keep {_KEEP}, least {_LEAST_FACES}"


class VisualMesh(msgspec.Struct, frozen=True, kw_only=True):
    """One colour of a mesh file: float32 vertices (n x 3, metres), uint32 faces (m x 3), as bytes."""

    vertices: bytes
    faces: bytes
    rgba: Rgba


class LinkVisual(msgspec.Struct, frozen=True, kw_only=True):
    """A mesh fixed to a link, with its pose in the link's frame."""

    link: str
    mesh: VisualMesh
    xyz: Vector3
    xyzw: Quaternion


def link_visuals(model: RobotModel, *, cache: Path | None = None) -> tuple[LinkVisual, ...]:
    """Return the visual meshes of all links, in URDF order; `cache` is the user's folder by default.

    Raises:
        CellError: a mesh file is missing or cannot be read.
    """
    folder = cache if cache is not None else cache_dir()
    known: dict[Path, tuple[VisualMesh, ...]] = {}
    visuals: list[LinkVisual] = []
    for link in ET.parse(model.urdf).getroot().iter("link"):
        for visual in link.findall("visual"):
            mesh = visual.find("geometry/mesh")
            if mesh is None:
                continue
            path = resolve_uri(mesh.attrib["filename"], package_dir=model.package_dir, relative_to=model.urdf.parent)
            if path not in known:
                known[path] = _meshes(path, folder)
            xyz, xyzw = _origin(visual.find("origin"))
            visuals += [LinkVisual(link=link.attrib["name"], mesh=m, xyz=xyz, xyzw=xyzw) for m in known[path]]
    return tuple(visuals)


def _meshes(path: Path, folder: Path) -> tuple[VisualMesh, ...]:
    key = content_key(path.read_bytes(), recipe=_RECIPE)
    kept = read_cached(folder, key)
    if kept is not None:
        return msgspec.msgpack.decode(kept, type=tuple[VisualMesh, ...])
    made = _converted(path)
    write_cached(folder, key, msgspec.msgpack.encode(made))
    return made


def _converted(path: Path) -> tuple[VisualMesh, ...]:
    # Slow to import and needed only when the cache has nothing; its types are incomplete.
    trimesh: Any = import_module("trimesh")
    try:
        scene: Any = trimesh.load_scene(path)
    except Exception as error:
        # The readers behind trimesh have error classes of their own for each format.
        raise CellError(f"the mesh cannot be read: {error}", where=str(path)) from error
    parts: dict[Rgba, list[Any]] = {}
    for node in sorted(scene.graph.nodes_geometry):
        transform, name = scene.graph[node]
        geometry = scene.geometry[name].copy()
        geometry.apply_transform(transform)
        parts.setdefault(_color(geometry), []).append(geometry)
    return tuple(_thinned(trimesh.util.concatenate(pieces), rgba) for rgba, pieces in sorted(parts.items()))


def _color(geometry: Any) -> Rgba:
    channels = [float(c) / 255.0 for c in np.asarray(geometry.visual.material.main_color)]
    return (channels[0], channels[1], channels[2], channels[3])


def _thinned(mesh: Any, rgba: Rgba) -> VisualMesh:
    fast_simplification: Any = import_module("fast_simplification")
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    vertices: NDArray[np.float32] = np.asarray(mesh.vertices, dtype=np.float32)
    faces: NDArray[np.uint32] = np.asarray(mesh.faces, dtype=np.uint32)
    keep = max(int(len(faces) * _KEEP), _LEAST_FACES)
    if keep < len(faces):
        points, triangles = fast_simplification.simplify(vertices, faces, target_count=keep)
        vertices, faces = np.asarray(points, dtype=np.float32), np.asarray(triangles, dtype=np.uint32)
    return VisualMesh(
        vertices=np.ascontiguousarray(vertices).tobytes(), faces=np.ascontiguousarray(faces).tobytes(), rgba=rgba
    )


def _origin(origin: ET.Element | None) -> tuple[Vector3, Quaternion]:
    attributes = origin.attrib if origin is not None else {}
    x, y, z = (float(v) for v in attributes.get("xyz", "0 0 0").split())
    roll, pitch, yaw = (float(v) for v in attributes.get("rpy", "0 0 0").split())
    (cr, cp, cy), (sr, sp, sy) = (tuple(f(a / 2) for a in (roll, pitch, yaw)) for f in (np.cos, np.sin))
    quaternion = (
        float(sr * cp * cy - cr * sp * sy),
        float(cr * sp * cy + sr * cp * sy),
        float(cr * cp * sy - sr * sp * cy),
        float(cr * cp * cy + sr * sp * sy),
    )
    return (x, y, z), quaternion
